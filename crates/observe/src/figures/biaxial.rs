//! Figure of a biaxial test: four panels against axial strain.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use crate::statistics::Table;

/// `biaxial.png`: the stress ratio, the volumetric strain, the coordination and the compacity against axial strain,
/// from the start of the test (s) on.
pub(crate) fn charts(title: &str, table: &Table, start: f64) -> Output {
    let time = table.column("time");
    let first = time
        .partition_point(|t| *t <= start * (1.0 + 1e-9))
        .saturating_sub(1);
    let strain = table.column("axial_strain");
    let against = |name: &str| -> Vec<(f64, f64)> {
        let values = table.column(name);
        let pairs = strain.iter().copied().zip(values);
        pairs.skip(first).collect()
    };
    let chart = |heading: &str, y: &str| {
        let mut chart = Chart::new(heading, Axis::new("axial strain ε_1", ""), Axis::new(y, ""));
        chart.subtitle = Some(title.to_owned());
        chart
    };
    let ratio = chart("Stress ratio", "q/p = sin φ")
        .with(Series::new("q/p from the walls", against("q_over_p")))
        .with(Series::new("sin φ from the contacts", against("sin_phi")).style(Style::Dashed));
    let volume = chart(
        "Volumetric strain, expansion positive",
        "volumetric strain ε_v",
    )
    .with(Series::new(String::new(), against("volumetric_strain")));
    let neighbours = chart(
        "Coordination, contacts that carry force",
        "coordination number Z",
    )
    .with(Series::new("all grains", against("coordination")))
    .with(Series::new("without rattlers", against("coordination_carried")).style(Style::Dashed));
    let compacity = chart("Solid fraction", "solid fraction φ")
        .with(Series::new(String::new(), against("compacity")));
    let panels = [ratio, volume, neighbours, compacity];
    Output::charts("biaxial.png".into(), panels, 2)
}
