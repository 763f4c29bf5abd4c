//! The adhesion curve: friction of a rolling wheel against creepage, with third body and without.
//!
//! `cargo run --release --example adhesion` runs `cases/wheel_rail_rolling.ron` at some creepages, two at a time, prints the
//! table of `docs/wear.md` and draws `docs/figures/adhesion.png`. The force is the mean traction over the mean load, from
//! 0.02 s on, with its interval by batch means. Without third body wheel and rail are rigid: Q/P = mu at any creepage.

use fretwork::geometry::space::Plane;
use fretwork::laws::SearchPath;
use fretwork::record::steady::{self, Flow};
use fretwork::report::{Axis, Chart, Series, Style};
use fretwork::scene::load;
use rayon::prelude::*;
use std::path::Path;

type Failure = Box<dyn std::error::Error + Send + Sync>;

const CREEPAGES: [f64; 8] = [0.0, 0.0025, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2];
/// Speed of the wheel (m/s) and its radius (m), those of the case.
const SPEED: f64 = 2e-3;
const RADIUS: f64 = 3e-4;
/// When rolling is counted from (s).
const START: f64 = 0.02;

fn main() -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build_global()?;
    let all: Vec<(bool, f64)> = [true, false]
        .iter()
        .flat_map(|l| CREEPAGES.map(|c| (*l, c)))
        .collect();
    let found: Result<Vec<(Flow, f64)>, Failure> =
        all.par_iter().map(|(layer, c)| roll(*layer, *c)).collect();
    let found = found?;
    println!("| creepage | Q/P with third body | Q/P without | steps not converged |");
    println!("|---|---|---|---|");
    let n = CREEPAGES.len();
    for (k, c) in CREEPAGES.iter().enumerate() {
        let ((with, missed), (without, _)) = (&found[k], &found[n + k]);
        println!(
            "| {:.2} % | {:.3} +- {:.3} | {:.3} | {missed:.0} |",
            100.0 * c,
            with.mean,
            with.half_width,
            without.mean
        );
    }
    let points = |from: usize| {
        (0..n)
            .map(|k| (100.0 * CREEPAGES[k], found[from + k].0.mean))
            .collect()
    };
    let x = Axis::new("creepage", "%");
    let chart = Chart::new("friction of a rolling wheel", x, Axis::new("Q/P", ""))
        .with(Series::new("with third body", points(0)).style(Style::LineMarkers))
        .with(Series::new("without", points(n)).style(Style::LineMarkers));
    chart.draw(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/adhesion.png"))?;
    println!("drawn to docs/figures/adhesion.png");
    Ok(())
}

/// Traction over load at a creepage, and the steps that did not converge.
fn roll(layer: bool, creepage: f64) -> Result<(Flow, f64), Failure> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/wheel_rail_rolling.ron");
    let spin = -SPEED / RADIUS * (1.0 + creepage);
    let mut sets = vec![format!(
        "bodies.1.dofs.rz=Velocity(Ramp(from: 0.0, to: {spin:e}, start: 0.01, end: 0.012))"
    )];
    if !layer {
        // One grain, far from the wheel's way, and the wheel just above the rail.
        sets.push(
            "grains.0=List(material: \"oxide\", grains: [(at: [2e-3, 2e-6], radius: 2e-6)])"
                .to_owned(),
        );
        sets.push(format!(
            "bodies.1.position=[3e-4, {:e}]",
            RADIUS * (1.0 + 1e-5)
        ));
    }
    let loaded = load(&case, &sets)?;
    let mut s = loaded.build_in::<Plane>(&SearchPath::new(&[]))?.simulation;
    let place = s.bodies.driven.iter().position(|d| d.name == "wheel");
    let place = place.ok_or("the case has no wheel")?;
    let (mut traction, mut load, mut missed) = (vec![(START, 0.0)], 0.0, 0.0);
    while s.time < loaded.case.time.end {
        let report = s.step()?;
        missed += f64::from(u8::from(!report.solver.converged));
        if s.time > START {
            let impulse = s.received[place].0;
            load += impulse[1];
            let before = traction.last().map_or(0.0, |p| p.1);
            traction.push((s.time, before + impulse[0]));
        }
    }
    let mut flow = steady::flow(&traction, START, s.time).ok_or("the run is too short")?;
    let load = load / (s.time - START);
    (flow.mean, flow.half_width) = (flow.mean / load, flow.half_width / load);
    Ok((flow, missed))
}
