//! Pressures of a rough ball on a flat, on grids up to that of a measured surface, beside Tamaas,
//! and friction loops of it.
//!
//! `cargo bench -p fretwork-rolling` prints for each grid the cells in contact, iterations and
//! wall-clock time on one thread, without that of set-up. Where Tamaas is installed (`pip install
//! tamaas`), it solves the same problem in turn: its time over ours by the medians of `ROUNDS`
//! rounds, 3 by default, and the difference of the pressures, sum |p - p_T| over sum p.
//! `TAMAAS_PYTHON` names the Python that has it, `python3` by default; a number the only grid, in
//! cells along a side.
//!
//! Then for grids up to 256 the time of a friction loop of partial slip, 50 steps with Coulomb's
//! friction under these pressures: the first loading in 10 steps and the cycle in 40.

#[path = "../../../benches/support/mod.rs"]
mod support;

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::{CellGrid, Complex64, Transforms};
use fretwork_rolling::fretting::{Amplitude, Fretting};
use fretwork_rolling::friction::Coulomb;
use fretwork_rolling::normal::normal;
use fretwork_rolling::surfaces::Surfaces;
use rand::{RngExt, SeedableRng};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Side of the square (m), radius of the ball (m), root mean square of the roughness (m).
const EXTENT: f64 = 1e-3;
const RADIUS: f64 = 10e-3;
const ROUGHNESS: f64 = 0.1e-6;
/// Load (N): the patch of the smooth ball has a diameter of 0.43 of the side.
const LOAD: f64 = 150.0;
/// Waves of the roughness: numbers in the square, from the longest to the shortest, which the
/// coarsest grid resolves by four cells; exponent of the amplitude of a self-affine surface with a
/// Hurst exponent of 0.8.
const LONGEST: f64 = 4.0;
const SHORTEST: f64 = 16.0;
const EXPONENT: f64 = -1.8;
/// Coefficient of friction, and amplitude of the displacement (m): about half of that at which the
/// smooth ball slides.
const MU: f64 = 0.6;
const AMPLITUDE: f64 = 1.5e-6;
/// Steps of a quarter of the cycle, and the finest grid of loops.
const QUARTER: usize = 10;
const LARGEST_LOOP: usize = 256;
/// The two bodies.
const STEEL: Elasticity = Elasticity {
    young: 210e9,
    poisson: 0.3,
    density: 7800.0,
};
const GRIDS: [usize; 5] = [64, 128, 256, 512, 1024];
/// Tolerance of Tamaas: at a larger one its pressures differ from ours by more than 1e-6.
const TOLERANCE: &str = "1e-9";

fn main() {
    support::refuse_unoptimised();
    let number = |name: &str| {
        std::env::var(name)
            .ok()
            .and_then(|s| s.parse::<usize>().ok())
    };
    let rounds = number("ROUNDS").unwrap_or(3);
    let peer = Peer::find();
    match &peer {
        Some(_) => println!("Tamaas in turn, medians of {rounds} rounds"),
        None => println!("Tamaas is not installed (TAMAAS_PYTHON): no ratios"),
    }
    print!("{:>11} {:>8} {:>5} {:>9}", "grid", "contact", "iter", "s");
    match &peer {
        Some(_) => println!(" {:>9} {:>9} {:>10}", "Tamaas-s", "times", "difference"),
        None => println!(),
    }
    let wanted = std::env::args()
        .skip(1)
        .find_map(|a| a.parse::<usize>().ok());
    let grids = GRIDS.into_iter().filter(|n| wanted.is_none_or(|w| w == *n));
    for cells in grids.clone() {
        one(cells, rounds, peer.as_ref());
    }
    println!(
        "\nfriction loops\n{:>11} {:>8} {:>8} {:>9} {:>9}",
        "grid", "stuck", "Newton", "linear", "s"
    );
    for cells in grids.filter(|n| *n <= LARGEST_LOOP) {
        friction_loop(cells);
    }
}

fn square(cells: usize) -> CellGrid {
    CellGrid {
        from: [-0.5 * EXTENT; 2],
        size: [EXTENT / cells as f64; 2],
        cells: [cells; 2],
    }
}

fn friction_loop(cells: usize) {
    let grid = square(cells);
    let surfaces = Surfaces::new(grid, [STEEL; 2], 0.0);
    let pressed = normal(&surfaces, &rough_ball(&grid), LOAD, None);
    let pressed = pressed.unwrap_or_else(|e| panic!("{e}"));
    let frets = Fretting {
        surfaces: &surfaces,
        pressure: &pressed.pressure,
        law: &Coulomb(MU),
        along: [1.0, 0.0],
        step: 1e-3,
    };
    let clock = Instant::now();
    let found = frets.cycles(Amplitude::Displacement(AMPLITUDE), QUARTER, 1);
    let time = clock.elapsed().as_secs_f64();
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    let [newton, linear] = found.iterations;
    println!(
        "{cells:>5}x{cells:<5} {:>8.3} {newton:>8} {linear:>9} {time:>9.2}",
        found.stuck
    );
}

