//! Time of steps of four scenes, and of the sweep per contact and iteration, beside LMGC90's.
//!
//! `cargo bench --bench peer_scenes` prints, for each scene, the cold first step, solved until it
//! converges; then the means of two windows of steps: while the scene moves (steps 2 to 61), and
//! later, at rest or in flow. One thread; processor time; the parts of a step are measured as
//! shares of wall-clock time.
//!
//! Where LMGC90 is installed (`cases/benchmarks/README.md`), it runs the same scenes in turn, and
//! ratios are those of medians over the rounds; elsewhere there are none, since times of another
//! machine would mix codes and machines. `LMGC90_PYTHON` names the Python that has `pylmgc90`,
//! `python3` by default; `ROUNDS` sets the number of rounds, 3 beside LMGC90 and else 1; `STEPS`
//! the number of steps of the later window. A word selects the scenes whose names contain it.

mod support;

use cpu_time::ProcessTime;
use fretwork::geometry::space::Space;
use fretwork::in_dimension;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Steps from `first` to `last`, where the cold step is 1.
#[derive(Clone, Copy)]
struct Window {
    name: &'static str,
    first: u32,
    last: u32,
}

const fn window(name: &'static str, first: u32, last: u32) -> Window {
    Window { name, first, last }
}

/// Cases, the scene files of LMGC90, and the windows after the cold step.
const SCENES: [(&str, &str, [Window; 2]); 4] = [
    (
        "disks_box_5000",
        "scene2d_box_5000",
        [window("moving", 2, 61), window("rest", 202, 261)],
    ),
    (
        "spheres_box_5000",
        "scene3d_box_5000",
        [window("moving", 2, 61), window("rest", 202, 261)],
    ),
    (
        "cohesive_disks_3000",
        "sceneczm_3000",
        [window("moving", 2, 61), window("shear", 102, 161)],
    ),
    (
        "sheared_disks_3000",
        "scene_sheared_3000",
        [window("moving", 2, 61), window("flow", 102, 161)],
    ),
];

/// Means per step of a window.
#[derive(Clone, Copy, Default)]
struct Means {
    contacts: f64,
    iterations: f64,
    /// Processor time of a step (ms).
    step: f64,
    /// Of it in detection, laws and the solver (ms).
    parts: [f64; 3],
    /// Time of a sweep per contact and iteration (ns).
    sweep: f64,
    unconverged: u32,
}

fn main() {
    support::refuse_unoptimised();
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u32>().ok());
    let steps = number("STEPS");
    let peer = Peer::find();
    let rounds = number("ROUNDS").unwrap_or(if peer.is_some() { 3 } else { 1 });
    match &peer {
        Some(_) => println!("LMGC90 in turn, medians of {rounds} rounds"),
        None => println!("LMGC90 is not installed (LMGC90_PYTHON): no ratios"),
    }
    print!(
        "{:<20} {:<7} {:>8} {:>7} {:>8} {:>7} {:>7} {:>7} {:>8}",
        "scene", "steps", "contacts", "iter", "step-ms", "detect", "laws", "solve", "ns/c/it"
    );
    match &peer {
        Some(_) => println!(
            " {:>8} {:>8} {:>8} {:>7} {:>13} {:>7}",
            "peer-ms", "peer-it", "peer-ns", "x-step", "of rounds", "x-sweep"
        ),
        None => println!(),
    }
    // Words of the command line select the scenes whose names contain them.
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    for (name, file, mut windows) in SCENES {
        if wanted.as_ref().is_some_and(|w| !name.contains(w.as_str())) {
            continue;
        }
        if let (Some(n), Some(later)) = (steps, windows.last_mut()) {
            later.last = later.first + n - 1;
        }
        let [moving, later] = windows;
        let windows = [window("cold", 1, 1), moving, later];
        let (mut own, mut others) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            own.push(ours(name, &windows));
            others.extend(peer.as_ref().map(|p| p.run(file, &windows)));
        }
        for (k, window) in windows.iter().enumerate() {
            let own: Vec<Means> = own.iter().map(|round| round[k]).collect();
            let others: Vec<Means> = others.iter().map(|round| round[k]).collect();
            print_line(name, window, &own, &others);
        }
    }
}

