//! `fretwork fit`: parameters of a case for which its runs give measured curves.

use super::experiment::{RunsBar, interrupted, results};
use super::output::{answer_json, inform, report};
use super::{Failure, PluginArgs, cases};
use crate::experiments::duration::parse as duration;
use crate::experiments::fit::evaluate::Tests;
use crate::experiments::fit::half_step::half_step;
use crate::experiments::fit::outcome::identify;
use crate::experiments::fit::search::{Progress, Search, SearchResult, Stage};
use crate::experiments::fit::spec::FitFile;
use crate::experiments::fit::{OWNER, files, page};
use crate::interrupt;
use crate::shipped::inputs::InputKind;
use clap::Args;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::Duration;

#[derive(Args, Debug)]
pub struct FitArgs {
    /// The file of the fit (RON), or the name of a shipped fit
    #[arg(value_parser = cases::input(InputKind::Fit))]
    fit: PathBuf,
    /// Folder of the results, in which an interrupted fit also continues; results/fit/<fit> by
    /// default
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

pub fn fit(args: &FitArgs) -> Result<(), Failure> {
    let out = results(args.out.as_deref(), "fit", &args.fit);
    let setup = args.plugins.run_setup()?;
    let read = FitFile::read(&args.fit)?;
    let _lock = OWNER.take(&out)?;
    let runs = args.cache.clone().unwrap_or_else(|| out.join("runs"));
    let mut tests = Tests::new(&read, &runs, &setup)?;
    tests.limit = args.limit;
    if !args.json {
        inform(&page::consists_of(&read, &tests));
    }
    let stop = interrupt::watch();
    let bar = Mutex::new(RunsBar::default());
    let search = Search {
        tests: &tests,
        spec: read.spec.search,
        seeds: read.spec.seeds,
        jobs: args.jobs.into(),
        stop,
        watch: &|progress| {
            if !args.json
                && let Ok(mut bar) = bar.lock()
            {
                show(progress, &mut bar);
            }
        },
    };
    let mut found: SearchResult = search.run()?;
    let mut outcome = match stop.load(Ordering::Relaxed) {
        true => None,
        false => identify(&search, &mut found)?,
    };
    if let Some(outcome) = outcome.as_mut().filter(|_| read.spec.half_step) {
        outcome.half_step = half_step(&search, &found, outcome)?;
    }
    drop(bar);
    files::write_evaluations(&tests, &found, &out)?;
    if stop.load(Ordering::Relaxed) {
        return Err(interrupted());
    }
    let Some(outcome) = outcome else {
        return Err(Failure::Failed(format!(
            "no point gave all curves with all its seeds; {}/evaluations.csv has the reasons",
            out.display()
        )));
    };
    let json = files::write(&read, &tests, &found, &outcome, &out)?;
    if args.json {
        return answer_json(&json);
    }
    inform(&page::answer(&read, &tests, &found, &outcome));
    inform(&format!(
        "{0}/fit.html, {0}/fit.png, {0}/fit.json, {0}/curves.csv, {0}/evaluations.csv",
        out.display()
    ));
    Ok(())
}

/// Shows a bar for each stage on a terminal, and prints a line at the end of the stage.
fn show(progress: &Progress, bar: &mut RunsBar) {
    match progress {
        Progress::Begins(stage, runs) => *bar = RunsBar::new(*runs, &stage.word()),
        Progress::Run => bar.run(),
        Progress::Ended(stage, least, failed) => {
            *bar = RunsBar::default();
            report(&line(*stage, *least, *failed));
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
