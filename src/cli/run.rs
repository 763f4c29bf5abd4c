//! `fretwork run`.

use super::output::{answer_json, inform};
use super::progress::Display;
use super::{CaseArgs, Failure, again, observers};
use crate::interrupt;
use crate::record::checkpoint::FolderState;
use crate::record::{self, Run, RunError, RunOptions, Summary};
use crate::scene::build::Origin;
use crate::scene::interfaces::without_interface;
use crate::scene::source::clean;
use crate::scene::{Built, LoadedCase, load};
use crate::step::StepError;
use clap::Args;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct RunArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder of the results; results/<case> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; results are bit-identical for any number
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Continue from the last checkpoint in the folder; results equal those of an uninterrupted run
    #[arg(long)]
    resume: bool,
    /// Replace the results in the folder, also those of another run, a longer one, or one that is
    /// not at its end
    #[arg(long, conflicts_with = "resume")]
    force: bool,
    /// Exit with 1 also if the run finished but is not trustworthy (steps missed the tolerance, or
    /// a check failed)
    #[arg(long)]
    strict: bool,
    /// Print all details at the end: warnings in full, all results, first and last cycle, solver,
    /// laws
    #[arg(long, short)]
    verbose: bool,
    /// Make no report.html at the end
    #[arg(long)]
    no_report: bool,
    /// Show no progress; print the summary as JSON
    #[arg(long)]
    json: bool,
}

impl RunArgs {
    /// Returns the folder of the results, as the user names it.
    fn out(&self) -> PathBuf {
        let given = self.out.clone();
        given.unwrap_or_else(|| default_folder(&self.case.case))
    }
}

pub fn run(args: &RunArgs) -> Result<(), Failure> {
    // The path is made absolute, since a law may change the working directory.
    let out = std::path::absolute(args.out())
        .map_err(|e| Failure::Usage(format!("--out {}: {e}", args.out().display())))?;
    let loaded = load(&args.case.case, &args.case.sets)?;
    let built = loaded.build(&args.case.plugins.search()?)?;
    let options = RunOptions {
        out,
        threads: args.threads.into(),
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| {
            Failure::Failed(format!(
                "cannot start {} threads: {e}; take fewer (--threads) or allow more (ulimit -u)",
                options.threads
            ))
        })?;
    if !args.json {
        inform(&format!(
            "{}: {}",
            loaded.path.display(),
            clean(&loaded.case.name)
        ));
    }
    interrupt::watch();
    let done = pool.install(|| run_case(&loaded, built, &options, args));
    let Some(summary) = done.inspect_err(|e| {
        // The run has begun, and what it recorded until the failure is on disk.
        if matches!(e, Failure::Failed(_) | Failure::Run(RunError::Step(_))) {
            let made = report(&options.out, args);
            if !args.json {
                inform(&format!("  {}", results(args, made)));
            }
        }
    })?
    else {
        return Ok(());
    };
    if args.json {
        answer_json(&serde_json::to_string_pretty(&summary).unwrap_or_default())?;
    } else {
        inform(summary.text(args.verbose).trim_end());
    }
    let made = report(&options.out, args);
    if !args.json {
        let more = match args.verbose {
            true => "",
            false => " (more: --verbose)",
        };
        inform(&format!("  {}{more}", results(args, made)));
    }
    if let Some(why) = summary
        .run
        .stopped
        .as_ref()
        .filter(|_| summary.run.interrupted)
    {
        let command = again::command(&["--resume"]);
        return Err(Failure::Failed(format!("{why}; to go on:\n  {command}")));
    }
    strict(args, summary.run.reasons.first().map(String::as_str))
}

/// Makes the report, unless it is disabled; returns the name of its file in the folder.
fn report(out: &Path, args: &RunArgs) -> Option<&'static str> {
    (!args.no_report && super::report::of_run(out)).then_some(fretwork_view::FILE)
}

/// Says where the results and the page are.
fn results(args: &RunArgs, page: Option<&str>) -> String {
    let page = page.map_or(String::new(), |file| format!(", report in {file}"));
    format!("results in {}{page}", args.out().display())
}

