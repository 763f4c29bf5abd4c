//! A long run holds no more memory than a short one, and its checkpoint is not larger, counted to
//! the byte.
//!
//! `FRETWORK_LONG=N` sets the number of its steps.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

#[path = "../support/counting.rs"]
mod counting;

use counting::held;
use fretwork::record::checkpoint::Frame;
use fretwork::record::cycle::Cycle;
use fretwork::record::results::PreviousResults;
use fretwork::record::{RunOptions, run};
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use std::path::Path;

#[global_allocator]
static COUNTING: counting::Counting = counting::Counting;

/// Permitted variation by the present number of contacts, rows that are not yet written and the
/// index of the file (bytes).
const SLACK: usize = 64 << 10;

/// Grains on a floor, which holds some of them by bonds, are sheared to and fro by a lid in 100
/// steps per cycle.
const RUBBED: &str = r#"(
    name: "rubbed for long", dimension: 2,
    time: (step: 1e-4, end: 2.0), gravity: [0.0, -9.81], periodic: (x: 0.02),
    solver: (tolerance: 1e-3, max_iterations: 60),
    materials: {"grain": "glass_bead", "steel": "rail_steel_r260"},
    interfaces: [
        (name: "grains", between: ("grain", "grain"), contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.3})),
        (
            name: "floor", between: ("steel", "grain"), contact: "coulomb", cohesion: "elastic-bond", bonds: Start,
            parameters: (contact: {"mu": 0.5}),
        ),
    ],
    bodies: [
        (name: "floor", material: "steel", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "lid", material: "grain", shapes: [HalfSpace(normal: [0.0, -1.0])], position: [0.0, 0.0062], mass: 0.1,
            dofs: (x: Displacement(Sine(amplitude: 1e-4, frequency: 100.0)), y: Force(Constant(-100.0))),
        ),
    ],
    grains: [Lattice(material: "grain", count: 27, radius: (1e-3, 1e-3), low: [0.0, 0.0], high: [0.02, 0.0061])],
    friction: (body: "lid", along: 0, normal: 1),
    circuit: (bases: ["floor"], every: 1),
    measures: [
        Shear(name: "flow", low: 0.001, high: 0.005),
        Profile(name: "profile", axis: 1, low: [0.0, 0.0], high: [0.02, 0.006], bins: 5),
        Mass(name: "upper", axis: 1, above: 0.003),
        ThirdBody(name: "layer", between: ("floor", "lid"), along: 0, across: 1, bins: 4, slices: 2),
    ],
    output: (frames: 0, views: 20, figures: false, checkpoint: Steps(500)),
)"#;

/// Bytes held after each step of a run, and bytes of the state in the last checkpoint.
fn followed(name: &str, text: &str, steps: u64) -> (Vec<usize>, usize) {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let sets = [format!("time.end={:e}", 1e-4 * steps as f64)];
    let loaded = load_text("long_run.ron", text, &cases, &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build(&search_path());
    let built = built.unwrap_or_else(|e| panic!("{e}"));
    let out = std::env::temp_dir().join(format!("fretwork-long-{}-{name}", std::process::id()));
    std::fs::remove_dir_all(&out).ok();
    let options = RunOptions {
        out: out.clone(),
        threads: 1,
    };
    // The list of counts must not be counted.
    let mut seen = Vec::with_capacity(steps as usize);
    let mut progress = |_: &fretwork::record::Progress| seen.push(held());
    run(&loaded, built, &options, &mut progress).unwrap_or_else(|e| panic!("{e}"));
    let kept = PreviousResults::open(&out.join("results.h5")).unwrap();
    let slots = kept.checkpoints().unwrap();
    let states = slots
        .iter()
        .flatten()
        .filter_map(|b| Frame::read(b))
        .map(|f| f.state.len());
    let state = states.max().unwrap();
    drop(kept);
    std::fs::remove_dir_all(&out).unwrap();
    (seen, state)
}

/// Largest number of bytes held in the last thousand of a number of steps, but for the very last:
/// at the end of a run the state from which it can go on is held too.
fn most(seen: &[usize], steps: usize) -> usize {
    seen[steps - 1000..steps - 1].iter().copied().max().unwrap()
}

/// Memory that the list of cycles may take: each cycle is written at the end, so it must be kept.
/// The list doubles its capacity when it is full.
fn of_cycles(steps: usize) -> usize {
    (steps / 100).next_power_of_two() * size_of::<Cycle>()
}

#[test]
fn a_rubbed_layer_holds_no_more_but_its_cycles() {
    const SHORT: usize = 4_000;
    let long = std::env::var("FRETWORK_LONG").map_or(20_000, |n| n.parse().unwrap());
    let (_, small) = followed("short", RUBBED, SHORT as u64);
    let (seen, large) = followed("long", RUBBED, long as u64);
    let (early, late) = (most(&seen, SHORT), most(&seen, long));
    println!("held {early} and {late} bytes, states {small} and {large}");
    for k in (1000..=long).step_by(1000) {
        println!("{k} {}", most(&seen, k));
    }
    let cycles = of_cycles(long) - of_cycles(SHORT);
    assert!(late <= early + cycles + SLACK, "{early} to {late}");
    // The state of the end: in its frame, and as it is written.
    let end = seen[long - 1];
    assert!(end <= late + 3 * large + SLACK, "{late} to {end}");
    let cycles = (long - SHORT) / 100 * size_of::<Cycle>();
    assert!(large <= small + cycles + SLACK, "{small} to {large}");
}
