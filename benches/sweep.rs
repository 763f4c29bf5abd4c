//! One contact update of the Gauss-Seidel sweep against the bound of the machine it runs on.
//!
//! `cargo bench --bench sweep` builds packings of disks and spheres at rest in a box (lattices with
//! jitter in which a fraction of the contacts is open, bodies numbered by position as in a run) and
//! prints the bytes and flops of one update, the bandwidth and the arithmetic rate measured in the
//! same run over the same footprint, the resulting bound and the ratio of the sweep to it. The
//! sweep on two threads must give the bits of the sweep on one. Best of many runs, to reduce the
//! influence of other load. Words of the command line select the problems whose names contain them.

mod support;

use fretwork::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use fretwork::solve::nlgs::{prepare, sweeps};
use fretwork::solve::{ContactForm, Problem};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// Cost of one update, counted in `crates/core/src/solve/row/plain.rs`.
struct Cost {
    /// Bytes of the row; all of its cache lines are read and written back.
    row: f64,
    /// Bytes of rows and lines read and written, from L1 at best.
    near: f64,
    /// Additions, multiplications and comparisons.
    flops: f64,
    /// Divisions, and as many square roots.
    roots: f64,
    /// Length of the chain of dependent operations from the velocities read to those written.
    depth: f64,
}

const DISKS: Cost = Cost {
    row: 72.0,
    near: 72.0 + 16.0 + 2.0 * (40.0 + 32.0),
    flops: 41.0,
    roots: 0.0,
    depth: 15.0,
};
const SPHERES: Cost = Cost {
    row: 96.0,
    near: 96.0 + 32.0 + 2.0 * (64.0 + 64.0),
    flops: 95.0,
    roots: 1.0,
    depth: 20.0,
};

/// Rates and times of the machine, on one or two threads.
struct Machine {
    /// Bytes of the L1 cache in a nanosecond, half read and half written.
    l1: f64,
    /// Flops in a nanosecond, four lanes wide.
    flops: f64,
    /// Time of a division and a square root, four lanes wide, by lane (ns).
    root: f64,
    /// Time of an operation that waits for the previous one (ns).
    wait: f64,
}

fn main() {
    support::refuse_unoptimised();
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let machine = machine();
    println!(
        "one core: {:.1} flops/ns in one lane, {:.1} in four; L1 {:.0} B/ns; division and root {:.1} ns a lane; \
         an operation that waits {:.2} ns",
        scalar_rate(),
        machine.flops,
        machine.l1,
        machine.root,
        machine.wait
    );
    println!(
        "{:<10} {:>8} {:>6} {:>6} {:>6} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>6} {:>8} {:>8} {:>6}",
        "problem",
        "contacts",
        "a body",
        "B far",
        "flops",
        "B/ns 1",
        "B/ns 2",
        "far",
        "L1",
        "arith",
        "chain",
        "ns 1",
        "ratio",
        "ns 2",
        "speed-up",
        "ratio"
    );
    for contacts in [5_000, 100_000, 500_000] {
        for (name, solid) in [("disks", false), ("spheres", true)] {
            let name = format!("{name}_{}", contacts / 1000);
            if wanted.as_ref().is_some_and(|w| !name.contains(w.as_str())) {
                continue;
            }
            if solid {
                bench(&name, &spheres(contacts), &SPHERES, &machine);
            } else {
                bench(&name, &disks(contacts), &DISKS, &machine);
            }
        }
    }
}

