//! `fretwork patch`: a contact patch that rolls or frets, by the laws of an interface.

use super::experiment::{PartsBar, interrupted, results};
use super::output::{answer, answer_json, inform, report};
use super::{Failure, PluginArgs, cases};
use crate::experiments::duration::parse as duration;
use crate::experiments::patch::third_body::{self, Reached, Runs};
use crate::experiments::patch::{OWNER, Outcome, PatchFile, loads, solve_loads, trade};
use crate::interrupt;
use crate::shipped::inputs::InputKind;
use clap::Args;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Text below the options of the help.
pub const EXAMPLES: &str = "\
Exit code: 0 solved, or with --prepare the missing runs are named; 1 no solution, 2 wrong input.

Example:
  fretwork patch patches/wheel_on_rail.ron
  fretwork patch patches/wheel_on_rail.ron --trade=2%

docs/patch.md says what the file is made of and what the numbers mean.";

#[derive(Args, Debug)]
pub struct PatchArgs {
    /// The file of the patch (RON), or the name of a shipped patch
    #[arg(value_parser = cases::input(InputKind::Patch))]
    patch: PathBuf,
    /// Folder of the results; results/patch/<patch> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show no progress; print the result as JSON
    #[arg(long)]
    json: bool,
    /// Parallel runs, where the patch has a `third_body`
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Stop a run that takes longer: 90s, 10m, 2h; with --trade, leave out settings that are
    /// expected to (10m)
    #[arg(long, value_name = "TIME", value_parser = duration)]
    limit: Option<Duration>,
    /// Compare methods and numbers of cells by error and cost, and name the cheapest within an
    /// error
    #[arg(long, value_name = "ERROR", num_args = 0..=1, require_equals = true, default_missing_value = "1%", value_parser = wanted)]
    trade: Option<f64>,
    /// Make no runs of a `third_body`, and name the study of those that are missing, for another
    /// engine
    #[arg(long)]
    prepare: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

/// Longest expected duration of a setting of a trade.
const LIMIT: Duration = Duration::from_secs(600);

/// Parses a relative error, `1%` or `0.01`.
fn wanted(text: &str) -> Result<f64, String> {
    let (digits, scale) = match text.trim().strip_suffix('%') {
        Some(digits) => (digits, 0.01),
        None => (text, 1.0),
    };
    let value = digits.trim().parse::<f64>().map(|x| scale * x);
    match value {
        Ok(x) if x > 0.0 && x < 1.0 => Ok(x),
        _ => Err(format!(
            "`{text}` is not an error between 0 and 100 %, such as 1%"
        )),
    }
}

pub fn patch(args: &PatchArgs) -> Result<(), Failure> {
    let out = results(args.out.as_deref(), "patch", &args.patch);
    let search = args.plugins.search()?;
    let mut file = PatchFile::read(&args.patch)?;
    let _lock = OWNER.take(&out)?;
    if let Some(wanted) = args.trade {
        return trades(args, &mut file, wanted, &out);
    }
    let outcomes = match file.spec.third_body.is_some() {
        true => match with_runs(args, &file, &out)? {
            Some(outcome) => vec![*outcome],
            None => return Ok(()),
        },
        false => {
            let bar = PartsBar::new(args.json);
            solve_loads(&file, &search, &mut |part, done| bar.reached(part, done))?
        }
    };
    let json = loads::write(&file, &outcomes, &out)?;
    if args.json {
        return answer_json(&json);
    }
    for outcome in &outcomes {
        inform(&outcome.answer.text());
    }
    let at = out.display();
    let fields = match out.join("patch.h5").is_file() {
        true => format!(", {at}/patch.h5"),
        false => String::new(),
    };
    inform(&match outcomes.len() {
        1 => format!("{at}/patch.html, {at}/patch.json{fields}"),
        count => format!("{at}/loads.html, {at}/loads.csv, {at}/load_1 to load_{count}"),
    });
    Ok(())
}

/// Compares the methods and grids of a patch.
fn trades(args: &PatchArgs, file: &mut PatchFile, wanted: f64, out: &Path) -> Result<(), Failure> {
    let shows = !args.json && std::io::stderr().is_terminal();
    let limit = args.limit.unwrap_or(LIMIT);
    let search = args.plugins.search()?;
    let trade = trade::run(file, &search, (wanted, &trade::CELLS), limit, &mut |name| {
        if shows {
            report(name);
        }
    })?;
    let json = trade.write(out)?;
    if args.json {
        return answer_json(&json);
    }
    inform(&trade.text());
    inform(&format!("{0}/trade.csv, {0}/trade.json", out.display()));
    Ok(())
}

/// Solves a patch with runs of a window; `None` where some are missing that another engine makes.
fn with_runs(
    args: &PatchArgs,
    file: &PatchFile,
    out: &Path,
) -> Result<Option<Box<Outcome>>, Failure> {
    let stop = interrupt::watch();
    let runs = Runs {
        setup: &args.plugins.run_setup()?,
        out,
        jobs: usize::from(args.jobs),
        limit: args.limit,
        make: !args.prepare,
        stop,
        say: &|line| {
            if !args.json {
                report(line);
            }
        },
    };
    let reached = third_body::solve(file, &args.plugins.search()?, &runs);
    if stop.load(Ordering::Relaxed) {
        return Err(interrupted());
    }
    match reached? {
        Reached::Done(outcome) => Ok(Some(outcome)),
        Reached::Waits(study, folder, cache, count) => {
            answer(&format!(
                "{count} runs are missing; to make them elsewhere:\n  fretwork study export {} --out {} --cache {} --to slurm\nthen the same command again",
                study.display(),
                folder.display(),
                cache.display()
            ))?;
            Ok(None)
        }
    }
}
