//! Figure of the tribological circuit: cumulative flows against time, and the mass in the contact.

use crate::{ReportError, draw_panels};
use fretwork_observe::chart::{Axis, Chart, Series, Style};
use fretwork_observe::statistics::Table;
use std::path::Path;

/// Draws `circuit.png` from the columns of the statistics; `window` is that of the mean flows (s).
///
/// # Errors
/// The file cannot be written.
pub fn draw(
    dir: &Path,
    title: &str,
    table: &Table,
    window: [f64; 2],
    dimension: usize,
) -> Result<(), ReportError> {
    let unit = if dimension == 2 { "kg/m" } else { "kg" };
    let time = table.column("time");
    let series =
        |name: &str| -> Vec<(f64, f64)> { time.iter().copied().zip(table.column(name)).collect() };
    let chart = |heading: &str, y: &str| {
        let mut chart = Chart::new(heading, Axis::new("time t", "s"), Axis::new(y, unit));
        chart.subtitle = Some(title.to_owned());
        chart
    };
    let mut passed = chart("Mass that passed since the start", "mass m");
    for (column, label) in [
        ("source", "source, Qs"),
        ("ejected", "ejected, Qe"),
        ("recirculated", "came back, Qr"),
        ("lost", "lost, Qw"),
        ("attached", "tied again, Qa"),
    ] {
        passed = passed.with_unless_zero(Series::new(label, series(column)));
    }
    let inside = series("M");
    let top = inside.iter().map(|p| p.1).fold(0.0, f64::max);
    let from = vec![(window[0], 0.0), (window[0], 1.05 * top)];
    let mut contact =
        chart("Third body in the contact", "mass M").with_unless_zero(Series::new("M", inside));
    if contact.has_data() {
        contact = contact.with(Series::new("means from here on", from).style(Style::Dashed));
    }
    draw_panels(&[passed, contact], 2, &dir.join("circuit.png"))
}