/// Fails if `--strict` is given and there is a reason not to trust the run.
fn strict(args: &RunArgs, reason: Option<&str>) -> Result<(), Failure> {
    match reason.filter(|_| args.strict) {
        None => Ok(()),
        Some(reason) => Err(Failure::Failed(format!(
            "--strict: the run is not trustworthy, {reason}"
        ))),
    }
}

/// Runs or resumes a case; `None` if the run is already finished.
fn run_case(
    loaded: &LoadedCase,
    built: Built,
    options: &RunOptions,
    args: &RunArgs,
) -> Result<Option<Summary>, Failure> {
    let inform = |text: String| {
        if !args.json {
            super::output::inform(&text);
        }
    };
    for pair in without_interface(&loaded.case, built.simulation.view()) {
        inform(format!("no interface: {pair}"));
    }
    let shown = args.out();
    let out = shown.display();
    let mut stop = None;
    if args.resume {
        match record::stopped(loaded, &built, options)? {
            FolderState::Nothing => inform(format!(
                "nothing to resume in {out}: starting from the beginning"
            )),
            FolderState::State(state) => {
                inform(format!("resuming the run in {out}"));
                stop = Some(state);
            }
            FolderState::Finished => {
                // If the process was ended while it made the report, the results are complete.
                let missing = !options.out.join(fretwork_view::FILE).exists();
                let made = missing.then(|| report(&options.out, args)).flatten();
                let page = made.map_or(String::new(), |file| format!(", report in {file}"));
                let path = options.out.join("summary.json");
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                if args.json && !text.is_empty() {
                    answer_json(text.trim_end())?;
                } else {
                    super::output::inform(&format!(
                        "the run in {out} is finished: nothing to do{page}; to run it again omit --resume"
                    ));
                }
                let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
                strict(args, summary["reasons"][0].as_str())?;
                return Ok(None);
            }
        }
    }
    let mut built = built;
    let origins = std::mem::take(&mut built.origins);
    let mut display = Display::new(args.json);
    let added = observers::added(loaded, built.simulation.view());
    let mut run = Run::new(loaded, built, options).observe_all(added);
    if let Some(stop) = stop {
        run = run.resume(stop);
    } else if !args.force && !args.resume {
        run = run.keeping();
    }
    let summary = run.execute(&mut |progress| {
        display.step(progress);
        match interrupt::asked() {
            Some(signal) => ControlFlow::Break(format!("interrupted by {signal}")),
            None => ControlFlow::Continue(()),
        }
    });
    display.finish();
    if matches!(summary, Err(RunError::TakenOver)) {
        // The handler of the watch over laws ends the program.
        loop {
            std::thread::park();
        }
    }
    summary
        .map(Some)
        .map_err(|error| match place(loaded, &origins, &error) {
            Some(place) => Failure::Failed(format!("{error}; {place}")),
            None => match error {
                RunError::Occupied(found) => Failure::Usage(again::instead(&found, &shown)),
                error => error.into(),
            },
        })
}

/// Location in the case of the law or the body that ended a run, as the end of a sentence.
pub fn place(loaded: &LoadedCase, origins: &[Origin], error: &RunError) -> Option<String> {
    let (path, what) = match error {
        RunError::Step(StepError::Law { source, .. }) => {
            let (kind, name) = source.law()?;
            let slot = kind.word();
            let interfaces = &loaded.case.interfaces;
            // Several interfaces may use the same law.
            let at_fault = source.interface();
            let k = interfaces.iter().position(|i| {
                i.law(kind) == Some(name) && at_fault.is_none_or(|wanted| wanted == i.name)
            })?;
            let what = format!("interface `{}` uses this law", interfaces[k].name);
            (format!("interfaces.{k}.{slot}"), what)
        }
        RunError::Step(StepError::NotFinite { body, .. }) => {
            let origin = origins.get(usize::try_from(*body).ok()?)?;
            (origin.path(), "the body is defined".to_owned())
        }
        _ => return None,
    };
    let (line, column) = loaded.source.position_of(&path)?;
    let file = loaded.path.display();
    Some(format!("{what} at {file}:{line}:{column}"))
}

/// Returns the folder of the results of a case file for which none is given.
pub fn default_folder(case: &Path) -> PathBuf {
    Path::new("results").join(case.file_stem().unwrap_or_default())
}
