//! Regimes of a sheared layer of bonded grains, by the strength of the bonds and the pressure.
//!
//! `cargo run --release --example regime_map` runs `cases/regime_map.ron` for six strengths and three pressures, two at a
//! time, prints the table of `docs/circuit.md` and draws `docs/figures/regime_map.png`: friction and mean cluster against
//! strength over pressure. What walls and bonds do depends on that ratio; pressure alone changes the inertial number.

use fretwork::geometry::space::Plane;
use fretwork::laws::SearchPath;
use fretwork::record::run::{RunOptions, run};
use fretwork::report::{Axis, Chart, Series, Style, draw_panels};
use fretwork::scene::load;
use rayon::prelude::*;
use std::path::Path;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Strength of the bonds over the pressure.
const RATIOS: [f64; 6] = [0.1, 1.0, 10.0, 30.0, 100.0, 1000.0];
/// Pressures (Pa).
const PRESSURES: [f64; 3] = [300.0, 1e3, 3e3];

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
    let pairs: Vec<(f64, f64)> = PRESSURES
        .iter()
        .flat_map(|p| RATIOS.iter().map(move |r| (*p, *r)))
        .collect();
    let runs: Result<Vec<Outcome>, Failure> = pairs.par_iter().map(|(p, r)| one(*p, *r)).collect();
    let runs = runs?;
    println!(
        "| pressure | strength / pressure | regime | mu | broken | mean cluster | interior shear / V | slips / V |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for o in &runs {
        println!(
            "| {:.0} Pa | {} | {} | {:.3} | {:.2} | {:.0} | {:.2} | {:.2}, {:.2} |",
            o.pressure,
            o.ratio,
            o.regime,
            o.friction,
            o.broken,
            o.cluster,
            o.interior,
            o.slips[0],
            o.slips[1]
        );
    }
    let chart = |heading: &str, y: Axis, value: &dyn Fn(&Outcome) -> f64| {
        let x = Axis::new("bond strength over pressure", "").log();
        let mut chart = Chart::new(heading, x, y);
        for p in PRESSURES {
            let of = runs.iter().filter(|o| o.pressure == p);
            let points = of.map(|o| (o.ratio, value(o))).collect();
            let label = format!("{p:.0} Pa");
            chart = chart.with(Series::new(label, points).style(Style::LineMarkers));
        }
        chart
    };
    let charts = [
        chart("friction coefficient", Axis::new("mu", ""), &|o| o.friction),
        chart(
            "shear of the interior over V",
            Axis::new("w(0.9) - w(0.1)", ""),
            &|o| o.interior,
        ),
        chart(
            "mean cluster by mass",
            Axis::new("grains", "").log(),
            &|o| o.cluster,
        ),
    ];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/regime_map.png");
    draw_panels(&charts, 3, &path)?;
    println!("drawn to docs/figures/regime_map.png");
    Ok(())
}

fn one(pressure: f64, ratio: f64) -> Result<Outcome, Failure> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/regime_map.ron");
    let strength = ratio * pressure;
    let sets = [
        format!("interfaces.0.parameters.damage.strength={strength:e}"),
        format!(
            "interfaces.0.parameters.damage.energy={:e}",
            2e-5 * strength
        ),
        format!("bodies.1.dofs.y=Pressure(value: Constant({:e}))", -pressure),
        "output=(frames: 0, views: 0, every: 5, figures: false)".to_owned(),
    ];
    let loaded = load(&case, &sets)?;
    let built = loaded.build_in::<Plane>(&SearchPath::new(&[]))?;
    let folder = format!("fretwork-regime-{}-{pressure}-{ratio}", std::process::id());
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
