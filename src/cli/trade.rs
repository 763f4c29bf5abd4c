//! `fretwork trade`: studies of accuracy against cost.

mod levels;
mod refuse;

use super::number::{not_negative, share};
use super::output::{answer_json, inform, report};
use super::{CaseArgs, Failure, again};
use crate::experiments::runs::RunsError;
use crate::experiments::runs::duration::{parse as duration, seconds};
use crate::experiments::runs::launcher::Launcher;
use crate::experiments::runs::offer::Offer;
use crate::experiments::runs::perturbation::Perturbation;
use crate::experiments::runs::randomness::seed_matters;
use crate::experiments::runs::stored::{Limits, Status};
use crate::experiments::trade::compare::Comparison;
use crate::experiments::trade::output::Output;
use crate::experiments::trade::parameters::{Solving, StudyParameter};
use crate::experiments::trade::rung::Deformability;
use crate::experiments::trade::setting::Setting;
use crate::experiments::trade::study::{Event, Ledger, Study};
use crate::experiments::trade::{
    OWNER, TradeError, figure, files, forecast::Forecast, table, verdict::verdicts,
};
use crate::interrupt;
use crate::record::check_names;
use crate::scene::build::Built;
use crate::scene::methods::{Demands, Service};
use crate::scene::most_steps::most_steps;
use crate::scene::source::clean;
use crate::scene::{Loaded, Scene, load};
use crate::solve::local::solver::Method;
use clap::Args;
use fretwork_observe::standard::Observed;
use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

#[derive(Args, Debug)]
pub struct TradeArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// An output and its wanted error: a name of summary.json (wear.Qs) or statistics.COLUMN (mean of the
    /// last half; :max, :min, :last), =1% or =0.003 in its unit; by default friction, damage ratio and wear
    /// at 1 %
    #[arg(long = "output", value_name = "NAME=ERROR")]
    outputs: Vec<String>,
    /// Exact value of an output, for example from a closed form; errors are then measured against it
    #[arg(long = "exact", value_name = "NAME=VALUE")]
    exact: Vec<String>,
    /// Parameter to vary: step, tolerance, solver, test_every, coupling, correction; and, only where named,
    /// accuracy, grains, rung (what deforms)
    #[arg(long = "knob", value_name = "NAME")]
    parameters: Vec<String>,
    /// Vary any value of the case; the first value is that of the reference
    #[arg(long = "vary", value_name = "KEY.PATH=A,B,C")]
    vary: Vec<String>,
    /// Compare another file as a form of the case, the finest first; the case itself may be one of them
    #[arg(long = "variant", value_name = "NAME=FILE")]
    variants: Vec<String>,
    /// Seeds per setting, from the case's own upwards; one run if nothing is random and contacts are not
    /// chaotic
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    seeds: u16,
    /// Time budget of the study: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = duration)]
    budget: Duration,
    /// Parallel runs; they disturb each other's timing, so 1 times best
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Folder of the results, in which an interrupted study also continues; by default results/trade/<case>
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Largest fraction of steps that may miss the tolerance in an accepted run
    #[arg(long, value_name = "SHARE", default_value_t = 1e-2, value_parser = share)]
    unconverged: f64,
    /// Largest energy residual, relative to the largest energy, of an accepted run
    #[arg(long, value_name = "SHARE", default_value_t = 1e-2, value_parser = not_negative)]
    residual: f64,
    /// Show no progress; print the study as JSON
    #[arg(long)]
    json: bool,
}

impl From<TradeError> for Failure {
    fn from(e: TradeError) -> Self {
        match e {
            TradeError::Input(e) => Self::Input(e),
            TradeError::Usage(text) => Self::Usage(text),
            TradeError::Runs(e) => e.into(),
            other => Self::Failed(other.to_string()),
        }
    }
}

impl From<RunsError> for Failure {
    fn from(e: RunsError) -> Self {
        match e {
            RunsError::Input(e) => Self::Input(e),
            RunsError::Usage(text) => Self::Usage(text),
            other => Self::Failed(other.to_string()),
        }
    }
}

