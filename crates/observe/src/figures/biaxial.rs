//! Figure of a biaxial test: four panels against axial strain.

use crate::chart::{Axis, Chart, Part, Series, Style};
use crate::output::Output;

/// Returns charts of the stress ratio, the volumetric strain, the coordination and the compacity
/// against axial strain, from the start of the test (s) on.
pub(crate) fn charts(start: f64) -> Output {
    let rows = |label: &str, column: &str| {
        Series::rows(label, "axial_strain", column).part(Part::Since(start))
    };
    let chart = |heading: &str, y: &str, series: Series| {
        Chart::new(heading, Axis::new("axial strain ε_1", ""), Axis::new(y, "")).with(series)
    };
    let panels = [
        chart(
            "Stress ratio",
            "q/p = sin φ",
            rows("q/p from the walls", "q_over_p"),
        )
        .with(rows("sin φ from the contacts", "sin_phi").style(Style::Dashed)),
        chart(
            "Volumetric strain, expansion positive",
            "volumetric strain ε_v",
            rows("", "volumetric_strain"),
        ),
        chart(
            "Coordination, contacts that carry force",
            "coordination number Z",
            rows("all grains", "coordination"),
        )
        .with(rows("without rattlers", "coordination_carried").style(Style::Dashed)),
        chart("Solid fraction", "solid fraction φ", rows("", "compacity")),
    ];
    Output::leading("biaxial", panels, 2)
}
