//! The figure of jumps over cycles.

use crate::{ReportError, draw_panels};
use fretwork_observe::chart::{Axis, Chart, Series, Style};
use fretwork_observe::jump::{JumpSummary, Point};
use std::path::Path;

/// Draws `jump.png`: wear volume and mean damage against cycles, both simulated and jumped.
///
/// # Errors
/// The file cannot be written.
pub fn draw(
    dir: &Path,
    title: &str,
    jump: &JumpSummary,
    dimension: usize,
) -> Result<(), ReportError> {
    let unit = if dimension == 2 { "m^3/m" } else { "m^3" };
    let mut charts = Vec::new();
    type Value = fn(&Point) -> f64;
    let volume: Value = |p| p.wear_volume;
    let damage: Value = |p| p.mean_damage;
    for (what, unit, value) in [
        ("wear volume V", unit, volume),
        ("mean damage D", "", damage),
    ] {
        let at = |p: &Point| (f64::from(p.cycles), value(p));
        if jump.points.iter().all(|p| value(p) == 0.0) {
            continue;
        }
        let all = jump.points.iter().map(at).collect();
        let alone = jump.points.iter().filter(|p| p.cycle_multiplier == 1);
        let mut chart = Chart::new(
            format!(
                "{} by cycle",
                ["Damage", "Wear"][usize::from(!unit.is_empty())]
            ),
            Axis::new("cycle number N", "").whole(),
            Axis::new(what, unit),
        );
        chart.subtitle = Some(title.to_owned());
        charts.push(
            chart
                .with(Series::new("jumped", all).style(Style::Dashed))
                .with(
                    Series::new("computed one by one", alone.map(at).collect())
                        .style(Style::Markers),
                ),
        );
    }
    if charts.is_empty() {
        return Ok(());
    }
    draw_panels(&charts, charts.len(), &dir.join("jump.png"))
}
