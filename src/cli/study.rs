//! `fretwork study`: one case at many points of its factors.

mod answers;

use super::output::{answer, answer_json, inform, report};
use super::{Failure, PluginArgs, again};
use crate::experiments::runs::duration::{parse as duration, seconds};
use crate::experiments::runs::stored::Finished;
use crate::experiments::study::analysis::Analysis;
use crate::experiments::study::execute::{Event, execute, missing};
use crate::experiments::study::export::{Engine, Export};
use crate::experiments::study::figures::draw;
use crate::experiments::study::forecast::Forecast;
use crate::experiments::study::page::sheet;
use crate::experiments::study::plan::{Place, Plan, Point};
use crate::experiments::study::spec::ReadSpec;
use crate::experiments::study::table::{Cell, Table, status};
use crate::experiments::study::{OWNER, StudyError};
use crate::interrupt;
use clap::{Args, Subcommand, ValueEnum};
use fretwork_store::folder_lock::FolderLock;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

#[derive(Subcommand, Debug)]
pub enum StudyCommand {
    /// Print what a study consists of and what it will take, without running it
    Check(CheckArgs),
    /// Make the runs of a study that are missing on this machine, and its table
    Run(RunArgs),
    /// Make one run of a study, or a few: the unit of work of other engines
    Point(PointArgs),
    /// Write the runs of a study for Slurm, HyperQueue, Snakemake, or as a list of commands
    Export(ExportArgs),
    /// Gather the runs that are there in one table, failed ones included
    Collect(CollectArgs),
}

/// The study and where it is made.
#[derive(Args, Debug)]
struct StudyArgs {
    /// The file of the study (RON)
    study: PathBuf,
    /// Folder of the results; results/study/<study> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of the runs, which several studies may share; <out>/runs by default
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    plugins: PluginArgs,
}

