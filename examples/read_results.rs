//! Reads the results of a run from disk: the table of steps, recorded states, and the summary.
//!
//! ```sh
//! cargo run --release --no-default-features --features laws,results --example read_results
//! ```
//! The file `results.h5` is described in `docs/outputs/results_h5.md`.

use fretwork::record::results::{Reader, state};
use fretwork::record::{Run, RunOptions};
use std::ops::ControlFlow;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two of five balls arrive at 1 m/s and two leave at 1 m/s; 12 states are recorded.
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let loaded = fretwork::scene::load(&case, &["output.frames=0".to_owned()])?;
    let built = loaded.build(&fretwork::shipped::search_path())?;
    let out = std::env::temp_dir().join(format!("fretwork-results-{}", std::process::id()));
    let options = RunOptions { out, threads: 1 };
    Run::new(&loaded, built, &options).execute(&mut |_| ControlFlow::Continue(()))?;

    // The statistics have columns with units and explanations, and a row per step.
    let path = options.out.join("results.h5");
    let reader = Reader::open(&path)?;
    let (unit, doc) = reader.described("statistics/kinetic");
    let rows = reader.rows("statistics/kinetic")?;
    let kinetic = reader.numbers("statistics/kinetic", (0, rows), 1)?;
    println!("{rows} rows of kinetic energy ({unit}): {doc}");
    assert_eq!((rows, unit.as_str()), (600, "J"));
    // Impacts with a coefficient of restitution of 1 lose no energy.
    assert!(
        kinetic
            .iter()
            .all(|energy| (energy / kinetic[0] - 1.0).abs() < 1e-9)
    );

    // The last recorded state has identities, radii, positions and velocities of the grains.
    let last = state::read(&path, None, 3)?;
    let speeds: Vec<f64> = last
        .grains
        .iter()
        .map(|grain| grain.motion.velocity[0])
        .collect();
    println!("velocities at {} s: {speeds:.6?}", last.time);
    for (speed, expected) in speeds.iter().zip([0.0, 0.0, 0.0, 1.0, 1.0]) {
        assert!((speed - expected).abs() < 1e-9, "{speeds:?}");
    }

    // The summary has the results of the run as the observers report them.
    let summary = std::fs::read_to_string(options.out.join("summary.json"))?;
    assert!(summary.contains("\"quantities\""));
    std::fs::remove_dir_all(&options.out)?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
