//! Repeated steps have no effect on a run, and the error that they report is right where it is
//! known.

use super::common::{Folder, Job};
use super::state::{all, built, steps};
use fretwork::AnySimulation;
use fretwork::geometry::space::{Dim2, Space};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Coupling;
use fretwork::step::Simulation;
use fretwork_observe::error_estimate::{Change, ErrorEstimate, Repeats};
use std::path::Path;

/// Steps a simulation in which some steps are repeated with other settings, and one in which none
/// are.
fn leave_no_trace<S: Space>(both: [Simulation<S>; 2], before: u32, after: u32) {
    let [mut whole, mut repeated] = both;
    for s in [&mut whole, &mut repeated] {
        // Recession is a process of the scene; it declares that it can be repeated.
        assert_eq!(s.repeatable(), Ok(()));
        steps(s, before);
        // The next step would do this.
        s.between_steps().unwrap();
    }
    let bytes = all(&repeated);
    let (options, parameters) = (repeated.options, parameters(&repeated));
    let other_bits = repeated.repeat(|s| {
        s.change_step(0.25 * s.options.scheme.h);
        s.options.solver.tolerance *= 0.1;
        s.options.coupling = Coupling::Implicit {
            tolerance: 1e-3,
            max_iterations: 5,
        };
        steps(s, 4 * after);
        all(s) != bytes
    });
    assert_eq!(other_bits, Ok(true));
    assert!(all(&repeated) == bytes, "the state is not restored");
    assert!(repeated.options == options && self::parameters(&repeated) == parameters);
    steps(&mut whole, after);
    steps(&mut repeated, after);
    assert!(all(&whole) == all(&repeated), "the steps after it differ");
}

fn parameters<S: Space>(s: &Simulation<S>) -> Vec<Vec<f64>> {
    let laws = s.laws.iter().flat_map(|l| l.loaded());
    laws.map(|l| l.parameters.clone()).collect()
}

fn check(case: &str, sets: &[&str], before: u32, after: u32) {
    match [built(case, sets), built(case, sets)] {
        [AnySimulation::Plane(a), AnySimulation::Plane(b)] => {
            leave_no_trace([*a, *b], before, after)
        }
        [AnySimulation::Space(a), AnySimulation::Space(b)] => {
            leave_no_trace([*a, *b], before, after)
        }
        _ => panic!("one case, two dimensions"),
    }
}

#[test]
fn the_steps_after_repeated_ones_have_the_same_bits() {
    check("plane_shear", &["grains.0.count=80"], 40, 20);
    check("shear_cell_3d", &[], 20, 10);
    check("verification/worn_slide", &[], 30, 20);
    check("verification/worn_slide_3d", &[], 30, 20);
    check("verification/bond_mixed", &[], 60, 60);
    check("verification/rubber_block", &[], 10, 10);
}

/// A phase that begins in a repeated step, and sets a parameter of a law there, has not begun in
/// the run.
#[test]
fn a_phase_that_begins_in_a_repeated_step_has_not_begun() {
    let sets = [
        "grains.0.count=60",
        "phases=[(name: \"one\", until: Time(0.002)), (name: \"two\", tolerance: 1e-6)]",
        "measures=[]",
    ];
    check("rotating_drum_2d", &sets, 5, 40);
}

/// A run with repeated steps is bit-identical to one without, whatever acts in it.
#[test]
fn a_run_with_repeated_steps_has_the_same_statistics() {
    let fretting: &[&str] = &["grains.0.count=300", "time.step=1e-4", "time.end=0.056"];
    let circuit: &[&str] = &["grains.0.count=200", "time.step=2e-5", "time.end=0.055"];
    let drum: &[&str] = &["grains.0.count=60", "time.end=0.3", "measures=[]"];
    for (case, sets) in [
        ("wheel_rail_rigid", fretting),
        ("third_body_steady", circuit),
        ("fretting_wear_jump", &["time.end=0.4"]),
        ("rotating_drum_2d", drum),
    ] {
        let rows = ["repeats=0", "repeats=6"].map(|repeats| {
            let folder = Folder::new(&format!("repeats-{case}-{repeats}"));
            let repeats = format!("uncertainty.{repeats}");
            let mut sets = sets.to_vec();
            let common = [
                repeats.as_str(),
                "output.frames=0",
                "output.figures=false",
                "output.checkpoint=Never",
            ];
            sets.extend(common);
            let job = Job { case, sets: &sets };
            job.done(&folder.0, &[]);
            let text = std::fs::read_to_string(folder.0.join("summary.json")).unwrap();
            let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
            let done = &summary["uncertainty"]["repeats"];
            let places = done["places"].as_u64().unwrap();
            assert_eq!(places > 5, repeats.ends_with('6'), "{case}: {done}");
            assert_eq!(done["failed"], 0, "{case}: {done}");
            std::fs::read(folder.0.join("statistics.csv")).unwrap()
        });
        assert!(rows[0] == rows[1], "{case}");
    }
}

/// A block slides to a stop with theta = 1: its path in n steps of h is n h v - mu g h^2 n (n +
/// 1)/2, so that the energy of friction is too small by a fraction that is linear in h, and the
/// estimate is exact.
#[test]
fn the_error_of_a_step_of_first_order_is_found() {
    for length in [1, 3, 6] {
        slide_to_a_stop(length);
    }
}

fn slide_to_a_stop(length: u32) {
    let (v, deceleration, h) = (1.0, 0.3 * 9.81, 1e-3);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/slide_to_stop.ron");
    let sets = ["time.theta=1.0", "time.step=1e-3", "uncertainty.repeats=8"];
    let mut sets = sets.map(str::to_owned).to_vec();
    sets.push(format!("uncertainty.steps={length}"));
    let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
    let mut s = loaded.build_in::<Dim2>(&search_path()).unwrap();
    let block = s.state.bodies.len() - 1;
    s.state.bodies.velocity[block].x = v;
    let total = 200;
    let mut estimate = ErrorEstimate::new(&loaded.case, &s, total);
    for _ in 0..total {
        let done = s.state.steps;
        estimate.before_step(&mut s, done, None).unwrap();
        let report = s.step().unwrap();
        estimate.after_step(&s, &report);
    }
    let found: Repeats = estimate.report(&s.state.energy, 0.0, None);
    assert_eq!((found.places, found.failed, found.steps), (8, 0, length));
    // The later half of the steps is compared, from the velocity that is left after the first half.
    let earlier = f64::from(length / 2);
    let later = f64::from(length) - earlier;
    let paths = |coarse: f64| -> f64 {
        let path = |at: &u64| {
            let start = v - deceleration * h * (*at as f64 + earlier);
            later * h * start - 0.5 * deceleration * h * h * (later * later + coarse)
        };
        found.at.iter().map(path).sum()
    };
    let expected = paths(0.0) / paths(later) - 1.0;
    let Change { change, half_width } = found.step.friction_energy.unwrap();
    assert!(expected > 3e-4, "{expected}");
    assert!(
        (change / expected - 1.0).abs() < 1e-6,
        "{change} {expected}"
    );
    // The share differs from place to place, with the velocity.
    assert!(half_width > 0.0 && half_width < change, "{half_width}");
    // The solver is exact: a tighter tolerance changes nothing.
    let tolerance = found.tolerance.friction_energy.unwrap();
    assert!(tolerance.bound() < 1e-9, "{tolerance:?}");
    assert_eq!(found.coupling, None);
    assert_eq!(found.shares.correction, Some(0.0));
}
