//! Cost of heat and current.
//!
//! `cargo bench --bench heat` steps the headline case in the middle of its fretting, and boxes of disks of several sizes, without heat, with
//! heat, and with heat and a current, and prints the shares of a step that these take, as in `docs/heat.md`. The steps without
//! heat have the bits of a case that has never heard of it. With `-- headline` it does the first alone.
//!
//! Each variant steps in processes of its own, which take turns: in one process two simulations of the same case differ by up to 9 %, by
//! where their memory lies. On one thread, as the heat of a step is solved.

use fretwork::geometry::space::Dim2;
use fretwork::laws::SearchPath;
use fretwork::scene::load;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// What a process that times one variant is asked for: this word, the case, steps before and in the time, and `--set`s.
const ONE: &str = "--one";

fn main() {
    let asked: Vec<String> = std::env::args().collect();
    if let Some(at) = asked.iter().position(|a| a == ONE) {
        println!("{}", time(&asked[at + 1..]));
        return;
    }
    println!(
        "| scene | grains | contacts | step without heat | sources only | every 10 steps | with heat | with current |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    headline();
    if asked.iter().any(|a| a == "headline") {
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
        [1000, 300],
        [Vec::new(), sources, seldom, warm, current],
        &[],
        7,
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
        // A larger box takes longer to come together.
        [(grains as f64).sqrt() as u32 * 3 / 2, 60],
        [plain, sources, seldom, heat, current],
        &common,
        3,
    );
}

/// Times steps of a scene without heat, with heat and with current, in turns, each from its own state after the first steps.
fn compare(
    scene: &str,
    case: &str,
    steps: [u32; 2],
    variants: [Vec<String>; 5],
    common: &[String],
    turns: usize,
) {
    let program = std::env::current_exe().unwrap_or_else(|e| panic!("{e}"));
    let one = |sets: &Vec<String>| {
        let mut command = Command::new(&program);
        command.arg(ONE).arg(case);
        command.args(steps.map(|n| n.to_string()));
        command
            .args(common.iter().chain(sets))
            .stderr(Stdio::inherit());
        let output = command.output().unwrap_or_else(|e| panic!("{e}"));
        assert!(output.status.success(), "{command:?}");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let numbers = said.split_whitespace().map(str::parse);
        let numbers: Result<Vec<f64>, _> = numbers.collect();
        numbers.unwrap_or_else(|e| panic!("{e}: {said}"))
    };
    let turns: Vec<Vec<Vec<f64>>> = (0..turns)
        .map(|_| variants.iter().map(one).collect())
        .collect();
    // Of times that lie beside each other, so that what else the machine does changes both.
    let share = |k: usize| 100.0 * (median(turns.iter().map(|t| t[k][0] / t[0][0])) - 1.0);
    let plain = 1e3 * median(turns.iter().map(|t| t[0][0]));
    let of_scene = &turns[0][0];
    println!(
        "| {scene} | {} | {} | {:.2} ms | {:+.1} % | {:+.1} % | {:+.1} % | {:+.1} % |",
        of_scene[1],
        of_scene[2],
        plain,
        share(1),
        share(2),
        share(3),
        share(4)
    );
}

/// Steps one variant; gives the time of a step (s), grains and contacts.
fn time(asked: &[String]) -> String {
    let [case, first, steps, sets @ ..] = asked else {
        panic!("the case, the steps before and in the time");
    };
    let [first, steps] = [first, steps].map(|n| n.parse::<u32>().unwrap_or_else(|e| panic!("{e}")));
    let file = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let loaded = load(Path::new(&file), sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Dim2>(&SearchPath::new(&[]));
    let mut s = built.unwrap_or_else(|e| panic!("{e}")).simulation;
    s.options.solver.parallel = false;
    let mut make = |steps: u32| {
        let clock = Instant::now();
        for _ in 0..steps {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        clock.elapsed().as_secs_f64() / f64::from(steps)
    };
    make(first);
    let each = make(steps);
    let grains = s.state.bodies.grains().count();
    format!("{each:e} {grains} {}", s.state.network.contacts.len())
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_unstable_by(f64::total_cmp);
    all[all.len() / 2]
}