#[derive(Args, Debug)]
pub struct CheckArgs {
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
pub struct RunArgs {
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

/// An engine by its name on the command line.
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

/// Parses `7` or `1-20`.
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

impl From<StudyError> for Failure {
    fn from(e: StudyError) -> Self {
        match e {
            StudyError::Input(e) => Self::Input(e),
            StudyError::Runs(e) => e.into(),
            StudyError::Usage(text) => Self::Usage(text),
        }
    }
}

impl StudyArgs {
    fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            let name = self.study.file_stem().unwrap_or_default();
            Path::new("results").join("study").join(name)
        })
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let place = Place {
            out: &self.out(),
            cache: self.cache.as_deref(),
            program: &self.plugins.program()?,
        };
        Ok(Plan::new(&ReadSpec::read(&self.study)?, place)?)
    }

    /// The plan, and its folder for this command alone. Nothing is written if the study is wrong.
    fn plan_alone(&self) -> Result<(Plan, FolderLock), Failure> {
        let plan = self.plan()?;
        let lock = OWNER.take(&plan.out)?;
        plan.keep()?;
        Ok((plan, lock))
    }

    /// Options of every call of another engine.
    fn options(&self) -> Vec<String> {
        let mut words = Vec::new();
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

fn check(args: &CheckArgs) -> Result<(), Failure> {
    let plan = args.of.plan()?;
    if args.points && !args.json {
        return answer(&answers::points(&plan));
    }
    let open: Vec<Point> = missing(&plan).into_iter().map(|m| m.0).collect();
    let forecast = match args.no_timing || args.points {
        true => None,
        false => Some(Forecast::of(&plan, &open, &args.of.plugins.search()?)?),
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

fn run(args: &RunArgs) -> Result<(), Failure> {
    let (plan, _lock) = args.of.plan_alone()?;
    let open: Vec<Point> = missing(&plan).into_iter().map(|m| m.0).collect();
    let jobs = usize::from(args.jobs);
    if !args.json {
        let forecast = Forecast::of(&plan, &open, &args.of.plugins.search()?)?;
        inform(&answers::consists_of(
            &plan,
            open.len(),
            Some(&forecast),
            jobs,
        ));
    }
    let stop = interrupt::watch();
    let display = Display::new(&plan, open.len(), args.json);
    execute(&plan, open, jobs, args.limit, stop, &|event| {
        display.show(event)
    })?;
    display.finish();
    gather(&plan, args.json)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Failure::Failed(format!(
            "interrupted: finished runs are kept; to continue from there:\n  {}",
            again::command(&[])
        )));
    }
    Ok(())
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
    let ended = execute(&plan, points, 1, args.limit, stop, &|event| {
        if let Event::Ended(point, run) = event {
            report(&format!("{}: {}", name(&plan, point), how(run)));
            if !run.is_result()
                && let Ok(mut wanting) = wanting.lock()
            {
                wanting.push(point.number);
            }
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
    let open: Vec<Point> = missing(&plan).into_iter().map(|m| m.0).collect();
    let forecast = Forecast::of(&plan, &open, &args.of.plugins.search()?)?;
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

/// Writes the table of the runs that are there, and says what it holds.
fn gather(plan: &Plan, json: bool) -> Result<(), Failure> {
    let table = Table::of(plan);
    let others = other_runs(plan, &table);
    if table.counts().missing == plan.count() && others > 0 {
        return Err(Failure::Failed(format!(
            "none of the {others} runs in {} is of this study by this program: its build, its laws, the case or a file that it names is another since; \
             tables are left as they are, `fretwork study run` makes the runs again",
            plan.launcher.folder.display()
        )));
    }
    let (csv, parquet) = (plan.out.join("table.csv"), plan.out.join("table.parquet"));
    crate::experiments::study::csv::write(&table, &csv)?;
    crate::experiments::study::parquet::write(&table, &parquet)?;
    let analysis = Analysis::of(plan, &plan.design, &table);
    let settings = plan.out.join("settings.csv");
    crate::experiments::study::csv::write(&Table::of_settings(plan, &analysis), &settings)?;
    let page = plan.out.join("study.html");
    let picture = plan.out.join("study.png");
    let failed = |e: &dyn std::fmt::Display| Failure::Failed(e.to_string());
    sheet(plan, &table, &analysis)
        .write(&page)
        .map_err(|e| failed(&e))?;
    let drawn = draw(plan, &analysis, &picture).map_err(|e| failed(&e))?;
    if !drawn {
        // A picture of an earlier state would be mistaken for one of this.
        let _ = std::fs::remove_file(&picture);
    }
    if json {
        return answer_json(&answers::json(plan, &table));
    }
    answer(&answers::collected(plan, &table, drawn))
}

/// Number of runs in the folder that are no points of the study by this program.
fn other_runs(plan: &Plan, table: &Table) -> usize {
    let own: BTreeSet<&str> = table
        .column("folder")
        .into_iter()
        .flat_map(|c| &c.cells)
        .filter_map(|c| match c {
            Cell::Text(name) => Some(name.as_str()),
            _ => None,
        })
        .collect();
    let folders = std::fs::read_dir(&plan.launcher.folder)
        .into_iter()
        .flatten()
        .flatten();
    folders
        .filter(|f| f.path().join("run.json").is_file())
        .filter(|f| !own.contains(f.file_name().to_string_lossy().as_ref()))
        .count()
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

/// How a run ended, for a line of progress.
fn how(run: &Finished) -> String {
    let took = seconds(run.wall);
    match status(Some(run)) {
        (word, why) if why.is_empty() => format!("{word} in {took}"),
        (word, why) => format!("{} after {took}: {why}", word.to_uppercase()),
    }
}

/// A bar on a terminal, otherwise a line for each run.
struct Display<'a> {
    plan: &'a Plan,
    bar: Option<ProgressBar>,
    silent: bool,
}

impl<'a> Display<'a> {
    fn new(plan: &'a Plan, count: usize, silent: bool) -> Self {
        let terminal =
            std::io::stderr().is_terminal() && std::env::var_os("FRETWORK_QUIET").is_none();
        let bar = (terminal && !silent && count > 0).then(|| {
            let style = ProgressStyle::with_template(
                "{bar:40} {pos}/{len} runs  {elapsed} of about {duration}",
            );
            let bar = ProgressBar::new(count as u64);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.enable_steady_tick(Duration::from_secs(1));
            bar
        });
        Self { plan, bar, silent }
    }

    fn show(&self, event: &Event<'_>) {
        let Event::Ended(point, run) = event else {
            return;
        };
        let line = format!("{}: {}", name(self.plan, point), how(run));
        match &self.bar {
            Some(bar) => {
                if status(Some(run)).0 != crate::experiments::study::table::DONE {
                    bar.println(line);
                }
                bar.inc(1);
            }
            None if !self.silent => report(&line),
            None => {}
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
