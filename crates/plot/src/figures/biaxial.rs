//! Figure of a biaxial test: four panels against axial strain.

use crate::{ReportError, draw_panels};
use fretwork_observe::chart::{Axis, Chart, Series, Style};
use fretwork_observe::statistics::Table;
use std::path::Path;

/// Draws stress ratio, volumetric strain, coordination and compacity against axial strain,
/// from the start of the test (s).
///
/// # Errors
/// The file cannot be written.
pub fn draw(path: &Path, title: &str, table: &Table, start: f64) -> Result<(), ReportError> {
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
    draw_panels(&[ratio, volume, neighbours, compacity], 2, path)
}
