//! Wet spheres in plane shear: whether a constant cohesion adds to the dry friction.

use crate::comparison::{Comparison, Failure, Found, Shown, markdown};
use crate::row::Row;
use crate::sample::{Estimate, line};
use fretwork::report::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "wet_spheres",
    title: "Wet spheres",
    studies: &["wet_spheres"],
    show,
};

const MU: &str = "measures.bulk_mu";
/// Largest 1/P* of the published range.
const LIMIT: f64 = 0.5;

fn show(found: &Found) -> Result<Shown, Failure> {
    let table = found.table("wet_spheres")?;
    let settings = table.settings(|_| true);
    let points: Vec<(f64, f64)> = settings
        .iter()
        .map(|s| (s.factor("cohesion"), s.mean(MU).mean))
        .collect();
    let within: Vec<(f64, f64)> = points.iter().copied().filter(|p| p.0 <= LIMIT).collect();
    if within.len() < 3 {
        return Err("fewer than three pressures are done".into());
    }
    let (dry, slope) = line(&within);
    let off: Vec<Estimate> = settings
        .iter()
        .map(|s| {
            let mu = s.mean(MU);
            Estimate {
                mean: mu.mean - dry - slope * s.factor("cohesion"),
                ..mu
            }
        })
        .collect();
    let worst = off
        .iter()
        .zip(&points)
        .filter(|(_, p)| p.0 <= LIMIT)
        .map(|(e, _)| e.mean.abs())
        .fold(0.0, f64::max);
    let half = off
        .iter()
        .zip(&points)
        .filter(|(_, p)| p.0 <= LIMIT)
        .map(|(e, _)| e.half)
        .fold(0.0, f64::max);
    let mut shown = Shown::default();
    shown.rows.push(Row::statement(
        "friction for P* ≥ 2, τ/σ = µ* + c*/P*",
        format!(
            "µ* = {dry:.3}, c* = {slope:.3}; farthest point {:.1} %, interval of a point {:.1} %",
            100.0 * worst / dry,
            100.0 * half / dry
        ),
        None,
        "linear: constant cohesion c* F0/a²",
        (half < 0.1 * dry).then_some(worst <= half.max(0.02 * dry)),
    ));
    if let Some((e, p)) = off.iter().zip(&points).find(|(_, p)| p.0 > LIMIT) {
        shown.rows.push(Row::statement(
            format!("friction at P* = {}, from that line", 1.0 / p.0),
            e.percent(dry + slope * p.0),
            None,
            "the line holds for P* ≥ 2 only",
            (e.mean.abs() > e.half).then_some(true),
        ));
    }
    let cells: Vec<Vec<String>> = settings
        .iter()
        .zip(&off)
        .map(|(s, e)| {
            let inverse = s.factor("cohesion");
            vec![
                if inverse > 0.0 {
                    format!("{:.2}", 1.0 / inverse)
                } else {
                    "dry".to_owned()
                },
                s.mean(MU).text(3),
                e.percent(dry + slope * inverse),
                s.mean("measures.bulk_phi").text(4),
                s.mean("measures.bulk_I").text(4),
            ]
        })
        .collect();
    shown.points = markdown(
        &[
            "P*",
            "τ/σ",
            "from the line for P* ≥ 2",
            "solid fraction",
            "I",
        ],
        &cells,
    );
    let bars = settings
        .iter()
        .map(|s| (s.mean(MU).low(), s.mean(MU).high()))
        .collect();
    shown.charts = vec![
        Chart::new(
            "Wet spheres",
            Axis::new("1/P* = F0/(a² σ)", ""),
            Axis::new("friction coefficient τ/σ", ""),
        )
        .with(
            Series::new("ours, 95 % of three seeds", points)
                .style(Style::Markers)
                .intervals(bars),
        )
        .with(Series::new(
            "constant cohesion, P* ≥ 2 (Badetti et al. 2018)",
            vec![(0.0, dry), (LIMIT, dry + slope * LIMIT)],
        )),
    ];
    Ok(shown)
}
