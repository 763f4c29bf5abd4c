//! Adhesion curve: friction of a rolling wheel against creepage, with and without third body.
//!
//! `cargo run --release --example adhesion` rolls `cases/wheel_rail_rolling.ron` at several
//! creepages, two at a time, without third body and with five samples of it, prints the tables of
//! `docs/rolling.md` and draws `docs/figures/adhesion.png` with the closed form of the bare
//! contact. Creepages (in per cent) may be given: `-- 0 1 2`; then no figure is drawn.

use fretwork::geometry::space::Dim2;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::view::{Axis, Chart, Series, Style, draw_panels};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::path::Path;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Creepages with and without third body.
const WITH: [f64; 7] = [0.0, 0.0025, 0.005, 0.01, 0.02, 0.04, 0.08];
const BARE: [f64; 10] = [
    0.0, 0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.01, 0.02, 0.08,
];
const SEEDS: [u64; 5] = [3, 4, 5, 6, 7];
/// Speed (m/s), radius (m), load (N/m), friction coefficient and stiffnesses of the elastic layer
/// (Pa/m) in the case.
const SPEED: f64 = 1.0;
const RADIUS: f64 = 0.46;
const LOAD: f64 = 1.333e7;
const MU: f64 = 0.4;
const NORMAL: f64 = 1.292e13;
const TANGENTIAL: f64 = NORMAL * 2.0 / 3.0;
/// Time from which rolling is evaluated (s).
const START: f64 = 0.03;

/// Averages over a run; forces are divided by the mean load.
#[derive(Clone, Copy)]
struct Rolling {
    creepage: f64,
    bare: bool,
    /// Force along the rail, and moment over the radius.
    force: f64,
    moment: f64,
    /// Power of the contact forces on the wheel, friction power, total dissipated power and rate of
    /// stored energy, over P v.
    power: f64,
    friction: f64,
    lost: f64,
    stored: f64,
    /// Height of the wheel's centre above its height on a rigid bare rail (m).
    height: f64,
    steps: u32,
    missed: u32,
    iterations: f64,
}

fn main() -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build_global()?;
    let given: Result<Vec<f64>, _> = std::env::args().skip(1).map(|a| a.parse()).collect();
    let given: Vec<f64> = given?.iter().map(|percent: &f64| percent / 100.0).collect();
    let (with, bare) = match given.is_empty() {
        true => (&WITH[..], &BARE[..]),
        false => (&given[..], &given[..]),
    };
    let mut all: Vec<(bool, f64, u64)> = Vec::new();
    for c in with {
        all.extend(SEEDS.map(|seed| (false, *c, seed)));
    }
    // The bare contact has no randomness.
    all.extend(bare.iter().map(|c| (true, *c, SEEDS[0])));
    let runs: Result<Vec<Rolling>, Failure> =
        all.par_iter().map(|(b, c, s)| roll(*b, *c, *s)).collect();
    let (without, layers): (Vec<Rolling>, Vec<Rolling>) = runs?.into_iter().partition(|r| r.bare);
    table("without third body", &without, 1);
    table("with third body", &layers, SEEDS.len());
    if given.is_empty() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/adhesion.png");
        let charts = [
            chart("To saturation and beyond", 8.4, &without, &layers),
            chart("Small creepages", 1.6, &without, &layers),
        ];
        draw_panels(&charts, 2, &path)?;
        println!("drawn to docs/figures/adhesion.png");
    }
    Ok(())
}

/// Half length of the bare contact patch (m) and largest pressure (Pa): P = 4/3 a p0, p0 = k_n
/// a^2/(2 R).
fn patch() -> (f64, f64) {
    let a = (1.5 * LOAD * RADIUS / NORMAL).cbrt();
    (a, NORMAL * a * a / (2.0 * RADIUS))
}

/// Q/P of bristles of stiffness k_t under a parabolic pressure. The arc of the disk is longer than
/// its chord, so averaged over the patch its surface velocity along the rail is lower than that of
/// its rim by the fraction a^2/(6 R^2).
fn closed(creepage: f64) -> f64 {
    let (a, p0) = patch();
    let s = TANGENTIAL * (creepage - a * a / (6.0 * RADIUS * RADIUS)) * a / (2.0 * MU * p0);
    MU * s.signum() * (1.0 - (1.0 - s.abs().min(1.0)).powi(3))
}

/// Q/P of an elastic half-plane (Carter).
fn carter(creepage: f64) -> f64 {
    let s = (creepage * RADIUS / (MU * patch().0)).min(1.0);
    MU * (1.0 - (1.0 - s).powi(2))
}

/// Mean over samples and half-width of its 95 % interval by Student's t; NaN for one sample.
fn spread(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    let t = StudentsT::new(0.0, 1.0, n - 1.0).map_or(0.0, |t| t.inverse_cdf(0.975));
    (mean, t * (square / (n * (n - 1.0).max(1.0))).sqrt())
}

