//! `fretwork run`.

use super::progress::Display;
use super::{CaseArgs, Failure, say, say_json};
use crate::record::checkpoint::Found;
use crate::record::{self, RunOptions, Summary};
use crate::scene::build::Dimensional;
use crate::scene::interfaces::without_interface;
use crate::scene::source::clean;
use crate::scene::{Built, Loaded, Scene, load};
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
    let mut display = Display::new(args.json);
    let mut step = |p: &record::Progress| display.step(p);
    let summary = match stop {
        Some(stop) => record::go_on(loaded, built, options, stop, &mut step),
        None => record::run(loaded, built, options, &mut step),
    };
    display.finish();
    Ok(Some(summary?))
}

fn folder(args: &RunArgs) -> PathBuf {
    args.out.clone().unwrap_or_else(|| {
        let name = args.case.case.file_stem().unwrap_or_default();
        Path::new("results").join(name)
    })
}
