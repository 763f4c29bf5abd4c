//! Time of steps of three scenes, and of the sweep per contact and iteration, compared with LMGC90.
//!
//! `cargo bench --bench peer_scenes` prints, for each scene, the cold first step, solved until it
//! converges; then, after `SETTLE` further steps (the first step of LMGC90 is not converged, so its
//! packing is not at rest by the error measure used here), the mean of `STEPS` warm steps, their time by part,
//! and the ratios to the times of LMGC90 in `cases/benchmarks/README.md`. One thread.

use fretwork::laws::SearchPath;
use fretwork::scene::{Scene, load};
use fretwork::step::{Simulation, Steps};
use std::path::Path;
use std::time::{Duration, Instant};

/// Case, LMGC90's warm step (ms), LMGC90's best sweep (ns per contact and iteration).
const SCENES: [(&str, f64, f64); 3] = [
    ("disks_box_5000", 132.0, 43.0),
    ("spheres_box_5000", 364.0, 155.0),
    ("cohesive_disks_3000", 138.0, 71.0),
];

/// Steps between the cold step and the timed ones.
const SETTLE: u32 = 30;

fn main() {
    let steps: u32 = std::env::var("STEPS")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(20);
    println!(
        "{:<22} {:>9} {:>9} {:>10} {:>6} {:>9} {:>8} {:>8} {:>8} {:>9} {:>7} {:>7}",
        "scene",
        "contacts",
        "cold ms",
        "cold iter",
        "iter",
        "step ms",
        "detect",
        "laws",
        "solve",
        "ns/c/it",
        "x peer",
        "x sweep"
    );
    // Words of the command line select the scenes whose names contain them.
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    for (name, peer_ms, peer_ns) in SCENES {
        if wanted.as_ref().is_some_and(|w| !name.contains(w.as_str())) {
            continue;
        }
        let file = format!("{}/cases/benchmarks/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let loaded = load(
            Path::new(&file),
            &["solver.max_iterations=200000".to_owned()],
        )
        .unwrap_or_else(|e| panic!("{e}"));
        let scene = loaded
            .build(&SearchPath::new(&[]))
            .unwrap_or_else(|e| panic!("{e}"));
        match scene {
            Scene::Dim2(b) => bench(name, b.simulation, steps, peer_ms, peer_ns),
            Scene::Dim3(b) => bench(name, b.simulation, steps, peer_ms, peer_ns),
        }
    }
}

fn bench<S: Steps>(name: &str, mut s: Simulation<S>, steps: u32, peer_ms: f64, peer_ns: f64) {
    let ms = |d: Duration| d.as_secs_f64() * 1e3;
    let clock = Instant::now();
    let cold = s.step().unwrap_or_else(|e| panic!("{e}"));
    let cold_ms = ms(clock.elapsed());
    for _ in 0..SETTLE {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let (mut total, mut detect, mut laws, mut solve) = (0.0, 0.0, 0.0, 0.0);
    let (mut iterations, mut sweeps_ns, mut unconverged) = (0u64, 0.0, 0);
    for _ in 0..steps {
        let clock = Instant::now();
        let r = s.step().unwrap_or_else(|e| panic!("{e}"));
        total += ms(clock.elapsed());
        detect += ms(r.timing.detect);
        laws += ms(r.timing.laws);
        solve += ms(r.timing.solve);
        iterations += u64::from(r.solver.iterations);
        unconverged += u32::from(!r.solver.converged);
        sweeps_ns += r.timing.solve.as_secs_f64() * 1e9 / s.state.network.contacts.len() as f64;
    }
    let n = f64::from(steps);
    let per = sweeps_ns / iterations as f64;
    println!(
        "{name:<22} {:>9} {cold_ms:>9.1} {:>10} {:>6.1} {:>9.2} {:>8.2} {:>8.2} {:>8.2} {per:>9.1} {:>7.1} {:>7.1}{}",
        s.state.network.contacts.len(),
        cold.solver.iterations,
        iterations as f64 / n,
        total / n,
        detect / n,
        laws / n,
        solve / n,
        peer_ms / (total / n),
        peer_ns / per,
        if unconverged > 0 {
            format!("  ({unconverged} steps unconverged)")
        } else {
            String::new()
        }
    );
}
