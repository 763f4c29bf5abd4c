//! Regimes of a sheared layer of bonded grains, by bond strength and pressure.
//!
//! `cargo run --release --example regime_map` runs `cases/regime_map.ron` for six strengths, three pressures
//! and three seeds, two at a time, prints means over the seeds with their 95 % intervals as the table of
//! `docs/circuit.md` and draws `docs/figures/regime_map.png`: friction and mean cluster size against strength
//! over pressure. The behaviour of walls and bonds depends on that ratio; pressure alone changes the inertial
//! number.

use fretwork::geometry::space::Dim2;
use fretwork::laws::SearchPath;
use fretwork::record::run::{RunOptions, run};
use fretwork::report::{Axis, Chart, Series, Style, draw_panels, quantity};
use fretwork::scene::load;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::path::Path;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Bond strength over pressure.
const RATIOS: [f64; 6] = [0.1, 1.0, 10.0, 30.0, 100.0, 1000.0];
/// Pressures (Pa).
const PRESSURES: [f64; 3] = [300.0, 1e3, 3e3];
/// Seeds of the samples.
const SEEDS: [u64; 3] = [19, 20, 21];

struct Outcome {
    pressure: f64,
    ratio: f64,
    friction: f64,
    broken: f64,
    cluster: f64,
    interior: f64,
    slips: [f64; 2],
    regime: String,
}

fn main() -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build_global()?;
    let mut all: Vec<(f64, f64, u64)> = Vec::new();
    for p in PRESSURES {
        for r in RATIOS {
            all.extend(SEEDS.map(|seed| (p, r, seed)));
        }
    }
    let runs: Result<Vec<Outcome>, Failure> = all
        .par_iter()
        .map(|(p, r, seed)| one(*p, *r, *seed))
        .collect();
    let runs = runs?;
    println!(
        "| pressure | strength / pressure | regime, by seed | mu | broken | mean cluster | interior shear / V | slips / V |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for group in runs.chunks(SEEDS.len()) {
        let of = |value: &dyn Fn(&Outcome) -> f64| spread(group, value);
        let (friction, half) = of(&|o| o.friction);
        let mut regimes: Vec<&str> = group.iter().map(|o| o.regime.as_str()).collect();
        regimes.dedup();
        println!(
            "| {:.0} Pa | {} | {} | {friction:.3} +- {half:.3} | {:.2} | {:.0} | {:.2} | {:.2}, {:.2} |",
            group[0].pressure,
            group[0].ratio,
            regimes.join("; "),
            of(&|o| o.broken).0,
            of(&|o| o.cluster).0,
            of(&|o| o.interior).0,
            of(&|o| o.slips[0]).0,
            of(&|o| o.slips[1]).0
        );
    }
    let chart = |heading: &str, y: Axis, value: &dyn Fn(&Outcome) -> f64| {
        let x = Axis::new("bond strength / pressure", "").log();
        let floor = if y.log { 1.0 } else { f64::NEG_INFINITY };
        let mut chart = Chart::new(heading, x, y);
        let seeds = SEEDS.len();
        chart.subtitle = Some(format!(
            "Sheared layer of bonded grains, means and 95 % intervals of {seeds} seeds"
        ));
        for p in PRESSURES {
            let (mut points, mut bars) = (Vec::new(), Vec::new());
            for group in runs.chunks(seeds).filter(|g| g[0].pressure == p) {
                let (mean, half) = spread(group, value);
                points.push((group[0].ratio, mean));
                bars.push(((mean - half).max(floor), mean + half));
            }
            let series = Series::new(format!("p = {}", quantity(p, "Pa", 1)), points);
            chart = chart.with(series.style(Style::LineMarkers).intervals(bars));
        }
        chart
    };
    let charts = [
        chart("Friction", Axis::new("friction coefficient µ", ""), &|o| {
            o.friction
        }),
        chart(
            "Shear of the interior",
            Axis::new("[v(0.9 e) − v(0.1 e)]/V", ""),
            &|o| o.interior,
        ),
        chart(
            "Mean cluster by mass",
            Axis::new("grains in a cluster", "").log(),
            &|o| o.cluster,
        ),
    ];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/regime_map.png");
    draw_panels(&charts, 2, &path)?;
    println!("drawn to docs/figures/regime_map.png");
    Ok(())
}

/// Mean over the seeds, and half-width of its 95 % interval by Student's t.
fn spread(group: &[Outcome], value: &dyn Fn(&Outcome) -> f64) -> (f64, f64) {
    let n = group.len() as f64;
    let mean = group.iter().map(value).sum::<f64>() / n;
    let square: f64 = group.iter().map(|o| (value(o) - mean).powi(2)).sum();
    let t = StudentsT::new(0.0, 1.0, n - 1.0).map_or(f64::NAN, |t| t.inverse_cdf(0.975));
    (mean, t * (square / (n * (n - 1.0).max(1.0))).sqrt())
}

fn one(pressure: f64, ratio: f64, seed: u64) -> Result<Outcome, Failure> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/regime_map.ron");
    let strength = ratio * pressure;
    let sets = [
        format!("seed={seed}"),
        format!("interfaces.0.parameters.damage.strength={strength:e}"),
        format!(
            "interfaces.0.parameters.damage.energy={:e}",
            2e-5 * strength
        ),
        format!("bodies.1.dofs.y=Pressure(value: Constant({:e}))", -pressure),
        // Twice the case's step: bonds release 1.05 of their fracture energy, and friction scatters by more than it changes (docs/accuracy.md).
        "time.step=2e-4".to_owned(),
        "measures.0.every=4".to_owned(),
        "output=(frames: 0, views: 0, every: 5, figures: false)".to_owned(),
        "uncertainty.repeats=0".to_owned(),
    ];
    let loaded = load(&case, &sets)?;
    let built = loaded.build_in::<Dim2>(&SearchPath::new(&[]))?;
    let folder = format!(
        "fretwork-regime-{}-{pressure}-{ratio}-{seed}",
        std::process::id()
    );
    let out = std::env::temp_dir().join(folder);
    let options = RunOptions {
        out: out.clone(),
        threads: 1,
    };
    let summary = run(&loaded, built, &options, &mut |_| {})?;
    std::fs::remove_dir_all(out).ok();
    let found = |name: &str| {
        summary
            .measures
            .get(&format!("layer_{name}"))
            .copied()
            .unwrap_or(f64::NAN)
    };
    let regime = summary
        .findings
        .get("layer_regime")
        .map_or("", String::as_str);
    Ok(Outcome {
        pressure,
        ratio,
        friction: summary.friction_coefficient.unwrap_or(f64::NAN),
        broken: summary.damage_ratio,
        cluster: found("cluster_mean"),
        interior: found("interior_shear"),
        slips: [found("slip_first_share"), found("slip_second_share")],
        regime: regime.split(" (").next().unwrap_or("").to_owned(),
    })
}
