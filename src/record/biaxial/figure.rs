//! The figure of a biaxial test: four panels against axial strain.

use super::super::statistics::Table;
use crate::report::{Axis, Chart, ReportError, Series, Style, draw_panels};
use std::path::Path;

/// Draws the stress ratio, the volumetric strain, the coordination and the compacity against axial strain,
/// from the start of the test (s) on.
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
        Chart::new(heading, Axis::new("axial strain", ""), Axis::new(y, ""))
    };
    let mut ratio = chart("stress ratio", "q/p = sin phi")
        .with(Series::new("from the walls", against("q_over_p")))
        .with(Series::new("from the contacts", against("sin_phi")).style(Style::Dashed));
    ratio.subtitle = Some(title.to_owned());
    let mut volume = chart("volumetric strain", "expansion")
        .with(Series::new(String::new(), against("volumetric_strain")));
    volume.subtitle = Some("positive in expansion".into());
    let mut neighbours = chart("coordination", "contacts a grain")
        .with(Series::new("all grains", against("coordination")))
        .with(
            Series::new("without rattlers", against("coordination_carried")).style(Style::Dashed),
        );
    neighbours.subtitle = Some("contacts that carry force".into());
    let mut compacity = chart("compacity", "volume of grains / volume")
        .with(Series::new(String::new(), against("compacity")));
    compacity.subtitle = Some("between the walls".into());
    draw_panels(&[ratio, volume, neighbours, compacity], 2, path)
}
