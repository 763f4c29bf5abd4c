//! Wet spheres in plane shear: whether a constant cohesion adds to the dry friction.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Row, judge};
use crate::sample::{Estimate, Line, difference};
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "wet_spheres",
    title: "Wet spheres",
    studies: &["wet_spheres"],
    published: true,
    show,
};

const MU: &str = "measures.bulk_mu";
const PHI: &str = "measures.bulk_phi";
const I: &str = "measures.bulk_I";
/// Largest 1/P* of the published range.
const LIMIT: f64 = 0.5;

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("wet_spheres", &["cohesion", MU, PHI, I])?;
    let settings = table.settings(|_| true);
    let points: Vec<(f64, Estimate)> = settings
        .iter()
        .map(|s| (s.factor("cohesion"), s.mean(MU)))
        .collect();
    let within: Vec<(Estimate, Estimate)> = points
        .iter()
        .filter(|p| p.0 <= LIMIT)
        .map(|p| (Estimate::certain(p.0), p.1))
        .collect();
    if within.len() < 3 {
        return Err("fewer than three pressures with P* ≥ 2 are done".into());
    }
    let line = Line::through(&within);
    let (dry, slope) = (line.intercept, line.slope);
    // A point of the line is not independent of it; one beyond has the error of the line too.
    let off = |x: f64, mu: Estimate| {
        let half = if x <= LIMIT { 0.0 } else { line.half_at(x) };
        let expected = Estimate {
            mean: line.at(x),
            half,
        };
        difference(mu, expected)
    };
    let mut results = Results::default();
    let of_line = points.iter().filter(|p| p.0 <= LIMIT);
    let judgements = of_line
        .clone()
        .map(|p| judge(off(p.0, p.1), 0.0, line.at(p.0)));
    let farthest = of_line
        .max_by(|a, b| {
            let far = |p: &(f64, Estimate)| off(p.0, p.1).mean.abs();
            far(a).total_cmp(&far(b))
        })
        .ok_or("no point is done")?;
    results.rows.push(Row::statement(
        "friction for P* ≥ 2, τ/σ = µ* + c*/P*",
        format!(
            "µ* = {dry:.3}, c* = {slope:.3}; farthest point {}",
            off(farthest.0, farthest.1).percent(line.at(farthest.0))
        ),
        None,
        "linear: constant cohesion c* F0/a²",
        judgements.max(),
    ));
    if let Some((x, mu)) = points.iter().find(|p| p.0 > LIMIT) {
        results.rows.push(Row::statement(
            format!("friction at P* = {}, from that line", 1.0 / x),
            off(*x, *mu).percent(line.at(*x)),
            None,
            "nothing: the line is stated for P* ≥ 2",
            None,
        ));
    }
    let cells: Vec<Vec<String>> = settings
        .iter()
        .map(|s| {
            let inverse = s.factor("cohesion");
            vec![
                if inverse > 0.0 {
                    format!("{:.2}", 1.0 / inverse)
                } else {
                    "dry".to_owned()
                },
                s.mean(MU).text(3),
                off(inverse, s.mean(MU)).percent(line.at(inverse)),
                s.mean(PHI).text(4),
                s.mean(I).text(4),
            ]
        })
        .collect();
    results.points = markdown(
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
    results.charts = vec![
        Chart::new(
            "Wet spheres",
            Axis::new("1/P* = F0/(a² σ)", ""),
            Axis::new("friction coefficient τ/σ", ""),
        )
        .with(
            Series::new(
                "ours, 95 % of three seeds",
                points.iter().map(|p| (p.0, p.1.mean)).collect(),
            )
            .style(Style::Markers)
            .intervals(bars),
        )
        .with(Series::new(
            "constant cohesion, P* ≥ 2 (Badetti et al. 2018)",
            vec![(0.0, dry), (LIMIT, dry + slope * LIMIT)],
        )),
    ];
    Ok(results)
}
