//! Cost of heat and current.
//!
//! `cargo bench --bench heat` steps the main example in the middle of its fretting, and boxes of
//! disks of several sizes, without heat, with heat, and with heat and a current, and prints their
//! shares of a step, as in `docs/dev/heat.md`. The steps without heat are bit-identical to those of
//! a case without it. With `-- headline` it runs only the main example.
//!
//! Each variant steps in a separate process. The processes take turns of ten steps, so that other
//! load on the machine affects all of them equally: on a shared machine equal steps may take 30 %
//! longer a minute later. The layout of a process in memory changes its times too, so all processes
//! are launched several times. One thread is used, as the heat of a step is solved on one.

mod support;

use fretwork::geometry::space::Dim2;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::Instant;

/// Arguments of a process that steps one variant: this word, the case, the number of steps before
/// those that are timed, and `--set` options.
const ONE: &str = "--one";
/// Number of steps of a turn: a multiple of the largest interval between steps of heat.
const TURN: u32 = 10;

fn main() {
    support::refuse_unoptimised();
    let asked: Vec<String> = std::env::args().collect();
    if let Some(at) = asked.iter().position(|a| a == ONE) {
        return serve(&asked[at + 1..]);
    }
    println!(
        "| scene | grains | contacts | step without heat | sources only | every 10 steps | with heat | with current |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    headline();
    if asked.iter().any(|a| a == "headline") {
        return;
    }
    for (grains, first, launches) in [(1250, 100, 3), (5000, 150, 3), (20000, 350, 3)] {
        boxes(grains, first, launches);
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
        [1000, 40],
        [Vec::new(), sources, seldom, warm, current],
        &[],
        5,
    );
}

/// Times a random packing of another size between two plates, from a first step on at which it is
/// compressed.
fn boxes(grains: usize, first: u32, launches: usize) {
    // The lattice has 2.4e5 grains per square metre.
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
        [first, 8],
        [plain, sources, seldom, heat, current],
        &common,
        launches,
    );
}

/// Times steps of a scene without heat, with heat and with current, in turns of a few steps, each
/// from its own state after the first steps.
fn compare(
    scene: &str,
    case: &str,
    [first, turns]: [u32; 2],
    variants: [Vec<String>; 5],
    common: &[String],
    launches: usize,
) {
    let mut ratios: [Vec<f64>; 5] = Default::default();
    let mut plain = Vec::new();
    let mut method = String::new();
    for _ in 0..launches {
        let launch = |sets: &Vec<String>| Stepping::launch(case, first, common.iter().chain(sets));
        let mut processes: Vec<Stepping> = variants.iter().map(launch).collect();
        // All processes have made their first steps.
        for process in &mut processes {
            process.answer();
        }
        // Times measured one after another are compared, so that other load affects all variants;
        // each turn begins with another variant.
        let times: Vec<[f64; 5]> = (0..turns as usize)
            .map(|turn| {
                let mut times = [0.0; 5];
                for k in (0..5).map(|k| (k + turn) % 5) {
                    let (time, said) = processes[k].turn();
                    times[k] = time;
                    if k == 0 {
                        method = said;
                    }
                }
                times
            })
            .collect();
        plain.extend(times.iter().map(|t| 1e3 * t[0]));
        for (k, ratios) in ratios.iter_mut().enumerate() {
            ratios.push(median(times.iter().map(|t| t[k] / t[0])));
        }
    }
    let share = |k: usize| 100.0 * (median(ratios[k].iter().copied()) - 1.0);
    println!(
        "| {scene} | {method} | {:.2} ms | {:+.1} % | {:+.1} % | {:+.1} % | {:+.1} % |",
        median(plain.into_iter()),
        share(1),
        share(2),
        share(3),
        share(4)
    );
    let all = |k: usize| {
        let each = ratios[k]
            .iter()
            .map(|r| format!("{:+.1}", 100.0 * (r - 1.0)));
        each.collect::<Vec<_>>().join(" ")
    };
    eprintln!("launches with heat: {}", all(3));
}

/// A process that steps one variant on request.
struct Stepping {
    process: Child,
    answers: BufReader<ChildStdout>,
}

impl Stepping {
    fn launch<'a>(case: &str, first: u32, sets: impl Iterator<Item = &'a String>) -> Self {
        let program = std::env::current_exe().unwrap_or_else(|e| panic!("{e}"));
        let mut command = Command::new(program);
        command.args([ONE, case, &first.to_string()]).args(sets);
        let process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut process = process.unwrap_or_else(|e| panic!("{e}"));
        let Some(answers) = process.stdout.take() else {
            panic!("the output of a process is no pipe");
        };
        Self {
            process,
            answers: BufReader::new(answers),
        }
    }

    /// Reads the next line that the process prints.
    fn answer(&mut self) -> String {
        let mut line = String::new();
        let read = self.answers.read_line(&mut line);
        assert_ne!(
            read.unwrap_or_else(|e| panic!("{e}")),
            0,
            "a process has ended"
        );
        line.trim().to_owned()
    }

    /// Returns the time of a step (s) over a turn of steps, and what the process prints about its
    /// grains and contacts.
    fn turn(&mut self) -> (f64, String) {
        let Some(orders) = &mut self.process.stdin else {
            panic!("the input of a process is no pipe");
        };
        writeln!(orders).unwrap_or_else(|e| panic!("{e}"));
        let said = self.answer();
        let (time, scene) = said.split_once(' ').unwrap_or((&said, ""));
        let time = time.parse().unwrap_or_else(|e| panic!("{e}: {said}"));
        (time, scene.to_owned())
    }
}

impl Drop for Stepping {
    fn drop(&mut self) {
        // The process ends with its input.
        drop(self.process.stdin.take());
        let _ = self.process.wait();
    }
}

/// Steps one variant: prints a line when it has made the first steps, and then the time of a step
/// (s), its grains and its contacts after each turn that a line requests.
fn serve(asked: &[String]) {
    let [case, first, sets @ ..] = asked else {
        panic!("the case, and the steps before the time");
    };
    let first = first.parse::<u32>().unwrap_or_else(|e| panic!("{e}"));
    let file = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let loaded = load(Path::new(&file), sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Dim2>(&search_path());
    let mut s = built.unwrap_or_else(|e| panic!("{e}"));
    s.options.solver.parallel = false;
    let grains = s.state.bodies.grains().count();
    let mut make = |steps: u32| {
        let clock = Instant::now();
        for _ in 0..steps {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let each = clock.elapsed().as_secs_f64() / f64::from(steps);
        (each, s.state.network.contacts.len())
    };
    make(first);
    println!("ready");
    for _ in std::io::stdin().lines() {
        // Another process has used the caches meanwhile.
        make(1);
        let (each, contacts) = make(TURN);
        println!("{each:e} {grains} | {contacts}");
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_unstable_by(f64::total_cmp);
    all[all.len() / 2]
}
