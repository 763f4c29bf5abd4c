//! Biaxial compression of disks: packing, peak and residual strength.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Finer, Row};
use crate::sample::{Estimate, difference};
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "biaxial",
    title: "Biaxial compression of disks",
    studies: &["biaxial"],
    published: false,
    show,
};

/// Name in `validation/biaxial.csv`, our column, label, and digits.
const QUANTITIES: [(&str, &str, &str, usize); 4] = [
    (
        "compacity",
        "biaxial.compacity_start",
        "compacity before the test",
        4,
    ),
    (
        "coordination",
        "biaxial.coordination_carried_start",
        "coordination without rattlers",
        3,
    ),
    ("peak", "biaxial.peak_ratio", "peak of q/p", 3),
    ("residual", "biaxial.residual_ratio", "residual q/p", 3),
];

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("biaxial", &QUANTITIES.map(|q| q.1))?;
    let case = table
        .named("variant", "case")
        .ok_or("no run of the case is done")?;
    let fine = table.named("variant", "fine");
    let mut results = Results::default();
    let mut cells = Vec::new();
    let (mut ours, mut reference_drawn) = ((Vec::new(), Vec::new()), (Vec::new(), Vec::new()));
    for (k, (name, column, what, digits)) in QUANTITIES.into_iter().enumerate() {
        let reference = inputs.published.reference(name, digits)?;
        let mean = case.mean(column);
        let off = |e: Estimate| difference(e, Estimate::certain(reference.value));
        let fine_mean = fine.as_ref().map(|f| f.mean(column));
        let finer = fine_mean.map(|f| Finer {
            change: difference(f, mean),
            difference: Some(off(f)),
        });
        results
            .rows
            .push(Row::number(what, mean, off(mean), finer, &reference));
        cells.push(vec![
            what.to_owned(),
            mean.text(digits),
            fine_mean.map_or("not run".to_owned(), |f| f.text(digits)),
            case.runs
                .iter()
                .map(|r| format!("{:.digits$}", r.number(column)))
                .collect::<Vec<_>>()
                .join(", "),
        ]);
        let (x, by) = (k as f64 + 1.0, 1.0 / reference.value);
        ours.0.push((x - 0.1, mean.mean * by));
        ours.1.push((mean.low() * by, mean.high() * by));
        reference_drawn.0.push((x + 0.1, 1.0));
        reference_drawn
            .1
            .push((1.0 - reference.range * by, 1.0 + reference.range * by));
    }
    results.points = markdown(
        &[
            "quantity",
            "ours",
            "half the step, a quarter of the tolerance",
            "single runs",
        ],
        &cells,
    );
    let chart = Chart::new(
        "Biaxial compression, over the middle of the DEM",
        Axis::new(
            "1 compacity, 2 coordination, 3 peak q/p, 4 residual q/p",
            "",
        ),
        Axis::new("over the middle of the DEM", ""),
    )
    .with(
        Series::new("ours, 95 % of three seeds", ours.0)
            .style(Style::Markers)
            .intervals(ours.1),
    )
    .with(
        Series::new("independent DEM, range of three seeds", reference_drawn.0)
            .style(Style::Markers)
            .intervals(reference_drawn.1),
    );
    results.charts = vec![Chart {
        x_range: Some((0.5, 4.5)),
        ..chart
    }];
    Ok(results)
}