fn bench<S: Space>(name: &str, make: &dyn Fn() -> Problem<S>, cost: &Cost, machine: &Machine) {
    let mut one = make();
    let mut two = make();
    let n = one.contacts() as f64;
    let bodies = one.solver_bodies.len() as f64;
    prepare(&mut one);
    prepare(&mut two);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .unwrap_or_else(|e| panic!("{e}"));
    // Every line is loaded and written back once per sweep; in between it is in L1.
    let far = 2.0 * cost.row + 2.0 * 64.0 * bodies / n;
    let footprint = cost.row * n + 64.0 * bodies;
    let mut stream = vec![1.0f64; (footprint / 8.0) as usize];
    // Many short runs are made, so that some have the machine to themselves.
    let count = (100_000.0 / n).ceil() as u32;
    let seconds = std::env::var("SECONDS_EACH")
        .ok()
        .and_then(|s| s.parse().ok());
    let seconds: f64 = seconds.unwrap_or(5.0);
    let start = Instant::now();
    let (mut t1, mut t2) = (f64::INFINITY, f64::INFINITY);
    let (mut b1, mut b2) = (0.0f64, 0.0f64);
    while start.elapsed().as_secs_f64() < seconds {
        b1 = b1.max(copy(&mut stream, count, 1));
        let clock = Instant::now();
        sweeps(&mut one, count, 1.0, false);
        t1 = t1.min(clock.elapsed().as_secs_f64());
        pool.install(|| {
            b2 = b2.max(copy(&mut stream, count, 2));
            let clock = Instant::now();
            sweeps(&mut two, count, 1.0, true);
            t2 = t2.min(clock.elapsed().as_secs_f64());
        });
    }
    assert!(same(&one, &two), "{name}: threads change the bits");
    let (ns1, ns2) = (
        t1 * 1e9 / n / f64::from(count),
        t2 * 1e9 / n / f64::from(count),
    );
    let (stream1, stream2) = (far / b1, far / b2);
    let l1 = cost.near / machine.l1;
    let arithmetic = cost.flops / machine.flops + cost.roots * machine.root;
    let bound = stream1.max(l1).max(arithmetic);
    let bound2 = stream2.max(0.5 * l1.max(arithmetic));
    println!(
        "{name:<10} {n:>8} {:>6.1} {far:>6.0} {:>6.0} {b1:>8.1} {b2:>8.1} {stream1:>6.1} {l1:>6.1} {arithmetic:>6.1} \
         {:>6.1} {ns1:>8.2} {:>6.2} {ns2:>8.2} {:>8.2} {:>6.2}",
        2.0 * n / bodies,
        cost.flops,
        cost.depth * machine.wait,
        ns1 / bound,
        ns1 / ns2,
        ns2 / bound2
    );
}

fn same<S: Space>(one: &Problem<S>, two: &Problem<S>) -> bool {
    one.solver_bodies
        .iter()
        .zip(&two.solver_bodies)
        .all(|(a, b)| {
            (0..S::D).all(|k| a.v[k].to_bits() == b.v[k].to_bits())
                && (0..S::Spin::N).all(|k| a.s[k].to_bits() == b.s[k].to_bits())
        })
}

/// Bytes in a nanosecond, read and written.
fn copy(stream: &mut [f64], count: u32, threads: usize) -> f64 {
    let bytes = 16.0 * stream.len() as f64 * f64::from(count);
    let pass = |part: &mut [f64]| {
        for x in part {
            *x *= 1.000_000_1;
        }
    };
    let clock = Instant::now();
    for _ in 0..count {
        if threads == 1 {
            pass(black_box(&mut *stream));
        } else {
            let half = stream.len().div_ceil(threads);
            black_box(&mut *stream).par_chunks_mut(half).for_each(pass);
        }
    }
    bytes / (clock.elapsed().as_secs_f64() * 1e9)
}

fn machine() -> Machine {
    let best = |f: &mut dyn FnMut() -> f64| (0..20).map(|_| f()).fold(0.0, f64::max);
    let mut small = vec![1.0f64; 2048];
    Machine {
        l1: best(&mut || copy(&mut small, 2_000, 1)),
        flops: best(&mut wide_rate),
        root: 1.0 / best(&mut || 1.0 / root_time()),
        wait: 1.0 / best(&mut || 1.0 / wait_time()),
    }
}

const ROUNDS: usize = 200_000;

/// Flops in a nanosecond, one lane.
fn scalar_rate() -> f64 {
    (0..20).map(|_| narrow()).fold(0.0, f64::max)
}