/// Runs a scene, and returns the means of its windows.
fn ours(name: &str, windows: &[Window]) -> Vec<Means> {
    let file = format!("{}/cases/benchmarks/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets = ["solver.max_iterations=200000".to_owned()];
    let loaded = load(Path::new(&file), &sets).unwrap_or_else(|e| panic!("{e}"));
    let scene = loaded.build(&search_path());
    let scene = scene.unwrap_or_else(|e| panic!("{e}"));
    in_dimension!(scene.simulation, |s| of_windows(*s, windows))
}

fn of_windows<S: Space>(mut s: Simulation<S>, windows: &[Window]) -> Vec<Means> {
    let mut number = 0;
    let mut of_window = |window: &Window| {
        while number + 1 < window.first {
            s.step().unwrap_or_else(|e| panic!("{e}"));
            number += 1;
        }
        number = window.last;
        time(&mut s, window)
    };
    windows.iter().map(&mut of_window).collect()
}

/// Makes the steps of a window.
fn time<S: Space>(s: &mut Simulation<S>, window: &Window) -> Means {
    let mut parts = [Duration::ZERO; 3];
    let (mut iterations, mut swept, mut contacts, mut unconverged) = (0u64, 0.0, 0, 0);
    let (clock, wall) = (ProcessTime::now(), Instant::now());
    for _ in window.first..=window.last {
        let r = s.step().unwrap_or_else(|e| panic!("{e}"));
        let of_step = [r.timing.detect, r.timing.laws, r.timing.solve];
        parts.iter_mut().zip(of_step).for_each(|(p, d)| *p += d);
        let n = s.state.network.contacts.len();
        contacts += n;
        iterations += u64::from(r.solver.iterations);
        swept += n as f64 * f64::from(r.solver.iterations);
        unconverged += u32::from(!r.solver.converged);
    }
    let n = f64::from(window.last - window.first + 1);
    let step = 1e3 * clock.elapsed().as_secs_f64() / n;
    let wall = wall.elapsed().as_secs_f64();
    let parts = parts.map(|d| step * d.as_secs_f64() / wall);
    Means {
        contacts: contacts as f64 / n,
        iterations: iterations as f64 / n,
        step,
        parts,
        sweep: 1e6 * n * parts[2] / swept,
        unconverged,
    }
}

/// LMGC90, by the Python that has it.
struct Peer {
    python: OsString,
}

impl Peer {
    fn find() -> Option<Self> {
        let python = std::env::var_os("LMGC90_PYTHON").unwrap_or_else(|| "python3".into());
        let mut probe = Command::new(&python);
        probe.args(["-c", "import pylmgc90"]).stderr(Stdio::null());
        let there = probe.status().is_ok_and(|s| s.success());
        there.then_some(Self { python })
    }

    /// Runs a scene file; the first window is the cold step.
    fn run(&self, scene: &str, windows: &[Window]) -> Vec<Means> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmarks");
        let last = windows.iter().map(|w| w.last).max().unwrap_or(1);
        let mut command = Command::new(&self.python);
        command.arg(folder.join("lmgc90/run.py"));
        command.arg(folder.join(format!("{scene}.txt")));
        command.args(["--json", "--steps", &last.to_string(), "--windows"]);
        command.args(
            windows[1..]
                .iter()
                .map(|w| format!("{}-{}", w.first, w.last)),
        );
        let output = command.stderr(Stdio::inherit()).output();
        let output = output.unwrap_or_else(|e| panic!("LMGC90: {e}"));
        assert!(
            output.status.success(),
            "LMGC90 ended with {}",
            output.status
        );
        let text = String::from_utf8_lossy(&output.stdout);
        let rows = text.lines().filter(|line| line.starts_with('{'));
        let rows = rows.map(|line| {
            let row: serde_json::Value =
                serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}"));
            let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
            Means {
                contacts: number("contacts"),
                iterations: number("iterations"),
                step: number("cpu_ms"),
                sweep: number("sweep_ns"),
                ..Means::default()
            }
        });
        let rows: Vec<Means> = rows.collect();
        assert_eq!(rows.len(), windows.len(), "{text}");
        rows
    }
}

fn median(rounds: &[Means], of: impl Fn(&Means) -> f64) -> f64 {
    let mut values: Vec<f64> = rounds.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() % 2 {
        0 => 0.5 * (values[middle - 1] + values[middle]),
        _ => values[middle],
    }
}

/// Prints the line of a window.
fn print_line(name: &str, window: &Window, own: &[Means], others: &[Means]) {
    let step = median(own, |m| m.step);
    let sweep = median(own, |m| m.sweep);
    let [detect, laws, solve] = [0, 1, 2].map(|k| median(own, |m| m.parts[k]));
    print!(
        "{name:<20} {:<7} {:>8.0} {:>7.1} {step:>8.2} {detect:>7.2} {laws:>7.2} {solve:>7.2} {sweep:>8.1}",
        window.name,
        median(own, |m| m.contacts),
        median(own, |m| m.iterations),
    );
    if !others.is_empty() {
        let peer = median(others, |m| m.step);
        let peer_sweep = median(others, |m| m.sweep);
        let rounds = own.iter().zip(others).map(|(a, b)| b.step / a.step);
        let (least, most) = rounds.fold((f64::INFINITY, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
        print!(
            " {peer:>8.1} {:>8.0} {peer_sweep:>8.1} {:>7.1} {:>13} {:>7.1}",
            median(others, |m| m.iterations),
            peer / step,
            format!("{least:.1} to {most:.1}"),
            peer_sweep / sweep
        );
    }
    let unconverged: u32 = own.iter().map(|m| m.unconverged).sum();
    match unconverged {
        0 => println!(),
        n => println!("  ({n} steps unconverged)"),
    }
}
