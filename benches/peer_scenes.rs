//! Time of steps of four scenes, and of the sweep per contact and iteration, compared with LMGC90.
//!
//! `cargo bench --bench peer_scenes` prints, for each scene, the cold first step, solved until it
//! converges; then the means of two windows of steps: while the scene moves (steps 2 to 61), and
//! later, at rest or in flow; with the ratios to the times of LMGC90 in the same steps of the same
//! scene (`cases/benchmarks/README.md`). One thread; processor time, as for LMGC90; the parts of a
//! step are measured as shares of wall-clock time. A word selects the scenes whose names contain
//! it; `STEPS` sets the number of steps of the later window.

use cpu_time::ProcessTime;
use fretwork::geometry::space::Space;
use fretwork::in_dimension;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::{Duration, Instant};

/// Steps from `first` to `last`, where the cold step is 1. LMGC90's processor time (ms) and
/// iterations per step in them, and its time of a sweep (ns per contact and iteration), are the
/// best of three repetitions.
struct Window {
    name: &'static str,
    first: u32,
    last: u32,
    peer_ms: f64,
    peer_iterations: f64,
    peer_ns: f64,
}

const fn window(name: &'static str, first: u32, last: u32, peer: (f64, f64, f64)) -> Window {
    Window {
        name,
        first,
        last,
        peer_ms: peer.0,
        peer_iterations: peer.1,
        peer_ns: peer.2,
    }
}

/// Cases and their windows.
const SCENES: [(&str, [Window; 3]); 4] = [
    (
        "disks_box_5000",
        [
            window("cold", 1, 1, (5369.5, 6330.0, 42.4)),
            window("moving", 2, 61, (132.7, 85.7, 43.6)),
            window("rest", 202, 261, (70.4, 10.0, 51.2)),
        ],
    ),
    (
        "spheres_box_5000",
        [
            window("cold", 1, 1, (10252.2, 2490.0, 208.3)),
            window("moving", 2, 61, (437.9, 75.5, 215.4)),
            window("rest", 202, 261, (176.3, 17.5, 181.6)),
        ],
    ),
    (
        "cohesive_disks_3000",
        [
            window("cold", 1, 1, (370.2, 480.0, 79.8)),
            window("moving", 2, 61, (143.1, 157.8, 83.3)),
            window("shear", 102, 161, (89.3, 92.2, 80.3)),
        ],
    ),
    (
        "sheared_disks_3000",
        [
            window("cold", 1, 1, (900.5, 2550.0, 37.1)),
            window("moving", 2, 61, (496.1, 1332.2, 38.3)),
            window("flow", 102, 161, (525.5, 1395.8, 39.6)),
        ],
    ),
];

fn main() {
    let steps: Option<u32> = std::env::var("STEPS").ok().and_then(|s| s.parse().ok());
    println!(
        "{:<20} {:<7} {:>8} {:>7} {:>8} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>7} {:>7}",
        "scene",
        "steps",
        "contacts",
        "iter",
        "step-ms",
        "detect",
        "laws",
        "solve",
        "ns/c/it",
        "peer-ms",
        "peer-it",
        "x-step",
        "x-sweep"
    );
    // Words of the command line select the scenes whose names contain them.
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    for (name, mut windows) in SCENES {
        if wanted.as_ref().is_some_and(|w| !name.contains(w.as_str())) {
            continue;
        }
        if let (Some(n), Some(later)) = (steps, windows.last_mut()) {
            later.last = later.first + n - 1;
        }
        let file = format!("{}/cases/benchmarks/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let loaded = load(
            Path::new(&file),
            &["solver.max_iterations=200000".to_owned()],
        )
        .unwrap_or_else(|e| panic!("{e}"));
        let scene = loaded
            .build(&search_path())
            .unwrap_or_else(|e| panic!("{e}"));
        in_dimension!(scene.simulation, |s| bench(name, *s, &windows));
    }
}

fn bench<S: Space>(name: &str, mut s: Simulation<S>, windows: &[Window]) {
    let mut number = 0;
    for window in windows {
        while number + 1 < window.first {
            s.step().unwrap_or_else(|e| panic!("{e}"));
            number += 1;
        }
        time(name, &mut s, window);
        number = window.last;
    }
}

/// Performs the steps of a window and prints its line.
fn time<S: Space>(name: &str, s: &mut Simulation<S>, window: &Window) {
    let [mut detect, mut laws, mut solve] = [Duration::ZERO; 3];
    let (mut iterations, mut swept, mut contacts, mut unconverged) = (0u64, 0.0, 0, 0);
    let (clock, wall) = (ProcessTime::now(), Instant::now());
    for _ in window.first..=window.last {
        let r = s.step().unwrap_or_else(|e| panic!("{e}"));
        detect += r.timing.detect;
        laws += r.timing.laws;
        solve += r.timing.solve;
        let n = s.state.network.contacts.len();
        contacts += n;
        iterations += u64::from(r.solver.iterations);
        swept += n as f64 * f64::from(r.solver.iterations);
        unconverged += u32::from(!r.solver.converged);
    }
    let n = f64::from(window.last - window.first + 1);
    let step = 1e3 * clock.elapsed().as_secs_f64() / n;
    let wall = wall.elapsed().as_secs_f64();
    let part = |d: Duration| step * d.as_secs_f64() / wall;
    let per = 1e6 * n * part(solve) / swept;
    println!(
        "{name:<20} {:<7} {:>8.0} {:>7.1} {step:>8.2} {:>7.2} {:>7.2} {:>7.2} {per:>8.1} {:>8.0} {:>8.0} {:>7.1} {:>7.1}{}",
        window.name,
        contacts as f64 / n,
        iterations as f64 / n,
        part(detect),
        part(laws),
        part(solve),
        window.peer_ms,
        window.peer_iterations,
        window.peer_ms / step,
        window.peer_ns / per,
        if unconverged > 0 {
            format!("  ({unconverged} steps unconverged)")
        } else {
            String::new()
        }
    );
}