fn wide_rate() -> f64 {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has these instructions.
        return unsafe { wide() };
    }
    narrow()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn wide() -> f64 {
    use std::arch::x86_64::*;
    let m = _mm256_set1_pd(black_box(1.000_000_1));
    let a = _mm256_set1_pd(black_box(1e-9));
    let mut x = [_mm256_set1_pd(black_box(1.0)); 12];
    let clock = Instant::now();
    for _ in 0..ROUNDS {
        for y in &mut x {
            *y = _mm256_add_pd(_mm256_mul_pd(*y, m), a);
        }
    }
    black_box(&x);
    (2 * 4 * 12 * ROUNDS) as f64 / (clock.elapsed().as_secs_f64() * 1e9)
}

/// Arithmetic in one lane, without inlining, since the compiler would otherwise vectorise it.
#[cfg(target_arch = "x86_64")]
fn narrow() -> f64 {
    let (m, a) = (black_box(1.000_000_1), black_box(1e-9));
    let mut x = [black_box(1.0); 12];
    let clock = Instant::now();
    for _ in 0..ROUNDS {
        for y in &mut x {
            // SAFETY: the assembly only computes in registers.
            unsafe {
                std::arch::asm!(
                    "mulsd {y}, {m}",
                    "addsd {y}, {a}",
                    y = inout(xmm_reg) *y,
                    m = in(xmm_reg) m,
                    a = in(xmm_reg) a,
                    options(pure, nomem, nostack)
                );
            }
        }
    }
    black_box(&x);
    (2 * 12 * ROUNDS) as f64 / (clock.elapsed().as_secs_f64() * 1e9)
}

#[cfg(not(target_arch = "x86_64"))]
fn narrow() -> f64 {
    let (m, a) = (black_box(1.000_000_1), black_box(1e-9));
    let mut x = [black_box(1.0); 12];
    let clock = Instant::now();
    for _ in 0..ROUNDS {
        for y in &mut x {
            *y = *y * m + a;
        }
    }
    black_box(&x);
    (2 * 12 * ROUNDS) as f64 / (clock.elapsed().as_secs_f64() * 1e9)
}

/// Nanoseconds of a division and a square root, by lane.
fn root_time() -> f64 {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has these instructions.
        return unsafe { wide_roots() };
    }
    roots()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn wide_roots() -> f64 {
    roots()
}

#[inline(always)]
fn roots() -> f64 {
    let b = black_box(1.0);
    let mut x = [black_box(2.0f64); 16];
    let clock = Instant::now();
    for _ in 0..ROUNDS / 10 {
        for y in &mut x {
            *y = b / y.sqrt();
        }
        x = black_box(x);
    }
    clock.elapsed().as_secs_f64() * 1e9 / (16 * ROUNDS / 10) as f64
}

/// Nanoseconds of an operation that waits for the one before.
fn wait_time() -> f64 {
    let (m, a) = (black_box(1.000_000_1), black_box(1e-9));
    let mut x = black_box(1.0);
    let clock = Instant::now();
    for _ in 0..ROUNDS {
        x = x * m + a;
    }
    black_box(x);
    clock.elapsed().as_secs_f64() * 1e9 / (2 * ROUNDS) as f64
}

/// Centres of a lattice of unit radii, the shape of its box, and pairs that may touch.
struct Lattice<const D: usize> {
    centres: Vec<[f64; D]>,
    /// Fraction of close pairs that touch.
    share: f64,
}

fn disks(contacts: usize) -> impl Fn() -> Problem<Dim2> {
    move || {
        let side = (contacts as f64 / 2.0).sqrt().round() as usize;
        let mut centres: Vec<[f64; 2]> = Vec::new();
        for j in 0..side {
            for i in 0..side {
                let x = 2.0 * i as f64 + (j % 2) as f64;
                centres.push([x, 3.0f64.sqrt() * j as f64]);
            }
        }
        problem(Lattice {
            centres,
            share: 4.0 / 6.0,
        })
    }
}

