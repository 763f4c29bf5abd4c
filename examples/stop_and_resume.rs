//! Stops a run by a callback and resumes it later. The results are bit-identical to those of a run
//! that was not stopped.
//!
//! ```sh
//! cargo run --release --no-default-features --features laws,results --example stop_and_resume
//! ```

use fretwork::record::checkpoint::FolderState;
use fretwork::record::{Run, RunOptions, stopped};
use fretwork::scene::LoadedCase;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Runs a case in a folder to its end or to a number of steps, and resumes a stopped run. Returns
/// the reason why it stopped, if it did.
fn run(loaded: &LoadedCase, out: &Path, until: Option<u64>) -> Result<Option<String>, String> {
    let options = RunOptions {
        out: out.to_owned(),
        threads: 1,
    };
    let laws = fretwork::shipped::search_path();
    let built = loaded.build(&laws).map_err(|e| e.to_string())?;
    let found = stopped(loaded, &built, &options).map_err(|e| e.to_string())?;
    let mut run = Run::new(loaded, built, &options);
    match found {
        FolderState::Nothing => {}
        FolderState::State(state) => run = run.resume(state),
        FolderState::Finished => return Ok(None),
    }
    // The callback is called after each step. When it stops the run, all files are complete.
    let summary = run.execute(&mut |progress| match until {
        Some(steps) if progress.steps.0 == steps => ControlFlow::Break("had enough".to_owned()),
        _ => ControlFlow::Continue(()),
    });
    summary.map(|s| s.run.stopped).map_err(|e| e.to_string())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let loaded = fretwork::scene::load(&case, &["output.frames=0".to_owned()])?;
    let folder = std::env::temp_dir().join(format!("fretwork-resume-{}", std::process::id()));
    let [whole, parts]: [PathBuf; 2] = ["whole", "parts"].map(|name| folder.join(name));

    assert_eq!(run(&loaded, &whole, None)?, None);
    let why = run(&loaded, &parts, Some(250))?.ok_or("it was not stopped")?;
    println!("{why}");
    assert_eq!(why, "had enough after step 250 of 600");
    let rows = |out: &Path| std::fs::read_to_string(out.join("statistics.csv"));
    assert_eq!(rows(&parts)?.lines().count(), 251);

    // The rest is run as by another program that knows only the case and the folder.
    assert_eq!(run(&loaded, &parts, None)?, None);
    assert_eq!(rows(&parts)?, rows(&whole)?);

    // The state of a simulation is saved without files, and another one that was built from the
    // case and made no step yet continues from it.
    let build = || loaded.build(&fretwork::shipped::search_path());
    let mut simulation = build()?.simulation;
    simulation.step()?;
    let saved = simulation.save()?;
    simulation.step()?;
    let mut other = build()?.simulation;
    assert!(other.restore(&saved)?.is_some());
    other.step()?;
    assert_eq!(other.motion(0), simulation.motion(0));
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