pub fn trade(args: &TradeArgs) -> Result<(), Failure> {
    let started = Instant::now();
    let search = args.case.plugins.search()?;
    let loaded = load(&args.case.case, &args.case.sets)?;
    let scene = loaded.build(&search)?;
    check_names(&loaded, &scene)?;
    let first = Facts::of(&loaded, &scene);
    let outputs = refuse::outputs(args, &first.offer)?;
    let random = seed_matters(&loaded, &scene, &search)?;
    let parameters = levels::parameters_of(args, &loaded, &search, &first)?;
    if parameters.is_empty() {
        return Err(Failure::Usage(
            "nothing to vary; name a --knob or --vary".into(),
        ));
    }
    let out = args.out.clone().unwrap_or_else(|| {
        let name = args.case.case.file_stem().unwrap_or_default();
        Path::new("results").join("trade").join(name)
    });
    // An earlier study in the folder may have done all runs already.
    let begun = out.join("runs").is_dir();
    let mut scene = Some(scene);
    if !begun && let Some(scene) = scene.take() {
        refuse::budget(args, &loaded, scene)?;
    }
    let limits = Limits {
        unconverged: args.unconverged,
        residual: args.residual,
    };
    let _lock = OWNER.take(&out)?;
    let plugins = args.case.plugins.words();
    let mut launcher = Launcher::new(
        &loaded.path,
        loaded.source.sets(),
        plugins,
        &out.join("runs"),
        limits,
    )?;
    let own = Setting::own(&parameters).sets(&parameters);
    if let Some(scene) = scene
        && launcher.stored(&own, loaded.case.seed).is_none()
    {
        refuse::budget(args, &loaded, scene)?;
    }
    launcher.perturbation = (!random).then_some(Perturbation {
        first: loaded.case.seed,
    });
    let stop = interrupt::watch();
    refuse::after_two_steps(args, &loaded, &launcher, &outputs, stop)?;
    let mut study = new_study(
        args, &loaded, launcher, parameters, outputs, random, started,
    );
    study.test_for_chaos(args.seeds.into(), stop)?;
    study.prepare(stop)?;
    if !args.json {
        let title = clean(&loaded.case.name);
        inform(&format!("{}: {title}", loaded.path.display()));
        inform(&table::forecast(&study));
    }
    let expected = study.work(&[study.first(), study.one_at_a_time()].concat());
    let quiet = args.json
        || !(std::io::stderr().is_terminal() || std::env::var_os("FRETWORK_QUIET").is_none());
    study.execute(stop, &|event| {
        if !quiet {
            report_event(event, started);
        }
    })?;
    let interrupted = stop.load(Ordering::Relaxed);
    report_study(args, &study, &loaded, &out, expected, interrupted)
}

/// The study before its first run, with the notes that its options call for.
fn new_study(
    args: &TradeArgs,
    loaded: &Loaded,
    launcher: Launcher,
    parameters: Vec<StudyParameter>,
    outputs: Vec<Output>,
    random: bool,
    started: Instant,
) -> Study {
    let seeds = if random { u64::from(args.seeds) } else { 1 };
    let mut notes = Vec::new();
    if !random && args.seeds == 1 {
        notes.push("Nothing in the case is drawn from its seed, and one run a setting does not show whether contacts are chaotic: errors have no intervals.".into());
    } else if random && seeds == 1 {
        notes.push("One seed gives no scatter: no error has an interval, and no conclusion can be drawn. Give --seeds 3 or more.".into());
    }
    notes.push("Precision is not varied: Fretwork computes and stores in f64 only.".into());
    for k in &parameters {
        let left_out = k.left_out.iter();
        notes.extend(
            left_out.map(|(level, why)| format!("{} {level} is not offered: {why}.", k.name)),
        );
    }
    if args.jobs > 1 {
        notes.push(format!("{} runs ran in parallel, which disturbs their timing; visits (contacts times iterations) do not depend on it.", args.jobs));
    }
    Study {
        launcher: Arc::new(launcher),
        parameters,
        outputs,
        seeds: (0..seeds)
            .map(|k| loaded.case.seed.wrapping_add(k))
            .collect(),
        random,
        steps: most_steps(&loaded.case) as f64,
        jobs: args.jobs.into(),
        budget: args.budget,
        done: Ledger::new(),
        forecast: Forecast {
            own: 1.0,
            power: 0.0,
            forms: Vec::new(),
            measured: false,
        },
        reused: 0,
        fresh: 0,
        left_out: BTreeSet::new(),
        notes,
        started,
    }
}

