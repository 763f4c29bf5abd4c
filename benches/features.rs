//! Cost of each feature that is on; a feature that is off costs nothing.
//!
//! `cargo bench --bench features` steps the boxes of 5,000 disks and spheres at rest with one
//! feature after another and prints the table of `docs/dev/features.md`. Variants alternate, and
//! the minimum of several rounds is used, to reduce the influence of other load on the machine.
//! `pieces` times the narrow phase of polyhedra, by pairs.

mod support;

#[path = "../tests/support/features.rs"]
mod features;

use features::{FEATURES, Feature};
use fretwork::contact::Bond;
use fretwork::geometry::convex::polyhedron::Polyhedron;
use fretwork::geometry::convex::{ContactTolerances, Core, CorePair};
use fretwork::geometry::periodic::Periodic;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::scene::load;
use fretwork::scene::sample::deposit::Corners;
use fretwork::scene::sample::voronoi_space::tiling;
use fretwork::shipped::search_path;
use fretwork::solve::Problem;
use fretwork::step::Simulation;
use nalgebra::{UnitQuaternion, Vector3};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// A feature besides the shared ones, with nothing to couple.
const UNCOUPLED: Feature = (
    "implicit coupling, nothing to couple",
    &["coupling=Implicit(tolerance: 1e-3, max_iterations: 50)"],
);

/// Steps of a round, and rounds.
const STEPS: u32 = 10;
const ROUNDS: usize = 5;

/// A scene under test and the minimum times (s) of a step: total, detection, laws, solver per
/// sweep.
struct Trial<S: Space> {
    name: &'static str,
    simulation: Simulation<S>,
    least: [f64; 4],
}

fn main() {
    support::refuse_unoptimised();
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    if wanted.as_deref() == Some("pieces") {
        pieces();
        return;
    }
    println!(
        "| scene | feature | contacts | step, per contact | detection | laws | a sweep | row | memory of bonds and history |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let wants = |name: &str| wanted.as_ref().is_none_or(|w| name.contains(w.as_str()));
    if wants("disks") {
        run::<Dim2>("disks", "disks_box_5000");
    }
    if wants("spheres") {
        run::<Dim3>("spheres", "spheres_box_5000");
    }
}

fn run<S: Space>(scene: &str, case: &str) {
    let all = FEATURES.iter().chain([&UNCOUPLED]);
    let mut trials: Vec<Trial<S>> = all.map(|f| trial(case, f)).collect();
    for _ in 0..ROUNDS {
        trials.iter_mut().for_each(round);
    }
    for t in &trials {
        let s = &t.simulation;
        let n = s.state.network.contacts.len() as f64;
        let [step, detect, laws, sweep] = t.least.map(|x| 1e9 * x / n);
        let [plain, full, ..] = Problem::<S>::BYTES_A_CONTACT;
        let bonds: usize = s.state.network.memory.iter().map(|m| m.bonds.len()).sum();
        let kept: usize = s
            .state
            .network
            .memory
            .iter()
            .map(|m| m.bonds.len() * (size_of::<Bond<S>>() + 8 * m.variables.len()))
            .sum();
        let held = s.state.network.memory.iter().flat_map(|m| &m.bonds);
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

fn trial<S: Space>(case: &str, feature: &Feature) -> Trial<S> {
    let path = format!("{}/cases/benchmarks/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = feature.1.iter().map(|s| (*s).to_owned()).collect();
    let loaded = load(Path::new(&path), &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<S>(&search_path());
    let mut simulation = built.unwrap_or_else(|e| panic!("{e}"));
    // The load crosses the packing first; a frictionless packing would flow for long.
    simulation.options.solver.max_iterations = 200;
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

/// Two polyhedra, and the position of the centre of the first relative to that of the second (m).
type Pair = (Polyhedron, Polyhedron, Vector3<f64>);

/// Returns the time of the narrow phase per pair: in contact as faces, as edges, and within the
/// neighbour list only.
fn pieces() {
    const REACH: f64 = 1e-3;
    let cube = Polyhedron::cuboid([1.0; 3]);
    let turned = cube.turned(&UnitQuaternion::from_scaled_axis(Vector3::new(
        0.0, 0.0, 0.3,
    )));
    let on_top: Pair = (turned, cube.clone(), Vector3::new(0.1, 0.2, 1.0));
    // An edge along x is placed over one along y.
    let [x, y] = [Vector3::x(), Vector3::y()].map(|axis| {
        cube.turned(&UnitQuaternion::from_scaled_axis(
            axis * std::f64::consts::FRAC_PI_4,
        ))
    });
    let crossed: Pair = (x, y, Vector3::new(0.1, 0.05, 2f64.sqrt() - 1e-6));
    let (low, high) = (Vector3::zeros(), Vector3::repeat(6.0));
    let sample = tiling(&Corners { low, high }, &Periodic::default(), 1.0, 3, 1);
    let cells = sample.unwrap_or_else(|e| panic!("{e:?}")).cells;
    let parts: Vec<_> = cells
        .iter()
        .map(|c| Polyhedron::from_faces(c.points.clone(), c.faces.clone()))
        .map(|p| p.unwrap_or_else(|e| panic!("{e}")).part(0.0))
        .collect();
    let (mut neighbours, mut apart): (Vec<Pair>, Vec<Pair>) = Default::default();
    for (i, a) in parts.iter().enumerate() {
        for (j, b) in parts[..i].iter().enumerate() {
            let way = a.centre - b.centre;
            let pair = (a.core.clone(), b.core.clone(), way);
            if cells[i].beyond.contains(&Some(j as u32)) {
                neighbours.push(pair);
            } else if way.norm() < a.bound + b.bound + REACH {
                apart.push(pair);
            }
        }
    }
    println!("| polyhedra | pairs | points per pair | time per pair |");
    println!("|---|---|---|---|");
    for (name, pairs) in [
        ("cubes face to face", vec![on_top]),
        ("cubes edge to edge", vec![crossed]),
        ("Voronoi neighbours", neighbours),
        (
            "Voronoi cells near each other, without a common face",
            apart,
        ),
    ] {
        let tolerances = ContactTolerances {
            reach: REACH,
            slack: 0.01 * REACH,
            held: false,
        };
        let (mut least, mut points) = (f64::INFINITY, 0);
        let repeats = 20_000 / pairs.len() + 1;
        let mut out = Vec::new();
        for _ in 0..ROUNDS {
            points = 0;
            let clock = Instant::now();
            for _ in 0..repeats {
                for (a, b, way) in &pairs {
                    out.clear();
                    let pair = CorePair {
                        cores: [a, b],
                        apart: *black_box(way),
                        roundings: [0.0; 2],
                        tolerances,
                    };
                    Polyhedron::contact_points(&pair, &mut out);
                    points += out.len();
                }
            }
            least = least.min(clock.elapsed().as_secs_f64());
        }
        let met = (repeats * pairs.len()) as f64;
        println!(
            "| {name} | {} | {:.1} | {:.0} ns |",
            pairs.len(),
            points as f64 / met,
            1e9 * least / met
        );
    }
}
