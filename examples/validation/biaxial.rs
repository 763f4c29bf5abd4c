//! Biaxial compression of disks: packing, peak and residual strength.

use crate::comparison::{Comparison, Failure, Found, Shown, markdown};
use crate::row::Row;
use crate::sample::{Estimate, difference};
use fretwork::report::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "biaxial",
    title: "Biaxial compression of disks",
    studies: &["biaxial"],
    show,
};

/// Published name, our column, what it is, digits.
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

fn show(found: &Found) -> Result<Shown, Failure> {
    let table = found.table("biaxial")?;
    let case = table
        .named("variant", "case")
        .ok_or("no run of the case is done")?;
    let fine = table.named("variant", "fine");
    let mut shown = Shown::default();
    let mut cells = Vec::new();
    let (mut ours, mut theirs_drawn) = ((Vec::new(), Vec::new()), (Vec::new(), Vec::new()));
    for (k, (name, column, what, digits)) in QUANTITIES.into_iter().enumerate() {
        let theirs = found.published.theirs(name, digits)?;
        let mean = case.mean(column);
        let off = Estimate {
            mean: mean.mean - theirs.value,
            ..mean
        };
        let finer = fine.as_ref().map(|f| f.mean(column));
        let change = finer.map(|f| difference(f, mean));
        shown
            .rows
            .push(Row::number(what, mean, off, change, &theirs));
        cells.push(vec![
            what.to_owned(),
            mean.text(digits),
            finer.map_or("not run".to_owned(), |f| f.text(digits)),
            case.runs
                .iter()
                .map(|r| format!("{:.digits$}", r.number(column)))
                .collect::<Vec<_>>()
                .join(", "),
        ]);
        let (x, by) = (k as f64 + 1.0, 1.0 / theirs.value);
        ours.0.push((x - 0.1, mean.mean * by));
        ours.1.push((mean.low() * by, mean.high() * by));
        theirs_drawn.0.push((x + 0.1, 1.0));
        theirs_drawn
            .1
            .push((1.0 - theirs.range * by, 1.0 + theirs.range * by));
    }
    shown.points = markdown(
        &[
            "quantity",
            "ours",
            "half the step, a quarter of the tolerance",
            "single runs",
        ],
        &cells,
    );
    let chart = Chart::new(
        "Biaxial compression, over the published middle",
        Axis::new(
            "1 compacity, 2 coordination, 3 peak q/p, 4 residual q/p",
            "",
        ),
        Axis::new("over the published middle", ""),
    )
    .with(
        Series::new("ours, 95 % of three seeds", ours.0)
            .style(Style::Markers)
            .intervals(ours.1),
    )
    .with(
        Series::new("independent DEM, range of three seeds", theirs_drawn.0)
            .style(Style::Markers)
            .intervals(theirs_drawn.1),
    );
    shown.charts = vec![Chart {
        x_range: Some((0.5, 4.5)),
        ..chart
    }];
    Ok(shown)
}
