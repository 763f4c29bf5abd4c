//! `fretwork study`: one case at many points of its factors.

use super::experiment::{RunsBar, interrupted, results};
use super::output::{answer, answer_json, inform, report};
use super::{Failure, PluginArgs};
use crate::experiments::duration::{parse as duration, seconds};
use crate::experiments::runs::stored::FinishedRun;
use crate::experiments::study::execute::{execute, missing};
use crate::experiments::study::export::{Engine, Export};
use crate::experiments::study::forecast::Forecast;
use crate::experiments::study::plan::{Location, Plan, Point};
use crate::experiments::study::rows::{DONE, Rows, status};
use crate::experiments::study::spec::StudyFile;
use crate::experiments::study::{OWNER, answers, of_case, write};
use crate::interrupt;
use crate::shipped::inputs::{self, InputKind};
use clap::{Args, Subcommand, ValueEnum};
use fretwork_store::folder_lock::FolderLock;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

#[derive(Subcommand, Debug)]
pub enum StudyCommand {
    /// Print what a study consists of and what it will take, without running it
    Check(StudyCheckArgs),
    /// Make the runs of a study that are missing on this machine, and its table
    Run(StudyRunArgs),
    /// Make one run of a study, or a few: the unit of work of other engines
    Point(PointArgs),
    /// Write the runs of a study for Slurm, HyperQueue, Snakemake, or as a list of commands
    Export(ExportArgs),
    /// Gather the runs that are there in one table, failed ones included
    Collect(CollectArgs),
}

/// A study and the folders of its results.
#[derive(Args, Debug)]
struct StudyArgs {
    /// The file of the study (RON), or the name of a shipped study; with --ranges or --seeds a case
    study: PathBuf,
    /// Take a case, and vary its inputs over the ranges that their sources give
    #[arg(long)]
    ranges: bool,
    /// Take a case, and run it with this number of seeds
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    seeds: Option<u16>,
    /// A result that is compared, by its name in summary.json, of a case with --ranges or --seeds;
    /// by default its main results
    #[arg(long = "output", value_name = "NAME")]
    outputs: Vec<String>,
    /// Folder of the results; results/study/<study> by default, and results/study/<case>-ranges or
    /// <case>-seeds of a case
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of the runs, which several studies may share; <out>/runs by default
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    plugins: PluginArgs,
}

#[derive(Args, Debug)]
pub struct StudyCheckArgs {
    #[command(flatten)]
    of: StudyArgs,
    /// Print each run with its changes of the case
    #[arg(long)]
    points: bool,
    /// Do not time steps for the forecast
    #[arg(long)]
    no_timing: bool,
    /// Print the answer as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Args, Debug)]
pub struct StudyRunArgs {
    #[command(flatten)]
    of: StudyArgs,
    /// Parallel runs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Stop a run that takes longer: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    limit: Option<Duration>,
    /// Show no progress; print the table as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Args, Debug)]
pub struct PointArgs {
    #[command(flatten)]
    of: StudyArgs,
    /// Number of the run, or of the first and the last: 7, 1-20
    #[arg(value_name = "K", value_parser = range)]
    points: (usize, usize),
    /// Stop a run that takes longer: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    limit: Option<Duration>,
}

#[derive(Args, Debug)]
pub struct ExportArgs {
    #[command(flatten)]
    of: StudyArgs,
    /// The engine
    #[arg(long, value_enum)]
    to: EngineName,
    /// Runs of one task; by default as few as give at most 1000 tasks
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    chunk: Option<u32>,
    /// Stop a run that takes longer: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    limit: Option<Duration>,
    /// A line for the head of the batch scripts of Slurm, such as --line=--partition=short
    #[arg(long = "line", value_name = "OPTION", allow_hyphen_values = true)]
    lines: Vec<String>,
}

/// An engine, by its name on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum EngineName {
    /// Slurm: a job array and a job that collects
    Slurm,
    /// HyperQueue: a job file with a task for each chunk
    Hq,
    /// Snakemake: a Snakefile with a rule for runs and one that collects
    Snakemake,
    /// A list of commands, one a line, for GNU parallel, xargs and others
    Jobs,
}

impl EngineName {
    fn engine(self) -> Engine {
        match self {
            Self::Slurm => Engine::Slurm,
            Self::Hq => Engine::Hq,
            Self::Snakemake => Engine::Snakemake,
            Self::Jobs => Engine::Jobs,
        }
    }
}

#[derive(Args, Debug)]
pub struct CollectArgs {
    #[command(flatten)]
    of: StudyArgs,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
}

/// Parses a number or a range of numbers: `7` or `1-20`.
fn range(text: &str) -> Result<(usize, usize), String> {
    let wrong = || format!("`{text}` is no number of a run; expected for example 7, or 1-20");
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    let (first, last) = (number(first)?, number(last)?);
    if first == 0 || first > last {
        return Err(wrong());
    }
    Ok((first, last))
}

impl StudyArgs {
    fn out(&self) -> PathBuf {
        let folder = results(self.out.as_deref(), "study", &self.study);
        // The tables of one do not take the place of those of the other.
        let kind = match (self.out.is_some(), self.ranges, self.seeds) {
            (false, true, _) => "-ranges",
            (false, false, Some(_)) => "-seeds",
            _ => return folder,
        };
        let mut name = folder.into_os_string();
        name.push(kind);
        name.into()
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let place = Location {
            out: &self.out(),
            cache: self.cache.as_deref(),
            setup: &self.plugins.run_setup()?,
        };
        let of_a_case = self.ranges || self.seeds.is_some();
        let kind = match of_a_case {
            true => InputKind::Case,
            false => InputKind::Study,
        };
        let path = inputs::find(kind, &self.study).map_err(Failure::Usage)?;
        let file = match of_a_case {
            true => {
                let seeds = self.seeds.unwrap_or(1);
                let search = self.plugins.search()?;
                of_case(&path, self.ranges, seeds, &self.outputs, &search)?
            }
            false if !self.outputs.is_empty() => {
                let text = "--output goes with a case, and --seeds or --ranges; a study has `outputs` in its file";
                return Err(Failure::Usage(text.to_owned()));
            }
            false => StudyFile::read(&path)?,
        };
        Ok(Plan::new(&file, place)?)
    }

