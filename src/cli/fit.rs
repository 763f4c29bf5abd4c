//! `fretwork fit`: parameters of a case for which its runs give measured curves.

use super::output::{answer_json, inform, report};
use super::{Failure, PluginArgs, again};
use crate::experiments::fit::evaluate::Tests;
use crate::experiments::fit::half_step::half_step;
use crate::experiments::fit::outcome::{Outcome, identify};
use crate::experiments::fit::search::{Found, Progress, Search, Stage};
use crate::experiments::fit::spec::ReadFit;
use crate::experiments::fit::{FitError, OWNER, files, page};
use crate::experiments::runs::duration::parse as duration;
use crate::interrupt;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::Duration;

#[derive(Args, Debug)]
pub struct FitArgs {
    /// The file of the fit (RON)
    fit: PathBuf,
    /// Folder of the results, in which an interrupted fit also continues; results/fit/<fit> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of the runs, which several fits may share; <out>/runs by default
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Parallel runs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Stop a run that takes longer, as one that failed: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    limit: Option<Duration>,
    /// Show no progress; print the result as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

impl From<FitError> for Failure {
    fn from(e: FitError) -> Self {
        match e {
            FitError::Input(e) => Self::Input(e),
            FitError::Runs(e) => e.into(),
            FitError::Usage(text) => Self::Usage(text),
            FitError::Failed(text) => Self::Failed(text),
        }
    }
}

pub fn fit(args: &FitArgs) -> Result<(), Failure> {
    let out = args.out.clone().unwrap_or_else(|| {
        let name = args.fit.file_stem().unwrap_or_default();
        Path::new("results").join("fit").join(name)
    });
    let program = args.plugins.program()?;
    let read = ReadFit::read(&args.fit)?;
    let _lock = OWNER.take(&out)?;
    let runs = args.cache.clone().unwrap_or_else(|| out.join("runs"));
    let mut tests = Tests::new(&read, &runs, &program)?;
    tests.limit = args.limit;
    if !args.json {
        inform(&page::consists_of(&read, &tests));
    }
    let stop = interrupt::watch();
    let display = Display::new(args.json);
    let search = Search {
        tests: &tests,
        spec: read.spec.search,
        seeds: read.spec.seeds,
        jobs: args.jobs.into(),
        stop,
        told: &|progress| display.show(progress),
    };
    let mut found: Found = search.run()?;
    let mut outcome = match stop.load(Ordering::Relaxed) {
        true => None,
        false => identify(&search, &mut found)?,
    };
    if let Some(outcome) = outcome.as_mut().filter(|_| read.spec.half_step) {
        outcome.half_step = half_step(&search, &found, outcome)?;
    }
    display.finish();
    files::evaluations(&tests, &found, &out.join("evaluations.csv"))?;
    if stop.load(Ordering::Relaxed) {
        return Err(Failure::Failed(format!(
            "interrupted: finished runs are kept; to continue from there:\n  {}",
            again::command(&[])
        )));
    }
    let Some(outcome) = outcome else {
        return Err(Failure::Failed(format!(
            "no point gave all curves with all its seeds; {}/evaluations.csv has the reasons",
            out.display()
        )));
    };
    tell(args, &read, &tests, &found, &outcome, &out)
}

/// Writes the files and prints the answer.
fn tell(
    args: &FitArgs,
    read: &ReadFit,
    tests: &Tests,
    found: &Found,
    outcome: &Outcome,
    out: &Path,
) -> Result<(), Failure> {
    let failed = |e: &dyn std::fmt::Display| Failure::Failed(e.to_string());
    let json = files::json(read, tests, found, outcome);
    let text = serde_json::to_string_pretty(&json).unwrap_or_default();
    let path = out.join("fit.json");
    std::fs::write(&path, format!("{text}\n"))
        .map_err(|e| failed(&format!("cannot write {}: {e}", path.display())))?;
    files::curves(tests, found, outcome, &out.join("curves.csv"))?;
    page::sheet(read, tests, found, outcome)
        .write(&out.join("fit.html"))
        .map_err(|e| failed(&e))?;
    page::draw(read, tests, found, outcome, &out.join("fit.png")).map_err(|e| failed(&e))?;
    if args.json {
        return answer_json(&text);
    }
    inform(&page::answer(read, tests, found, outcome));
    inform(&format!(
        "{0}/fit.html, {0}/fit.png, {0}/fit.json, {0}/curves.csv, {0}/evaluations.csv",
        out.display()
    ));
    Ok(())
}

/// A bar for each stage on a terminal, otherwise a line.
struct Display {
    bar: Mutex<Option<ProgressBar>>,
    terminal: bool,
    silent: bool,
}

impl Display {
    fn new(silent: bool) -> Self {
        Self {
            bar: Mutex::new(None),
            terminal: std::io::stderr().is_terminal()
                && std::env::var_os("FRETWORK_QUIET").is_none(),
            silent,
        }
    }

    fn show(&self, progress: &Progress) {
        if self.silent {
            return;
        }
        let Ok(mut bar) = self.bar.lock() else { return };
        match progress {
            Progress::Begins(stage, runs) if self.terminal => {
                let style = ProgressStyle::with_template(
                    "{msg:16} {bar:30} {pos}/{len} runs  {elapsed} of about {duration}",
                );
                let new = ProgressBar::new(*runs as u64).with_message(stage.word());
                new.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
                new.enable_steady_tick(Duration::from_secs(1));
                *bar = Some(new);
            }
            Progress::Begins(..) => {}
            Progress::Run => {
                if let Some(bar) = bar.as_ref() {
                    bar.inc(1);
                }
            }
            Progress::Ended(stage, least, failed) => {
                if let Some(bar) = bar.take() {
                    bar.finish_and_clear();
                }
                report(&line(*stage, *least, *failed));
            }
        }
    }

    fn finish(&self) {
        if let Ok(mut bar) = self.bar.lock()
            && let Some(bar) = bar.take()
        {
            bar.finish_and_clear();
        }
    }
}

fn line(stage: Stage, least: Option<f64>, failed: usize) -> String {
    let least = least.map_or("no point gave all curves".to_owned(), |x| {
        format!("least sum of squares so far {x:.4}")
    });
    let failed = match failed {
        0 => String::new(),
        1 => ", 1 point failed".to_owned(),
        n => format!(", {n} points failed"),
    };
    format!("{}: {least}{failed}", stage.word())
}
