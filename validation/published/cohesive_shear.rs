//! Disks that attract each other, in plane shear: friction and solid fraction by inertial and
//! cohesion number.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Finer, Row, Verdict, judge, judged, rises};
use crate::sample::{Estimate, Line, difference};
use crate::table::{Run, Setting};
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "cohesive_shear",
    title: "Plane shear of cohesive disks",
    studies: &["cohesive_shear", "plane_shear"],
    published: true,
    show,
};

const MU: &str = "measures.bulk_mu";
const I: &str = "measures.bulk_I";
const PHI: &str = "measures.bulk_phi";
/// Velocity of the wall at which all cohesion numbers are compared (m/s).
const COMMON: f64 = 1.75;
/// Published cohesion number above which friction rises.
const THRESHOLD: f64 = 10.0;
/// Inertial number below which the layer counts as a plug between slipping walls.
const SHEARED: f64 = 0.02;
const CORE: &str = "measures.core_mu";
const COLUMNS: [&str; 7] = ["velocity", "step", "tolerance", MU, I, PHI, CORE];

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("cohesive_shear", &COLUMNS)?;
    table.require(&["eta", "range"])?;
    // The points of plane shear at these velocities are the values without cohesion.
    let plain = inputs.table("plane_shear", &COLUMNS)?;
    plain.require(&["restitution", "mu"])?;
    let plain = plain.settings(|r| {
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
    if at(0.0).is_none() || common.len() < 2 {
        return Err("the cohesion number 0 and one above are not both done".into());
    }
    let mut results = Results::default();
    let varied = table.settings(|r| !usual(r));
    let fine = varied.iter().find(|s| s.factor("tolerance") < 1e-3);
    // The relative change from the value without cohesion, which the straight line through its
    // points gives at this inertial number.
    let share = |s: &Setting, column: &str| {
        let without = case.iter().filter(|s| eta_of(s) == 0.0);
        let points: Vec<_> = without.map(|s| (s.mean(I), s.mean(column))).collect();
        let line = Line::through(&points);
        let ratio = s.over(|r| r.number(column) / line.at(r.number(I)));
        let i = s.mean(I).mean;
        let of_line = Estimate {
            mean: -1.0,
            half: ratio.mean * line.half_at(i) / line.at(i),
        };
        ratio.plus(of_line)
    };
    let finer = |s: &Setting, column: &str| -> Option<Finer> {
        let fine = fine?;
        let coarse = at(eta_of(fine))?;
        Some(Finer {
            change: difference(share(fine, column), share(coarse, column)),
            difference: (eta_of(s) == eta_of(fine)).then(|| share(fine, column)),
        })
    };
    let plug = |s: &Setting| s.mean(I).mean < SHEARED;
    for s in common.iter().filter(|s| eta_of(s) > 0.0) {
        let eta = eta_of(s);
        let change = share(s, MU);
        let of_finer = finer(s, MU);
        let off = judged(change, of_finer);
        let (published, verdict) = if eta < THRESHOLD {
            ("unchanged below η of about 10", judge(off, 0.0, 1.0))
        } else if plug(s) {
            ("rises above η of about 10", Verdict::Undecided)
        } else {
            ("rises above η of about 10", rises(off))
        };
        let moves = if plug(s) {
            format!(": a plug, I = {:.4}", s.mean(I).mean)
        } else {
            String::new()
        };
        results.rows.push(Row::statement(
            format!("friction at η = {eta}, over that without cohesion"),
            change.percent(1.0) + &moves,
            of_finer.map(|f| f.change.percent(1.0)),
            published,
            Some(verdict),
        ));
    }
    for s in common.iter().filter(|s| eta_of(s) > 0.0 && !plug(s)) {
        let change = share(s, PHI);
        let of_finer = finer(s, PHI);
        results.rows.push(Row::statement(
            format!(
                "solid fraction at η = {}, over that without cohesion",
                eta_of(s)
            ),
            change.percent(1.0),
            of_finer.map(|f| f.change.percent(1.0)),
            "falls: the material expands",
            Some(rises(judged(change, of_finer).scaled(-1.0))),
        ));
    }
    for eta in [0.0, THRESHOLD] {
        let of: Vec<&Setting> = case.iter().filter(|s| eta_of(s) == eta).collect();
        if of.len() < 3 || of.iter().any(|s| plug(s) && eta > 0.0) {
            continue;
        }
        for (what, column) in [("friction", MU), ("solid fraction", PHI)] {
            let points: Vec<_> = of.iter().map(|s| (s.mean(I), s.mean(column))).collect();
            let line = Line::through(&points);
            let off = |p: &(Estimate, Estimate)| Estimate {
                mean: p.1.mean - line.at(p.0.mean),
                half: p.1.half.hypot(line.slope * p.0.half),
            };
            let middle = points[points.len() / 2].1.mean;
            let far = |p: &(Estimate, Estimate)| off(p).mean.abs();
            let farthest = points.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
            results.rows.push(Row::statement(
                format!(
                    "{what} at η = {eta} from I = {:.3} to {:.3}",
                    points[0].0.mean,
                    points[points.len() - 1].0.mean
                ),
                format!(
                    "{:.3} {} {:.3} I; farthest point {}",
                    line.intercept,
                    if line.slope < 0.0 { '-' } else { '+' },
                    line.slope.abs(),
                    farthest.map_or(String::new(), |p| off(p).percent(middle))
                ),
                None,
                "linear in I",
                points.iter().map(|p| judge(off(p), 0.0, middle)).max(),
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
                match (
                    s.factor("tolerance") < 1e-3,
                    s.runs[0].optional("range").is_some_and(|r| r < 1e-4),
                ) {
                    (true, _) => "half the step, a tenth of the tolerance".to_owned(),
                    (_, true) => "attraction to a gap of 1/800 of a diameter".to_owned(),
                    _ => String::new(),
                },
                s.mean(I).text(4),
                s.mean(MU).text(3),
                s.mean(PHI).text(4),
                s.mean(CORE).text(3),
                not_trustworthy(s),
            ]
        })
        .collect();
    results.points = markdown(
        &[
            "η",
            "wall, m/s",
            "changed",
            "I",
            "friction",
            "solid fraction",
            "friction, middle of the layer",
            "not trustworthy",
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
    results.charts = vec![
        chart("Friction of cohesive disks", "friction coefficient τ/p", MU),
        chart("Solid fraction of cohesive disks", "solid fraction φ", PHI),
    ];
    Ok(results)
}

/// Cohesion number; plane shear has none.
fn eta_of(s: &Setting) -> f64 {
    s.runs[0].optional("eta").unwrap_or(0.0)
}

/// Returns the reasons why runs are not trustworthy, with the number of runs.
fn not_trustworthy(s: &Setting) -> String {
    let said: Vec<&str> = s.runs.iter().map(|r| r.text("not_trustworthy")).collect();
    let mut kinds: Vec<&str> = said.iter().copied().filter(|t| !t.is_empty()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let count = |kind: &str| said.iter().filter(|t| **t == kind).count();
    let texts = kinds
        .iter()
        .map(|k| format!("{k} ({} of {} runs)", count(k), said.len()));
    texts.collect::<Vec<_>>().join(", ")
}
