//! An observer of your own: it evaluates each step of a run. The value that it reports is in
//! `summary.json`, the report and tables of studies, with its unit and explanation.
//!
//! ```sh
//! cargo run --release --no-default-features --features results --example own_observer
//! ```

use fretwork::laws::SearchPath;
use fretwork::record::quantity::Findings;
use fretwork::record::quantity::unit::SPEED;
use fretwork::record::{Observer, Run, RunEnd, RunOptions, RunView};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{GrainSpec, OneGrain};
use fretwork::step::StepReport;
use std::ops::ControlFlow;

/// The highest speed of a body in the run (m/s).
#[derive(Debug, Default)]
struct Fastest(f64);

impl Observer for Fastest {
    fn name(&self) -> String {
        "fastest".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        let speeds = (0..run.bodies().len()).map(|body| run.motion(body).speed());
        self.0 = speeds.fold(self.0, f64::max);
    }

    fn report(&self, _: &RunEnd<'_>, found: &mut Findings) {
        let doc = "highest speed of a body in the run";
        found
            .add("speed.highest", self.0, SPEED, doc)
            .headline("highest speed");
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let loaded = CaseBuilder::in_space("two balls in flight")
        .time(1e-3, 0.3)
        .gravity([0.0, 0.0, -9.81])
        .material("glass", "glass_bead")
        .grains(GrainSpec::balls(
            "glass",
            [
                OneGrain::new([0.0, 0.0, 0.0], 0.01).velocity([3.0, 0.0, 0.0]),
                OneGrain::new([0.0, 0.1, 0.0], 0.01).velocity([0.0, 0.0, 4.0]),
            ],
        ))
        .load()?;
    let built = loaded.build(&SearchPath::new(&[]))?;
    let out = std::env::temp_dir().join(format!("fretwork-observer-{}", std::process::id()));
    let options = RunOptions { out, threads: 1 };
    let run = Run::new(&loaded, built, &options).observe(Fastest::default());
    let summary = run.execute(&mut |_| ControlFlow::Continue(()))?;

    // The first ball ends at the speed sqrt(3^2 + (g t)^2), the second began with 4 m/s, less g h
    // after the first step.
    let expected = 3f64.hypot(9.81 * 0.3).max(4.0 - 9.81e-3);
    let found = summary
        .found
        .number("speed.highest")
        .ok_or("it is not reported")?;
    println!("highest speed {found:.4} m/s");
    assert!((found - expected).abs() < 1e-9 * expected);

    // The value is printed as text, and available to other programs.
    assert!(summary.text(false).contains("highest speed"));
    let json = std::fs::read_to_string(options.out.join("summary.json"))?;
    assert!(json.contains("highest speed of a body in the run"));
    std::fs::remove_dir_all(&options.out)?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
