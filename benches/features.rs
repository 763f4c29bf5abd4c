//! What each feature costs where it is on, and that it costs nothing where it is off.
//!
//! `cargo bench --bench features` steps the boxes of 5,000 disks and spheres at rest with one feature after another
//! and prints the table of `docs/features.md`. Variants take turns, and the least of several rounds counts, so that
//! what else the machine does counts as little as it can.

use fretwork::contact::Bond;
use fretwork::geometry::space::{Plane, Solid, Space};
use fretwork::laws::SearchPath;
use fretwork::scene::build::Dimensional;
use fretwork::scene::load;
use fretwork::solve::Problem;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::Instant;

/// A feature: its name and the `--set`s that switch it on.
type Feature = (&'static str, &'static [&'static str]);

const FEATURES: [Feature; 9] = [
    (
        "no friction",
        &[
            "interfaces.0.contact=frictionless",
            "interfaces.0.parameters.contact={}",
        ],
    ),
    ("Coulomb friction (the base)", &[]),
    (
        "friction against rotation",
        &[
            "interfaces.0.contact=rolling-friction",
            "interfaces.0.parameters.contact={}",
        ],
    ),
    ("wear (archard)", &["interfaces.0.wear=archard"]),
    (
        "a bond law, no bonds",
        &[
            "interfaces.0.cohesion=elastic-bond",
            "interfaces.0.bonds=Never",
        ],
    ),
    (
        "bonds (elastic-bond)",
        &["interfaces.0.cohesion=elastic-bond"],
    ),
    (
        "bonds with damage (mac)",
        &["interfaces.0.cohesion=mac", "interfaces.0.damage=mac"],
    ),
    ("position correction", &["solver.correction=0.1"]),
    (
        "implicit coupling, nothing to couple",
        &["coupling=Implicit(tolerance: 1e-3, max_iterations: 50)"],
    ),
];

/// Steps of a round, and rounds.
const STEPS: u32 = 10;
const ROUNDS: usize = 5;

/// A scene under test and the least times (s) of a step: whole, in the detection, the laws, the solver by sweep.
struct Trial<S: Space> {
    name: &'static str,
    simulation: Simulation<S>,
    least: [f64; 4],
}

fn main() {
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    println!(
        "| scene | feature | contacts | a contact: step | detection | laws | a sweep | row | memory of bonds and history |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let wants = |name: &str| wanted.as_ref().is_none_or(|w| name.contains(w.as_str()));
    if wants("disks") {
        run::<Plane>("disks", "disks_box_5000");
    }
    if wants("spheres") {
        run::<Solid>("spheres", "spheres_box_5000");
    }
}

fn run<S: Dimensional>(scene: &str, case: &str) {
    let mut trials: Vec<Trial<S>> = FEATURES.iter().map(|f| trial(case, f)).collect();
    for _ in 0..ROUNDS {
        trials.iter_mut().for_each(round);
    }
    for t in &trials {
        let s = &t.simulation;
        let n = s.network.contacts.len() as f64;
        let [step, detect, laws, sweep] = t.least.map(|x| 1e9 * x / n);
        let [plain, full, _] = Problem::<S>::BYTES_A_CONTACT;
        let bonds: usize = s.network.memory.iter().map(|m| m.bonds.len()).sum();
        let kept: usize = s
            .network
            .memory
            .iter()
            .map(|m| m.bonds.len() * (size_of::<Bond<S>>() + 8 * m.variables.len()))
            .sum();
        let held = s.network.memory.iter().flat_map(|m| &m.bonds);
        let row = if held.filter(|b| b.intact()).count() > 0 {
            full
        } else {
            plain
        };
        println!(
            "| {scene} | {} | {n:.0} | {step:.0} ns | {detect:.0} ns | {laws:.0} ns | {sweep:.1} ns | {row} B | {} B in {bonds} slots |",
            t.name, kept
        );
    }
}

fn trial<S: Dimensional>(case: &str, feature: &Feature) -> Trial<S> {
    let path = format!("{}/cases/benchmarks/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = feature.1.iter().map(|s| (*s).to_owned()).collect();
    let loaded = load(Path::new(&path), &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<S>(&SearchPath::new(&[]));
    let mut simulation = built.unwrap_or_else(|e| panic!("{e}")).simulation;
    // The load crosses the packing first; a frictionless one would flow for long.
    simulation.solver.max_iterations = 200;
    for _ in 0..10 {
        simulation
            .step()
            .unwrap_or_else(|e| panic!("{}: {e}", feature.0));
    }
    Trial {
        name: feature.0,
        simulation,
        least: [f64::INFINITY; 4],
    }
}

fn round<S: Space>(t: &mut Trial<S>) {
    let mut sums = [0.0; 4];
    let mut sweeps = 0;
    let clock = Instant::now();
    for _ in 0..STEPS {
        let report = t
            .simulation
            .step()
            .unwrap_or_else(|e| panic!("{}: {e}", t.name));
        sums[1] += report.timing.detect.as_secs_f64();
        sums[2] += report.timing.laws.as_secs_f64();
        sums[3] += report.timing.solve.as_secs_f64();
        sweeps += report.solver.iterations;
    }
    sums[0] = clock.elapsed().as_secs_f64();
    for (k, (least, sum)) in t.least.iter_mut().zip(sums).enumerate() {
        let count = if k == 3 { sweeps.max(1) } else { STEPS };
        *least = least.min(sum / f64::from(count));
    }
}
