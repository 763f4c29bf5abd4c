//! A third body fed by a rail: balance of its mass, and friction from dissipation.

use crate::comparison::{Comparison, Failure, Found, Shown, markdown};
use crate::row::Row;
use crate::sample::Estimate;
use crate::table::Setting;
use fretwork::report::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "third_body",
    title: "Balance of a third body",
    studies: &["third_body"],
    show,
};

fn show(found: &Found) -> Result<Shown, Failure> {
    let table = found.table("third_body")?;
    let case = table
        .named("variant", "case")
        .ok_or("no run of the case is done")?;
    let fine = table.named("variant", "fine");
    let rate = |flow: &str| format!("circuit.rates.{flow}.mean");
    let over_source =
        |s: &Setting, flow: &str| s.over(|r| r.number(&rate(flow)) / r.number(&rate("Qs")));
    let mut shown = Shown::default();
    // A share of Qs known to no better than a half of it decides nothing.
    let zero = |e: Estimate| {
        (e.mean.abs() > e.half)
            .then_some(false)
            .or((e.half < 0.5).then_some(true))
    };
    let mut statement = |what: &str, flow: &str, published: &str| {
        let e = over_source(&case, flow);
        let numerical = fine
            .as_ref()
            .map(|f| format!("with half the step {}", over_source(f, flow).text(2)));
        shown.rows.push(Row::statement(
            what,
            e.text(2),
            numerical,
            published,
            zero(e),
        ));
    };
    statement(
        "(source flow less wear flow)/source flow",
        "Qs_less_Qw",
        "0: the flows are equal",
    );
    statement(
        "rate of the mass in the contact/source flow",
        "M",
        "0: the mass is steady",
    );
    let gap = case
        .over(|r| r.number("friction_from_dissipation") / r.number("friction_coefficient") - 1.0);
    shown.rows.push(Row::statement(
        "dissipated power over load and speed, over friction, less 1",
        format!("{:.1e}", gap.mean),
        None,
        "0: equal",
        Some(gap.mean.abs() < 0.01),
    ));
    let variants = [Some(&case), fine.as_ref()];
    let cells: Vec<Vec<String>> = variants
        .into_iter()
        .flatten()
        .flat_map(|s| &s.runs)
        .map(|r| {
            let e = |name: &str| format!("{:.2e}", r.number(name));
            vec![
                if r.text("variant") == "case" {
                    "of the case"
                } else {
                    "half"
                }
                .to_owned(),
                r.text("seed").to_owned(),
                e(&rate("Qs")),
                e(&rate("Qw")),
                format!(
                    "{} ± {}",
                    e(&rate("Qs_less_Qw")),
                    e("circuit.rates.Qs_less_Qw.half_width")
                ),
                format!("{} ± {}", e(&rate("M")), e("circuit.rates.M.half_width")),
                format!("{:.3}", r.number("friction_coefficient")),
                format!("{:.3}", r.number("friction_from_dissipation")),
            ]
        })
        .collect();
    shown.points = markdown(
        &[
            "step",
            "seed",
            "Qs, kg/(m s)",
            "Qw",
            "Qs - Qw",
            "dM/dt",
            "friction",
            "from dissipation",
        ],
        &cells,
    );
    let flows: Vec<_> = variants
        .into_iter()
        .flatten()
        .zip(["ours", "ours, half the step"])
        .map(|(s, label)| {
            let points = s
                .runs
                .iter()
                .map(|r| (r.number(&rate("Qs")), r.number(&rate("Qw"))))
                .collect();
            let bars = s
                .runs
                .iter()
                .map(|r| {
                    let (w, h) = (
                        r.number(&rate("Qw")),
                        r.number("circuit.rates.Qs_less_Qw.half_width"),
                    );
                    (w - h, w + h)
                })
                .collect();
            Series::new(label, points)
                .style(Style::Markers)
                .intervals(bars)
        })
        .collect();
    let largest = table
        .runs
        .iter()
        .map(|r| r.number(&rate("Qs")))
        .fold(0.0, f64::max);
    let mut chart = Chart::new(
        "Wear flow against source flow",
        Axis::new("source flow Qs", "kg/(m s)"),
        Axis::new("wear flow Qw", "kg/(m s)"),
    );
    for series in flows {
        chart = chart.with(series);
    }
    let equal = vec![(0.0, 0.0), (1.1 * largest, 1.1 * largest)];
    shown.charts = vec![
        chart.with(Series::new("equal flows (Fillot et al. 2007)", equal).style(Style::Dashed)),
    ];
    Ok(shown)
}
