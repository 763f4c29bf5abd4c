//! Disks that attract each other, in plane shear: friction and solid fraction by inertial and cohesion number.

use crate::comparison::{Comparison, Failure, Found, Shown, markdown};
use crate::row::Row;
use crate::sample::{Estimate, difference, line};
use crate::table::{Run, Setting};
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
/// Inertial number below which the middle of the layer counts as a plug.
const SHEARED: f64 = 0.02;

fn show(found: &Found) -> Result<Shown, Failure> {
    let table = found.table("cohesive_shear")?;
    // Without cohesion: the points of plane shear at the same velocities.
    let plain = found.table("plane_shear")?.settings(|r| {
        let same = [0.22, 0.78, COMMON].contains(&r.number("velocity"));
        let usual = r.number("tolerance") == 1e-3 && r.number("restitution") == 0.0;
        same && usual && r.number("mu") == 0.4
    });
    let usual = |r: &Run| r.number("tolerance") == 1e-3 && r.number("range") == 1e-4;
    let cohesive = table.settings(usual);
    let case: Vec<Setting> = plain.into_iter().chain(cohesive).collect();
    let common: Vec<&Setting> = case
        .iter()
        .filter(|s| s.factor("velocity") == COMMON)
        .collect();
    let at = |eta: f64| common.iter().find(|s| eta_of(s) == eta).copied();
    // Where the layer moves as a plug between slipping walls, there is no shear to compare.
    let sheared = common.iter().filter(|s| s.mean(I).mean > SHEARED);
    let strongest = sheared.map(|s| eta_of(s)).fold(0.0, f64::max);
    let (Some(none), Some(weak), Some(strong)) = (at(0.0), at(1.0), at(strongest)) else {
        return Err("the cohesion numbers 0 and 1 are not both done".into());
    };
    let mut shown = Shown::default();
    let varied = table.settings(|r| !usual(r));
    let fine = varied.iter().find(|s| s.factor("tolerance") < 1e-3);
    let change = fine.and_then(|f| {
        let coarse = at(eta_of(f))?;
        let whole = coarse.mean(MU).mean;
        let (mu, phi) = (
            difference(f.mean(MU), coarse.mean(MU)),
            difference(f.mean(PHI), coarse.mean(PHI)),
        );
        Some((mu.percent(whole), phi.percent(coarse.mean(PHI).mean)))
    });
    let (of_mu, of_phi) = change.unzip();
    // Over the value without cohesion at the same inertial number, from the straight line through its points.
    let share = |s: &Setting, column: &str| {
        let bare = |s: &&Setting| eta_of(s) == 0.0;
        let points: Vec<(f64, f64)> = case
            .iter()
            .filter(bare)
            .map(|s| (s.mean(I).mean, s.mean(column).mean))
            .collect();
        let (start, slope) = line(&points);
        let plain = start + slope * s.mean(I).mean;
        let half = s.mean(column).half.hypot(none.mean(column).half);
        Estimate {
            mean: 100.0 * (s.mean(column).mean / plain - 1.0),
            half: 100.0 * half / plain,
        }
    };
    let percent = |e: Estimate| format!("{:+.1} ± {:.1} %", e.mean, e.half);
    let rise = share(strong, MU);
    shown.rows.push(Row::statement(
        format!("friction at η = {strongest}, over that without cohesion"),
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
    for (s, eta) in [(weak, 1.0), (strong, strongest)] {
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
        .chain(&varied)
        .map(|s| {
            vec![
                format!("{}", eta_of(s)),
                format!("{}", s.factor("velocity")),
                match (s.factor("tolerance") < 1e-3, s.factor("range") < 1e-4) {
                    (true, _) => "half the step, a tenth of the tolerance".to_owned(),
                    (_, true) => "attraction to a gap of 1/800 of a diameter".to_owned(),
                    _ => String::new(),
                },
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
            "changed",
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
