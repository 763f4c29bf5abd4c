//! The figure of jumps over cycles.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use fretwork_core::process::jump::{JumpPoint, JumpSummary};
use fretwork_core::unit::VOLUME;

/// Returns charts of wear volume and mean damage against cycles, computed and skipped.
pub(crate) fn charts(jump: &JumpSummary, dimension: usize) -> Output {
    let volume = VOLUME.symbol(dimension);
    let chart = |heading: &str, y: Axis, value: fn(&JumpPoint) -> f64| {
        let at = |p: &JumpPoint| (f64::from(p.cycles), value(p));
        let alone = jump.points.iter().filter(|p| p.cycle_multiplier == 1);
        Chart::new(heading, Axis::cycles(), y)
            .with_unless_zero(
                Series::new("jumped", jump.points.iter().map(at).collect()).style(Style::Dashed),
            )
            .with_unless_zero(
                Series::new("computed one by one", alone.map(at).collect()).style(Style::Markers),
            )
    };
    let charts = [
        chart("Wear by cycle", Axis::new("wear volume V", volume), |p| {
            p.wear_volume
        }),
        chart("Damage by cycle", Axis::new("mean damage D", ""), |p| {
            p.mean_damage
        }),
    ];
    Output::figure("jump", charts, 2)
}
