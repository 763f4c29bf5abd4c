//! `fretwork run`.

use super::progress::Display;
use super::{CaseArgs, Failure, say};
use crate::record::{self, RunOptions, Summary};
use crate::scene::{Loaded, Scene, load};
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
        say(&format!("{}: {}", loaded.path.display(), loaded.case.name));
    }
    let summary = pool.install(|| go(&loaded, scene, &options, args.json))?;
    if args.json {
        say(&serde_json::to_string_pretty(&summary).unwrap_or_default());
    } else {
        say(&format!(
            "{}\n{}  results in {}",
            summary.case,
            summary.text(),
            options.out.display()
        ));
    }
    Ok(())
}

fn go(
    loaded: &Loaded,
    scene: Scene,
    options: &RunOptions,
    quiet: bool,
) -> Result<Summary, Failure> {
    let mut display = Display::new(quiet);
    let mut step = |p: &record::Progress| display.step(p);
    let summary = match scene {
        Scene::Plane(built) => record::run(loaded, *built, options, &mut step),
        Scene::Solid(built) => record::run(loaded, *built, options, &mut step),
    };
    display.finish();
    Ok(summary?)
}

fn folder(args: &RunArgs) -> PathBuf {
    args.out.clone().unwrap_or_else(|| {
        let name = args.case.case.file_stem().unwrap_or_default();
        Path::new("results").join(name)
    })
}
