//! `fretwork run`.

use super::progress::Display;
use super::{CaseArgs, Failure, say, say_json};
use crate::record::checkpoint::Found;
use crate::record::{self, RunError, RunOptions, Summary};
use crate::scene::build::{Dimensional, Origin};
use crate::scene::interfaces::without_interface;
use crate::scene::source::clean;
use crate::scene::{Built, Loaded, Scene, load};
use crate::step::StepError;
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct RunArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder of the results; results/<case> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; the results have the same bits for any number
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Go on from the last checkpoint of the same run in the folder; the results are those of a run that was not stopped
    #[arg(long)]
    resume: bool,
    /// No progress; the summary is printed as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let loaded = load(&args.case.case, &args.case.sets)?;
    let scene = loaded.build(&args.case.plugins.search()?)?;
    let options = RunOptions {
        out: folder(args),
        threads: args.threads.into(),
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| Failure::Usage(format!("cannot start {} threads: {e}", options.threads)))?;
    if !args.json {
        say(&format!(
            "{}: {}",
            loaded.path.display(),
            clean(&loaded.case.name)
        ));
    }
    let done = pool.install(|| match scene {
        Scene::Plane(built) => go(&loaded, *built, &options, args),
        Scene::Solid(built) => go(&loaded, *built, &options, args),
    })?;
    let Some(summary) = done else {
        return Ok(());
    };
    if args.json {
        say_json(&serde_json::to_string_pretty(&summary).unwrap_or_default());
    } else {
        say(&format!(
            "{}\n{}  results in {}",
            clean(&summary.case),
            summary.text(),
            options.out.display()
        ));
    }
    Ok(())
}

/// Runs, or goes on; none where there is nothing left to do.
fn go<S: Dimensional>(
    loaded: &Loaded,
    built: Built<S>,
    options: &RunOptions,
    args: &RunArgs,
) -> Result<Option<Summary>, Failure> {
    let tell = |text: String| {
        if !args.json {
            say(&text);
        }
    };
    for pair in without_interface(&loaded.case, &built.simulation.table) {
        tell(format!("no interface: {pair}"));
    }
    let out = options.out.display();
    let mut stop = None;
    if args.resume {
        match record::stopped(loaded, &built, options)? {
            Found::Nothing => tell(format!("nothing to resume in {out}: begins at the start")),
            Found::State(state) => {
                tell(format!("resumes the run in {out}"));
                stop = Some(state);
            }
            Found::Finished => {
                let path = options.out.join("summary.json");
                match std::fs::read_to_string(&path).ok().filter(|_| args.json) {
                    Some(summary) => say_json(summary.trim_end()),
                    None => say(&format!(
                        "the run in {out} is finished: nothing to do; to run it anew leave --resume out"
                    )),
                }
                return Ok(None);
            }
        }
    }
    let mut built = built;
    let origins = std::mem::take(&mut built.origins);
    let mut display = Display::new(args.json);
    let mut step = |p: &record::Progress| display.step(p);
    let summary = match stop {
        Some(stop) => record::go_on(loaded, built, options, stop, &mut step),
        None => record::run(loaded, built, options, &mut step),
    };
    display.finish();
    summary
        .map(Some)
        .map_err(|error| match place(loaded, &origins, &error) {
            Some(place) => Failure::Failed(format!("{error}; {place}")),
            None => Failure::Run(error),
        })
}

/// Where the case writes the law or the body that ended a run.
fn place(loaded: &Loaded, origins: &[Origin], error: &RunError) -> Option<String> {
    let (path, what) = match error {
        RunError::Step(StepError::Law { source, .. }) => {
            let (kind, name) = source.law()?;
            let slot = kind.word();
            let interfaces = &loaded.case.interfaces;
            let k = interfaces.iter().position(|i| i.law(kind) == Some(name))?;
            let what = format!("interface `{}` has this law", interfaces[k].name);
            (format!("interfaces.{k}.{slot}"), what)
        }
        RunError::Step(StepError::NotFinite { body, .. }) => {
            let origin = origins.get(usize::try_from(*body).ok()?)?;
            (origin.path(), "the body is written".to_owned())
        }
        _ => return None,
    };
    let (line, column) = loaded.source.position_of(&path)?;
    let file = loaded.path.display();
    Some(format!("{what} at {file}:{line}:{column}"))
}

fn folder(args: &RunArgs) -> PathBuf {
    args.out.clone().unwrap_or_else(|| {
        let name = args.case.case.file_stem().unwrap_or_default();
        Path::new("results").join(name)
    })
}
