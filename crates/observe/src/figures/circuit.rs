//! Figure of the tribological circuit: cumulative flows against time, and the mass in the contact.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use crate::statistics::Table;

/// `circuit.png` from the columns of the statistics; `window` is the one of the mean flows (s).
pub(crate) fn charts(title: &str, table: &Table, window: [f64; 2], dimension: usize) -> Output {
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
    Output::charts("circuit.png".into(), [passed, contact], 2)
}
