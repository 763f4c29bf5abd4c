//! Cost of heat and current.
//!
//! `cargo bench --bench heat` steps the headline case in the middle of its fretting, and boxes of disks of several sizes, without heat, with
//! heat, and with heat and a current, in turns in one run, and prints the shares of a step that these take, as in `docs/heat.md`. The steps without
//! heat have the bits of a case that has never heard of it.

use fretwork::geometry::space::Dim2;
use fretwork::laws::SearchPath;
use fretwork::scene::load;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::Instant;

/// Steps of a turn, and turns of the headline case and of the packings.
const STEPS: u32 = 10;
const TURNS: [usize; 2] = [31, 9];

fn main() {
    println!(
        "| scene | grains | contacts | step without heat | sources only | every 10 steps | with heat | with current |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    headline();
    if std::env::args().any(|a| a == "headline") {
        return;
    }
    for grains in [1250, 5000, 20000] {
        boxes(grains);
    }
}

/// The third body of `cases/wheel_rail_fretting.ron`, after its compaction.
fn headline() {
    let slots = |k: usize| format!("interfaces.{k}.transport=\"batchelor-obrien\"");
    let parameters = |k: usize| format!("interfaces.{k}.parameters.transport={{}}");
    let mut warm: Vec<String> = (0..3).flat_map(|k| [slots(k), parameters(k)]).collect();
    warm.push(
        "heat=(bodies: {\"rail\": (store: HalfSpace(x: 40)), \"wheel\": (store: HalfSpace(x: 40))})"
            .to_owned(),
    );
    let sources = warm[6..].to_vec();
    let mut seldom = warm.clone();
    seldom.push("heat.every=10".to_owned());
    let mut current = warm.clone();
    current.push(
        "heat.circuit=(from: \"wheel\", to: \"rail\", supply: Current(current: 1.0, limit: 1.0))"
            .to_owned(),
    );
    compare(
        "third body",
        "wheel_rail_fretting",
        1000,
        [Vec::new(), sources, seldom, warm, current],
        &[],
        TURNS[0],
    );
}

/// A random packing between two plates, of another size.
fn boxes(grains: usize) {
    // The lattice takes 2.4e5 grains a square metre.
    let side = (grains as f64 / 2.3e5).sqrt();
    let common = [
        format!("grains.0.count={grains}"),
        format!("grains.0.high=[{side}, {side}]"),
        format!("periodic.x={side}"),
        format!("bodies.1.position=[0.0, {side}]"),
        format!("bodies.1.dofs.y=Force(Constant({}))", -1e6 * side),
        format!("bodies.1.mass={}", 1e3 * side),
        // The packing is far from rest: the work of the solver is bounded.
        "solver.tolerance=1e-3".to_owned(),
        "solver.max_iterations=50".to_owned(),
    ];
    let plain = vec!["heat=None".to_owned()];
    let heat = vec!["heat.circuit=None".to_owned()];
    let seldom = vec!["heat.circuit=None".to_owned(), "heat.every=10".to_owned()];
    let sources = vec![
        "heat.circuit=None".to_owned(),
        "interfaces.0.transport=None".to_owned(),
        "interfaces.0.parameters.transport={}".to_owned(),
    ];
    let current = Vec::new();
    compare(
        "packing",
        "verification/thermal/network",
        50,
        [plain, sources, seldom, heat, current],
        &common,
        TURNS[1],
    );
}

/// Times steps of a scene without heat, with heat and with current, in turns, each from its own state after the first steps.
fn compare(
    scene: &str,
    case: &str,
    first: u32,
    variants: [Vec<String>; 5],
    common: &[String],
    turns: usize,
) {
    let mut simulations: Vec<Simulation<Dim2>> = variants
        .iter()
        .map(|sets| {
            let file = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
            let sets: Vec<String> = common.iter().chain(sets).cloned().collect();
            let loaded = load(Path::new(&file), &sets).unwrap_or_else(|e| panic!("{e}"));
            let built = loaded.build_in::<Dim2>(&SearchPath::new(&[]));
            let mut s = built.unwrap_or_else(|e| panic!("{e}")).simulation;
            for _ in 0..first {
                s.step().unwrap_or_else(|e| panic!("{e}"));
            }
            s
        })
        .collect();
    let turns: Vec<Vec<f64>> = (0..turns)
        .map(|_| simulations.iter_mut().map(time).collect())
        .collect();
    // Of times that lie beside each other, so that what else the machine does changes both.
    let share = |k: usize| 100.0 * (median(turns.iter().map(|t| t[k] / t[0])) - 1.0);
    let plain = 1e3 * median(turns.iter().map(|t| t[0])) / f64::from(STEPS);
    let s = &simulations[0];
    println!(
        "| {scene} | {} | {} | {:.2} ms | {:+.1} % | {:+.1} % | {:+.1} % | {:+.1} % |",
        s.state.bodies.grains().count(),
        s.state.network.contacts.len(),
        plain,
        share(1),
        share(2),
        share(3),
        share(4)
    );
}

/// Time of some steps (s).
fn time(s: &mut Simulation<Dim2>) -> f64 {
    let clock = Instant::now();
    for _ in 0..STEPS {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    clock.elapsed().as_secs_f64()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_unstable_by(f64::total_cmp);
    all[all.len() / 2]
}
