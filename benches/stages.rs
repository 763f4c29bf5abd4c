//! Time of a step and its parts, in stages of some cases.
//!
//! `cargo bench --bench stages` steps each case from its start and times its stages: the time of a
//! step and of its parts (detection, laws, solver, the rest), the sweeps, and the solver's time per
//! contact and sweep. A word selects the stages whose names contain it, `--threads` the numbers of
//! threads (1 unless given):
//!
//! ```text
//! cargo bench --bench stages -- fretting --threads 1 2
//! ```
//!
//! Times are wall-clock times but for `cpu ms`, processor time of all threads, which other work on
//! the machine affects less. `sweeps` shows whether two revisions do the same.
//! `benches/before_after.sh` compares two revisions by this bench.

mod support;

use cpu_time::ProcessTime;
use fretwork::geometry::space::Space;
use fretwork::in_dimension;
use fretwork::scene::{Case, load, processes};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::{Duration, Instant};

/// A stretch of steps of a case.
struct Stage {
    name: &'static str,
    /// Number of steps before it, from the end of the previous stage.
    skipped: u32,
    steps: u32,
}

const fn stage(name: &'static str, skipped: u32, steps: u32) -> Stage {
    Stage {
        name,
        skipped,
        steps,
    }
}

/// Cases, with the file's path below `cases`, and their stages in the order of time.
const CASES: [(&str, &[Stage]); 7] = [
    (
        "wheel_rail_fretting",
        // The grains are bonded at step 960, the wheel moves from step 1,000 on.
        &[
            stage("fretting_compaction", 0, 400),
            stage("fretting_sliding", 700, 400),
        ],
    ),
    (
        "benchmarks/disks_box_5000",
        // The first step is solved from nothing.
        &[stage("disks_moving", 1, 60), stage("disks_rest", 0, 200)],
    ),
    (
        "benchmarks/spheres_box_5000",
        &[
            stage("spheres_moving", 1, 60),
            stage("spheres_rest", 0, 100),
        ],
    ),
    (
        "benchmarks/cohesive_disks_3000",
        &[stage("cohesive_disks", 1, 200)],
    ),
    (
        "shear_cell_3d",
        &[
            stage("shear_cell_settling", 0, 400),
            stage("shear_cell_sliding", 300, 400),
        ],
    ),
    ("voronoi_block_3d", &[stage("polyhedra_bonded", 0, 100)]),
    (
        "wheel_rail_fretting_elastic",
        &[
            stage("elastic_compaction", 0, 400),
            stage("elastic_sliding", 700, 200),
        ],
    ),
];

fn main() {
    support::refuse_unoptimised();
    let (wanted, threads) = arguments();
    println!(
        "{:<20} {:>7} {:>6} {:>8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7}",
        "stage",
        "threads",
        "steps",
        "contacts",
        "sweeps",
        "step-ms",
        "cpu-ms",
        "detect",
        "laws",
        "solve",
        "rest",
        "ns/c/sw"
    );
    for (case, stages) in CASES {
        let last = stages
            .iter()
            .rposition(|s| wanted.as_ref().is_none_or(|w| s.name.contains(w.as_str())));
        let Some(last) = last else { continue };
        for &n in &threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.unwrap_or_else(|e| panic!("{e}"))
                .install(|| run(case, &stages[..=last], wanted.as_deref(), n));
        }
    }
}

/// The name to look for and the numbers of threads, of the command line.
fn arguments() -> (Option<String>, Vec<usize>) {
    let (mut wanted, mut threads, mut counts) = (None, Vec::new(), false);
    for word in std::env::args().skip(1) {
        match word.parse() {
            _ if word.starts_with('-') => counts = word == "--threads",
            Ok(n) if counts => threads.push(n),
            _ => wanted = Some(word),
        }
    }
    if threads.is_empty() {
        threads.push(1);
    }
    (wanted, threads)
}

fn run(case: &str, stages: &[Stage], wanted: Option<&str>, threads: usize) {
    let file = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let loaded = load(Path::new(&file), &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = loaded
        .build(&search_path())
        .unwrap_or_else(|e| panic!("{e}"));
    in_dimension!(scene.simulation, |s| {
        time(*s, &loaded.case, stages, wanted, threads);
    });
}

fn time<S: Space>(
    mut s: Simulation<S>,
    case: &Case,
    stages: &[Stage],
    wanted: Option<&str>,
    threads: usize,
) {
    // A run sets this option too.
    s.options.solver.parallel = threads > 1;
    processes::install(case, &mut s);
    for stage in stages {
        for _ in 0..stage.skipped {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let [mut detect, mut laws, mut solve] = [Duration::ZERO; 3];
        let (mut sweeps, mut contacts, mut per_sweep) = (0u64, 0, 0.0);
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        for _ in 0..stage.steps {
            let r = s.step().unwrap_or_else(|e| panic!("{e}"));
            let n = s.state.network.contacts.len();
            detect += r.timing.detect;
            laws += r.timing.laws;
            solve += r.timing.solve;
            sweeps += u64::from(r.solver.iterations);
            per_sweep += n as f64 * f64::from(r.solver.iterations);
            contacts += n;
        }
        let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
        if wanted.is_some_and(|w| !stage.name.contains(w)) {
            continue;
        }
        let n = f64::from(stage.steps);
        let ms = |d: Duration| 1e3 * d.as_secs_f64() / n;
        println!(
            "{:<20} {threads:>7} {:>6} {:>8.0} {:>7.1} {:>8.3} {:>8.3} {:>8.3} {:>8.3} {:>8.3} {:>8.3} {:>7.1}",
            stage.name,
            stage.steps,
            contacts as f64 / n,
            sweeps as f64 / n,
            ms(wall),
            ms(cpu),
            ms(detect),
            ms(laws),
            ms(solve),
            ms(wall) - ms(detect) - ms(laws) - ms(solve),
            1e9 * solve.as_secs_f64() / per_sweep,
        );
    }
}
