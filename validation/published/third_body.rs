//! A third body fed by a rail: balance of its mass, and friction from dissipation.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Row, judge};
use crate::table::Setting;
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "third_body",
    title: "Balance of a third body",
    studies: &["third_body"],
    published: true,
    show,
};

const COLUMNS: [&str; 8] = [
    "circuit.rates.Qs.mean",
    "circuit.rates.Qw.mean",
    "circuit.rates.Qs_less_Qw.mean",
    "circuit.rates.Qs_less_Qw.half_width",
    "circuit.rates.M.mean",
    "circuit.rates.M.half_width",
    "friction_coefficient",
    "friction_from_dissipation",
];

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("third_body", &COLUMNS)?;
    let case = table
        .named("variant", "case")
        .ok_or("no run of the case is done")?;
    let fine = table.named("variant", "fine");
    let rate = |flow: &str| format!("circuit.rates.{flow}.mean");
    let imbalance = |s: &Setting| s.over(|r| r.number(&rate("Qs_less_Qw")) / r.number(&rate("Qs")));
    let finer = fine.as_ref().map(imbalance);
    let mut results = Results::default();
    results.rows.push(Row::statement(
        "(source flow less wear flow)/source flow",
        imbalance(&case).text(2),
        finer.map(|f| format!("with half the step {}", f.text(2))),
        "0: the flows are equal, so that the mass is steady",
        Some(judge(finer.unwrap_or(imbalance(&case)), 0.0, 1.0)),
    ));
    let gap = case
        .over(|r| r.number("friction_from_dissipation") / r.number("friction_coefficient") - 1.0);
    results.rows.push(Row::statement(
        "dissipated power over load and speed, over friction, less 1",
        format!("{:.1e}", gap.mean),
        None,
        "0: equal",
        // An identity of the program.
        None,
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
    results.points = markdown(
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
    results.charts = vec![
        chart.with(Series::new("equal flows (Fillot et al. 2007)", equal).style(Style::Dashed)),
    ];
    Ok(results)
}