fn table(title: &str, runs: &[Rolling], samples: usize) {
    println!("{title}:\n");
    println!(
        "| creepage | Q/P | +- | closed form, bare | M/(R P) | power of forces | friction | all lost | stored | height (mm) | iterations | steps not converged |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for group in runs.chunks(samples) {
        let mean = |of: &dyn Fn(&Rolling) -> f64| spread(&group.iter().map(of).collect::<Vec<_>>());
        let (q, half) = mean(&|r| r.force);
        println!(
            "| {:.2} % | {q:.4} | {half:.4} | {:.4} | {:.4} | {:.5} | {:.5} | {:.5} | {:.5} | {:.3} | {:.0} | {} of {} |",
            100.0 * group[0].creepage,
            closed(group[0].creepage),
            mean(&|r| r.moment).0,
            mean(&|r| r.power).0,
            mean(&|r| r.friction).0,
            mean(&|r| r.lost).0,
            mean(&|r| r.stored).0,
            1e3 * mean(&|r| r.height).0,
            mean(&|r| r.iterations).0,
            group.iter().map(|r| r.missed).sum::<u32>(),
            group.iter().map(|r| r.steps).sum::<u32>(),
        );
    }
    println!();
}

fn chart(title: &str, end: f64, without: &[Rolling], layers: &[Rolling]) -> Chart {
    let curve = |f: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let at = |k: i32| end * f64::from(k) / 300.0;
        (0..=300).map(|k| (at(k), f(0.01 * at(k)))).collect()
    };
    let within = |r: &&Rolling| 100.0 * r.creepage <= end;
    let points: Vec<(f64, f64)> = without
        .iter()
        .filter(within)
        .map(|r| (100.0 * r.creepage, r.force))
        .collect();
    let (mut means, mut bars) = (Vec::new(), Vec::new());
    for group in layers.chunks(SEEDS.len()) {
        let x = 100.0 * group[0].creepage;
        if x <= end {
            let (q, half) = spread(&group.iter().map(|r| r.force).collect::<Vec<_>>());
            means.push((x, q));
            bars.push((q - half, q + half));
        }
    }
    let mut chart = Chart::new(
        title,
        Axis::new("creepage ξ", "%"),
        Axis::new("traction coefficient Q/P", ""),
    )
    .with(Series::new("without third body", points).style(Style::Markers))
    .with(Series::new("brush, closed form", curve(&closed)))
    .with(Series::new("Carter, half-plane", curve(&carter)).style(Style::Dashed))
    .with(
        Series::new("with third body", means)
            .style(Style::LineMarkers)
            .intervals(bars),
    );
    chart.x_range = Some((0.0, end));
    chart.y_range = Some((-0.05, 0.45));
    chart
}

fn roll(bare: bool, creepage: f64, seed: u64) -> Result<Rolling, Failure> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/wheel_rail_rolling.ron");
    let spin = -SPEED / RADIUS * (1.0 + creepage);
    let mut sets = vec![
        format!("bodies.wheel.dofs.rz=Velocity(Constant({spin:e}))"),
        format!("seed={seed}"),
    ];
    if bare {
        sets.push("grains.1.count=1".to_owned());
    }
    let loaded = load(&case, &sets)?;
    let mut s = loaded.build_in::<Dim2>(&search_path())?;
    let place = s.state.bodies.driven.iter().position(|d| d.name == "wheel");
    let place = place.ok_or("the case has no wheel")?;
    let wheel = s.state.bodies.driven[place].body as usize;
    let mut seen = Rolling {
        creepage,
        bare,
        force: 0.0,
        moment: 0.0,
        power: 0.0,
        friction: 0.0,
        lost: 0.0,
        stored: 0.0,
        height: 0.0,
        steps: 0,
        missed: 0,
        iterations: 0.0,
    };
    let (mut load, mut counted) = (0.0, 0.0);
    let mut start = s.state.energy;
    while s.state.time < loaded.case.time.end - 1e-9 {
        let before = s.state.bodies.velocity[wheel][1];
        let report = s.step()?;
        seen.steps += 1;
        seen.missed += u32::from(!report.solver.converged);
        seen.iterations += f64::from(report.solver.iterations);
        if s.state.time <= START {
            start = s.state.energy;
            continue;
        }
        let (impulse, moment) = s.state.received[place];
        load += impulse[1];
        seen.force += impulse[0];
        seen.moment += moment[0] / RADIUS;
        let theta = s.options.scheme.theta;
        let rise = theta * s.state.bodies.velocity[wheel][1] + (1.0 - theta) * before;
        seen.power -= impulse[0] * SPEED + moment[0] * spin + impulse[1] * rise;
        seen.height += s.state.bodies.position[wheel][1] - RADIUS - 5e-4;
        counted += 1.0;
    }
    let e = &s.state.energy;
    let passed = load * SPEED;
    seen.friction = (e.friction - start.friction) / passed;
    seen.lost = (e.dissipated() + e.scheme - start.dissipated() - start.scheme) / passed;
    seen.stored = (e.kinetic + e.elastic - start.kinetic - start.elastic) / passed;
    seen.power /= passed;
    seen.force /= load;
    seen.moment /= load;
    seen.height /= counted;
    seen.iterations /= f64::from(seen.steps);
    Ok(seen)
}