    /// Returns the plan of the study, with a folder for this command alone. Nothing is written if
    /// the study is invalid.
    fn plan_alone(&self) -> Result<(Plan, FolderLock), Failure> {
        let plan = self.plan()?;
        let lock = OWNER.take(&plan.out)?;
        plan.keep()?;
        Ok((plan, lock))
    }

    /// Returns the options of every call that another engine makes.
    fn options(&self) -> Vec<String> {
        let mut words = Vec::new();
        if self.ranges {
            words.push("--ranges".to_owned());
        }
        if let Some(seeds) = self.seeds {
            words.extend(["--seeds".to_owned(), seeds.to_string()]);
        }
        for output in &self.outputs {
            words.extend(["--output".to_owned(), output.clone()]);
        }
        if let Some(cache) = &self.cache {
            let cache = std::path::absolute(cache).unwrap_or_else(|_| cache.clone());
            words.extend(["--cache".to_owned(), cache.display().to_string()]);
        }
        words.extend(self.plugins.words());
        words
    }
}

pub fn study(command: &StudyCommand) -> Result<(), Failure> {
    match command {
        StudyCommand::Check(args) => check(args),
        StudyCommand::Run(args) => run(args),
        StudyCommand::Point(args) => point(args),
        StudyCommand::Export(args) => export(args),
        StudyCommand::Collect(args) => collect(args),
    }
}

fn check(args: &StudyCheckArgs) -> Result<(), Failure> {
    let plan = args.of.plan()?;
    if args.points && !args.json {
        return answer(&answers::points(&plan));
    }
    let open = missing(&plan);
    let forecast = match args.no_timing || args.points {
        true => None,
        false => Some(Forecast::of(&plan, &open, &args.of.plugins.search()?)),
    };
    match args.json {
        true => answer_json(&answers::check_json(
            &plan,
            open.len(),
            forecast.as_ref(),
            args.points,
        )),
        false => answer(&answers::consists_of(
            &plan,
            open.len(),
            forecast.as_ref(),
            1,
        )),
    }
}

fn run(args: &StudyRunArgs) -> Result<(), Failure> {
    let (plan, _lock) = args.of.plan_alone()?;
    let open = missing(&plan);
    let jobs = usize::from(args.jobs);
    if !args.json {
        let forecast = Forecast::of(&plan, &open, &args.of.plugins.search()?);
        inform(&answers::consists_of(
            &plan,
            open.len(),
            Some(&forecast),
            jobs,
        ));
    }
    let stop = interrupt::watch();
    let bar = match args.json {
        true => RunsBar::default(),
        false => RunsBar::new(open.len(), ""),
    };
    execute(&plan, open, jobs, args.limit, stop, &|point, run| {
        if !args.json {
            let line = format!("{}: {}", name(&plan, point), how(run));
            bar.line(&line, status(Some(run)).0 != DONE);
            bar.run();
        }
    })?;
    drop(bar);
    gather(&plan, args.json)?;
    match stop.load(Ordering::Relaxed) {
        true => Err(interrupted()),
        false => Ok(()),
    }
}

fn point(args: &PointArgs) -> Result<(), Failure> {
    let plan = args.of.plan()?;
    let (first, last) = args.points;
    if last > plan.count() {
        return Err(Failure::Usage(format!(
            "{last}: the study has {} runs",
            plan.count()
        )));
    }
    std::fs::create_dir_all(&plan.out)
        .map_err(|e| Failure::Failed(format!("cannot write {}: {e}", plan.out.display())))?;
    plan.keep()?;
    let stop = interrupt::watch();
    let points: Vec<Point> = (first..=last).filter_map(|k| plan.point(k)).collect();
    let count = points.len();
    let wanting = std::sync::Mutex::new(Vec::new());
    let ended = execute(&plan, points, 1, args.limit, stop, &|point, run| {
        report(&format!("{}: {}", name(&plan, point), how(run)));
        if !run.is_result()
            && let Ok(mut wanting) = wanting.lock()
        {
            wanting.push(point.number);
        }
    })?;
    let wanting = wanting.into_inner().unwrap_or_default();
    if ended < count {
        return Err(Failure::Failed(
            "interrupted: finished runs are kept; the same command continues".into(),
        ));
    }
    match wanting.first() {
        None => Ok(()),
        Some(k) => Err(Failure::Failed(format!(
            "{} of {count} runs left no result, the first is {k}; the same command tries them again",
            wanting.len()
        ))),
    }
}

fn export(args: &ExportArgs) -> Result<(), Failure> {
    let (plan, _lock) = args.of.plan_alone()?;
    let open = missing(&plan);
    let forecast = Forecast::of(&plan, &open, &args.of.plugins.search()?);
    inform(&answers::consists_of(&plan, open.len(), Some(&forecast), 1));
    let chunk = args
        .chunk
        .map_or(plan.count().div_ceil(1000), |n| n as usize);
    let one = forecast
        .about
        .filter(|_| !open.is_empty())
        .map(|s| s / open.len() as f64);
    let export = Export {
        plan: &plan,
        options: args.of.options(),
        limit: args.limit,
        chunk,
        task_seconds: one.map(|s| s * chunk as f64),
        lines: args.lines.clone(),
    };
    let written = export.write(args.to.engine())?;
    for file in &written.files {
        inform(&format!("wrote {}", file.display()));
    }
    answer(&format!("to start:\n  {}", written.start))
}

fn collect(args: &CollectArgs) -> Result<(), Failure> {
    let out = args.of.out();
    if !out.is_dir() {
        return Err(Failure::Usage(format!(
            "{}: there is no such folder; `fretwork study run` makes it, or name another with --out",
            out.display()
        )));
    }
    gather(&args.of.plan()?, args.json)
}

/// Writes the table of the existing runs, and reports its contents.
fn gather(plan: &Plan, json: bool) -> Result<(), Failure> {
    let rows = Rows::of(plan);
    let written = write(plan, &rows)?;
    match json {
        true => answer_json(&answers::json(plan, &rows)),
        false => answer(&answers::collected(plan, &rows, &written)),
    }
}

/// A run, for a line of progress.
fn name(plan: &Plan, point: &Point) -> String {
    format!(
        "run {} of {} ({})",
        point.number,
        plan.count(),
        plan.words(point)
    )
}

/// Describes how a run ended, for a line of progress.
fn how(run: &FinishedRun) -> String {
    let took = seconds(run.wall);
    match status(Some(run)) {
        (word, why) if why.is_empty() => format!("{word} in {took}"),
        (word, why) => format!("{} after {took}: {why}", word.to_uppercase()),
    }
}