/// Reports a run that begins or has ended.
fn report_event(event: &Event<'_>, started: Instant) {
    let elapsed = seconds(started.elapsed().as_secs_f64());
    match event {
        Event::Begins(name, seed, expected) => report(&format!(
            "[{elapsed}] {name}, seed {seed}: {} expected",
            seconds(*expected)
        )),
        Event::Ended(name, seed, run) => {
            let how = match &run.status {
                Status::Done => "done",
                Status::Refused(_) | Status::Failed(_) | Status::Rejected(_) => "FAILED",
                Status::Slow(_) => "slower than the reference",
            };
            report(&format!(
                "[{elapsed}] {name}, seed {seed}: {how} in {}",
                seconds(run.seconds)
            ));
        }
    }
}

/// Writes the files and prints the report.
fn report_study(
    args: &TradeArgs,
    study: &Study,
    loaded: &Loaded,
    out: &Path,
    expected: f64,
    interrupted: bool,
) -> Result<(), Failure> {
    let found = study.compare();
    let verdicts = verdicts(&found, &study.outputs, study.random);
    let complete = study.left_out.is_empty() && study.dropped().is_empty() && !interrupted;
    let json = files::json(study, &found, &verdicts, complete);
    let text = serde_json::to_string_pretty(&json).unwrap_or_default();
    let drawn = write_files(study, &found, &text, &loaded.case.name, out)?;
    let ended = if interrupted {
        Err(Failure::Failed(format!(
            "interrupted: finished runs are kept; to continue from there:\n  {}",
            again::command(&[])
        )))
    } else {
        Ok(())
    };
    if args.json {
        return answer_json(&text).and(ended);
    }
    inform("");
    inform(table::text(study, &found, &verdicts).trim_end());
    inform(&format!(
        "{} runs in {}, {} reused from earlier studies; the forecast for the reference and one parameter at a time was {}",
        study.fresh,
        seconds(study.started.elapsed().as_secs_f64()),
        study.reused,
        seconds(expected)
    ));
    if !complete {
        inform(&incomplete(study, interrupted));
    }
    let last = if drawn {
        format!("{}/trade.png", out.display())
    } else {
        "no picture: no setting has a known error".into()
    };
    inform(&format!(
        "{0}/trade.csv, {0}/trade.json, {last}",
        out.display()
    ));
    ended
}

/// Writes the files of a study; returns whether there is a picture.
fn write_files(
    study: &Study,
    found: &Comparison,
    json: &str,
    title: &str,
    out: &Path,
) -> Result<bool, Failure> {
    let path = out.join("trade.json");
    std::fs::write(&path, format!("{json}\n"))
        .map_err(|e| Failure::Failed(format!("cannot write {}: {e}", path.display())))?;
    files::csv(study, found, &out.join("trade.csv"))?;
    let picture = out.join("trade.png");
    let drawn = figure::draw(study, found, title, &picture).map_err(TradeError::from)?;
    if !drawn {
        // A picture of an earlier study would be mistaken for one of this study.
        let _ = std::fs::remove_file(&picture);
    }
    Ok(drawn)
}

/// What a study did not run, and why.
fn incomplete(study: &Study, interrupted: bool) -> String {
    let left_out = study.left_out.iter();
    let names: Vec<String> = left_out.map(|s| s.name(&study.parameters)).collect();
    let dropped = study.dropped();
    let why = if interrupted {
        "interrupted"
    } else {
        "the budget is spent"
    };
    let mut what = if names.is_empty() {
        String::new()
    } else {
        format!(" Not run, or not over all seeds: {}.", names.join("; "))
    };
    if !dropped.is_empty() {
        what.push_str(&format!(
            " Finer than this budget allows the reference: {}; a larger --budget includes them.",
            dropped.join("; ")
        ));
    }
    format!("INCOMPLETE, {why}.{what} The same command continues from here.")
}

/// Properties of a scene that a study needs.
struct Facts {
    solving: Solving,
    offer: Offer,
}

impl Facts {
    fn of(loaded: &Loaded, scene: &Scene) -> Self {
        match scene {
            Scene::Dim2(built) => Self::from(loaded, built),
            Scene::Dim3(built) => Self::from(loaded, built),
        }
    }

    fn from<S: Observed>(loaded: &Loaded, built: &Built<S>) -> Self {
        let s = &built.simulation;
        let demands = Demands::of(s);
        let serves =
            |m: &Method| *m == loaded.case.solver.method || demands.service(*m) == Service::Serves;
        Self {
            offer: Offer::of(&loaded.case, built),
            solving: Solving {
                methods: Method::ALL.iter().copied().filter(serves).collect(),
                tolerance: s.options.solver.tolerance,
                deformability: Deformability::of(&loaded.case, built),
            },
        }
    }
}
