//! Disks that attract each other, in plane shear: friction and solid fraction by inertial and cohesion number.

use crate::comparison::{Comparison, Failure, Found, Shown, markdown};
use crate::row::Row;
use crate::sample::{Estimate, difference, line};
use crate::table::Setting;
use fretwork::report::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "cohesive_shear",
    title: "Plane shear of cohesive disks",
    studies: &["cohesive_shear", "plane_shear"],
    show,
};

const MU: &str = "measures.bulk_mu";
const I: &str = "measures.bulk_I";
const PHI: &str = "measures.bulk_phi";
/// Velocity of the wall at which all cohesion numbers are compared (m/s).
const COMMON: f64 = 1.75;

fn show(found: &Found) -> Result<Shown, Failure> {
    let table = found.table("cohesive_shear")?;
    // Without cohesion: the points of plane shear at the same velocities.
    let plain = found.table("plane_shear")?.settings(|r| {
        let same = [0.22, 0.78, COMMON].contains(&r.number("velocity"));
        same && r.number("mu") == 0.4 && r.number("tolerance") == 1e-3
    });
    let cohesive = table.settings(|r| r.number("tolerance") == 1e-3);
    let case: Vec<Setting> = plain.into_iter().chain(cohesive).collect();
    let common: Vec<&Setting> = case
        .iter()
        .filter(|s| s.factor("velocity") == COMMON)
        .collect();
    let at = |eta: f64| common.iter().find(|s| eta_of(s) == eta).copied();
    let (Some(none), Some(weak), Some(strong)) = (at(0.0), at(1.0), at(30.0)) else {
        return Err("the cohesion numbers 0, 1 and 30 are not all done".into());
    };
    let mut shown = Shown::default();
    let fine = table.settings(|r| r.number("tolerance") < 1e-3);
    let change = fine.first().and_then(|f| {
        let coarse = at(eta_of(f))?;
        let whole = coarse.mean(MU).mean;
        let (mu, phi) = (
            difference(f.mean(MU), coarse.mean(MU)),
            difference(f.mean(PHI), coarse.mean(PHI)),
        );
        Some((mu.percent(whole), phi.percent(coarse.mean(PHI).mean)))
    });
    let (of_mu, of_phi) = change.unzip();
    // Shares of the value without cohesion.
    let share = |s: &Setting, column: &str| {
        let (a, b) = (s.mean(column), none.mean(column));
        let d = difference(a, b);
        Estimate {
            mean: 100.0 * d.mean / b.mean,
            half: 100.0 * d.half / b.mean,
        }
    };
    let percent = |e: Estimate| format!("{:+.1} ± {:.1} %", e.mean, e.half);
    let rise = share(strong, MU);
    shown.rows.push(Row::statement(
        "friction at η = 30, over that without cohesion",
        percent(rise),
        of_mu.clone(),
        "strong increase above a threshold of η",
        Some(rise.low() > 20.0),
    ));
    let early = share(weak, MU);
    shown.rows.push(Row::statement(
        "friction at η = 1, over that without cohesion",
        percent(early),
        of_mu.clone(),
        "unchanged by weak cohesion",
        (early.half < 10.0).then_some(early.mean.abs() <= early.half.max(5.0)),
    ));
    for (s, eta) in [(weak, 1), (strong, 30)] {
        let d = share(s, PHI);
        shown.rows.push(Row::statement(
            format!("solid fraction at η = {eta}, over that without cohesion"),
            percent(d),
            of_phi.clone(),
            "the material expands",
            if d.high() < 0.0 {
                Some(true)
            } else if d.low() > 0.0 {
                Some(false)
            } else {
                None
            },
        ));
    }
    for eta in [0.0, 10.0] {
        let of: Vec<&Setting> = case.iter().filter(|s| eta_of(s) == eta).collect();
        for (what, column) in [("friction", MU), ("solid fraction", PHI)] {
            let points: Vec<(f64, f64)> = of
                .iter()
                .map(|s| (s.mean(I).mean, s.mean(column).mean))
                .collect();
            if points.len() < 3 {
                continue;
            }
            let (a, b) = line(&points);
            let off = points
                .iter()
                .map(|p| (p.1 - a - b * p.0).abs())
                .fold(0.0, f64::max);
            let half = of.iter().map(|s| s.mean(column).half).fold(0.0, f64::max);
            let middle = points[points.len() / 2].1;
            shown.rows.push(Row::statement(
                format!(
                    "{what} at η = {eta} from I = {:.3} to {:.3}",
                    points[0].0,
                    points[points.len() - 1].0
                ),
                format!(
                    "{a:.3} {} {:.3} I; farthest point {:.1} %, interval of a point {:.1} %",
                    if b < 0.0 { '-' } else { '+' },
                    b.abs(),
                    100.0 * off / middle,
                    100.0 * half / middle
                ),
                if column == MU {
                    of_mu.clone()
                } else {
                    of_phi.clone()
                },
                "linear in I",
                (half < 0.1 * middle).then_some(off <= half.max(0.02 * middle)),
            ));
        }
    }
    let cells: Vec<Vec<String>> = case
        .iter()
        .chain(&fine)
        .map(|s| {
            vec![
                format!("{}", eta_of(s)),
                format!("{}", s.factor("velocity")),
                if s.factor("tolerance") < 1e-3 {
                    "half the step, a tenth of the tolerance"
                } else {
                    ""
                }
                .to_owned(),
                s.mean(I).text(4),
                s.mean(MU).text(3),
                s.mean(PHI).text(4),
                s.mean("measures.core_mu").text(3),
            ]
        })
        .collect();
    shown.points = markdown(
        &[
            "η",
            "wall, m/s",
            "",
            "I",
            "friction",
            "solid fraction",
            "friction, middle of the layer",
        ],
        &cells,
    );
    let chart = |title: &str, y: &str, column: &str| {
        let mut chart = Chart::new(title, Axis::new("inertial number I", ""), Axis::new(y, ""));
        for eta in [0.0, 1.0, 3.0, 10.0, 30.0] {
            let of: Vec<&Setting> = case.iter().filter(|s| eta_of(s) == eta).collect();
            let points = of
                .iter()
                .map(|s| (s.mean(I).mean, s.mean(column).mean))
                .collect();
            let bars = of
                .iter()
                .map(|s| (s.mean(column).low(), s.mean(column).high()))
                .collect();
            chart = chart.with(
                Series::new(format!("ours, η = {eta}"), points)
                    .style(Style::LineMarkers)
                    .intervals(bars),
            );
        }
        chart
    };
    shown.charts = vec![
        chart("Friction of cohesive disks", "friction coefficient τ/p", MU),
        chart("Solid fraction of cohesive disks", "solid fraction φ", PHI),
    ];
    Ok(shown)
}

/// Cohesion number; plane shear has none.
fn eta_of(s: &Setting) -> f64 {
    let eta = s.factor("eta");
    if eta.is_nan() { 0.0 } else { eta }
}