fn one(cells: usize, rounds: usize, peer: Option<&Peer>) {
    let grid = square(cells);
    let distance = rough_ball(&grid);
    let surfaces = Surfaces::new(grid, [STEEL; 2], 0.0);
    let (mut own, mut others, mut difference) = (Vec::new(), Vec::new(), 0.0);
    let mut line = String::new();
    for _ in 0..rounds {
        let clock = Instant::now();
        let found = normal(&surfaces, &distance, LOAD, None);
        own.push(clock.elapsed().as_secs_f64());
        let found = found.unwrap_or_else(|e| panic!("{e}"));
        let touching = found.pressure.iter().filter(|p| **p > 0.0).count();
        line = format!(
            "{:>5}x{cells:<5} {touching:>8} {:>5}",
            cells, found.iterations
        );
        if let Some(peer) = peer {
            let (time, pressure) = peer.solve(&distance, cells);
            others.push(time);
            let all = found.pressure.iter();
            let differ: f64 = all.clone().zip(&pressure).map(|(a, b)| (a - b).abs()).sum();
            difference = differ / all.sum::<f64>();
        }
    }
    let own = median(own);
    print!("{line} {own:>9.3}");
    match others.is_empty() {
        true => println!(),
        false => {
            let other = median(others);
            println!(" {other:>9.3} {:>9.2} {difference:>10.1e}", other / own);
        }
    }
}

/// Distances of a ball with a self-affine roughness from a flat (m).
fn rough_ball(grid: &CellGrid) -> Vec<f64> {
    let mut random = rand_pcg::Pcg64::seed_from_u64(1);
    let cells = grid.cells;
    let transforms = Transforms::new(cells);
    // The same phases on all grids.
    let most = SHORTEST as i64;
    let mut waves = vec![Complex64::ZERO; transforms.waves().count()];
    for i in 0..=most {
        for j in -most..=most {
            let phase = std::f64::consts::TAU * random.random::<f64>();
            let number = (i as f64).hypot(j as f64);
            if (LONGEST..=SHORTEST).contains(&number) {
                let row = j.rem_euclid(cells[1] as i64) as usize;
                waves[i as usize * cells[1] + row] =
                    Complex64::from_polar(number.powf(EXPONENT), phase);
            }
        }
    }
    let mut heights = transforms.backward(waves, cells);
    let square: f64 = heights.iter().map(|h| h * h).sum();
    let factor = ROUGHNESS / (square / heights.len() as f64).sqrt();
    for (cell, height) in heights.iter_mut().enumerate() {
        let [x, y] = grid.middle(cell);
        *height = factor * *height + (x * x + y * y) / (2.0 * RADIUS);
    }
    heights
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Tamaas, by the Python that has it.
struct Peer {
    python: OsString,
    folder: PathBuf,
}

impl Peer {
    fn find() -> Option<Self> {
        let python = std::env::var_os("TAMAAS_PYTHON").unwrap_or_else(|| "python3".into());
        let mut probe = Command::new(&python);
        probe.args(["-c", "import tamaas"]).stderr(Stdio::null());
        let there = probe.status().is_ok_and(|s| s.success());
        let folder = std::env::temp_dir();
        there.then_some(Self { python, folder })
    }

    /// Returns the time of its solution (s) and its pressures (Pa).
    fn solve(&self, distance: &[f64], cells: usize) -> (f64, Vec<f64>) {
        let name = |what: &str| {
            self.folder
                .join(format!("{what}-{}.bin", std::process::id()))
        };
        let (heights, pressures) = (name("heights"), name("pressures"));
        let bytes: Vec<u8> = distance.iter().flat_map(|h| h.to_le_bytes()).collect();
        std::fs::write(&heights, bytes).unwrap_or_else(|e| panic!("{e}"));
        // E* of two equal bodies.
        let modulus = 0.5 * STEEL.young / (1.0 - STEEL.poisson * STEEL.poisson);
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut command = Command::new(&self.python);
        command.arg(root.join("benches/tamaas_contact.py"));
        command.arg(&heights).arg(cells.to_string());
        command.args([EXTENT, modulus, LOAD].map(|x| x.to_string()));
        let output = command.arg(TOLERANCE).arg(&pressures).output();
        let output = output.unwrap_or_else(|e| panic!("{e}"));
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let bytes = std::fs::read(&pressures).unwrap_or_else(|e| panic!("{e}"));
        for file in [heights, pressures] {
            let _ = std::fs::remove_file(file);
        }
        let numbers = bytes
            .as_chunks::<8>()
            .0
            .iter()
            .map(|b| f64::from_le_bytes(*b));
        let time = String::from_utf8_lossy(&output.stdout).trim().parse();
        (time.unwrap_or(f64::NAN), numbers.collect())
    }
}