fn spheres(contacts: usize) -> impl Fn() -> Problem<Dim3> {
    move || {
        let side = (contacts as f64 / 3.0 / 4.0).cbrt();
        let (n, m) = (side.floor() as usize, side.ceil() as usize);
        let n = [n.max(1), m, m];
        let edge = 8.0f64.sqrt();
        let mut centres: Vec<[f64; 3]> = Vec::new();
        for i in 0..n[0] {
            for j in 0..n[1] {
                for k in 0..n[2] {
                    let at = [i, j, k].map(|c| c as f64 * edge);
                    for shift in [
                        [0.0, 0.0, 0.0],
                        [0.5, 0.5, 0.0],
                        [0.5, 0.0, 0.5],
                        [0.0, 0.5, 0.5],
                    ] {
                        centres.push(std::array::from_fn(|d| at[d] + edge * shift[d]));
                    }
                }
            }
        }
        problem(Lattice {
            centres,
            share: 0.5,
        })
    }
}

fn problem<S: Space, const D: usize>(lattice: Lattice<D>) -> Problem<S> {
    let mut rng = Pcg64::seed_from_u64(1);
    let Lattice { mut centres, share } = lattice;
    let mut random = |a: f64, b: f64| rng.random_range(a..b);
    for c in &mut centres {
        for x in c {
            *x += random(-0.05, 0.05);
        }
    }
    // The order of `scene::build`: cells of two diameters, the last axis first.
    let cell = |x: &[f64; D], width: f64| -> [i64; D] {
        std::array::from_fn(|k| (x[D - 1 - k] / width).floor() as i64)
    };
    let tag: Vec<u64> = centres.iter().map(|_| random(0.0, 1e9) as u64).collect();
    let mut numbers: Vec<usize> = (0..centres.len()).collect();
    numbers.sort_by_key(|k| (cell(&centres[*k], 4.0), tag[*k]));
    let centres: Vec<[f64; D]> = numbers.iter().map(|k| centres[*k]).collect();
    let mut p = Problem::default();
    for _ in &centres {
        let mass = random(0.8, 1.25);
        let mut m = S::Vector::zero();
        let mut v = S::Vector::zero();
        for k in 0..D {
            m[k] = 1.0 / mass;
            v[k] = random(-0.01, 0.01);
        }
        v[D - 1] -= 1.0;
        let inverse = S::Tensor::uniform(1.0 / (S::BALL_INERTIA * mass));
        p.push_body(v, S::Spin::zero(), m, inverse, 1.0);
    }
    let floor = centres.len() as u32;
    let null = S::Vector::zero();
    p.push_body(null, S::Spin::zero(), null, S::Tensor::uniform(0.0), 1.0);
    // Neighbours are found by cells as wide as the reach.
    let reach = 2.15;
    let mut cells = std::collections::HashMap::<[i64; D], Vec<u32>>::new();
    for (k, c) in centres.iter().enumerate() {
        cells.entry(cell(c, reach)).or_default().push(k as u32);
    }
    let mut lowest = f64::INFINITY;
    for c in &centres {
        lowest = lowest.min(c[D - 1]);
    }
    for (a, at) in centres.iter().enumerate() {
        let home = cell(at, reach);
        let mut near = Vec::new();
        for code in 0..3i64.pow(D as u32) {
            let key = std::array::from_fn(|k| home[k] + code / 3i64.pow(k as u32) % 3 - 1);
            near.extend(
                cells
                    .get(&key)
                    .into_iter()
                    .flatten()
                    .filter(|b| **b as usize > a),
            );
        }
        near.sort_unstable();
        for b in near {
            let d: [f64; D] = std::array::from_fn(|k| at[k] - centres[b as usize][k]);
            let r = d.iter().map(|x| x * x).sum::<f64>().sqrt();
            if r < reach && random(0.0, 1.0) < share {
                let normal = S::Vector::from_slice(&d.map(|x| x / r));
                p.push(&contact(a as u32, b, normal, random(0.0, 1.0)));
            }
        }
        if at[D - 1] < lowest + 0.2 {
            let mut up = S::Vector::zero();
            up[D - 1] = 1.0;
            p.push(&contact(a as u32, floor, up, 1.0));
        }
    }
    p
}

fn contact<S: Space>(a: u32, b: u32, normal: S::Vector, push: f64) -> ContactForm<S> {
    ContactForm {
        bodies: [a, b],
        normal,
        arms: [-normal, normal],
        friction: 0.3,
        impulse: normal * push,
        ..ContactForm::default()
    }
}
