//! Figures of wear scars.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use crate::scars::file_name;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_core::wear::{ScarForm, shape};

/// The scars: the depth, in 3D averaged across the sliding, and in 2D the initial and the current
/// profile.
pub(crate) fn charts<S: Space>(s: &Simulation<S>) -> Vec<Output> {
    let mut out = Vec::new();
    for scar in s.state.scars.iter().filter(|c| c.deepest() > 0.0) {
        let rows = scar.along();
        let x = || Axis::new("position x", "m");
        let title = match shape::outline(&rows).form {
            ScarForm::None => format!("Wear scar of {}", scar.name),
            form => format!("Wear scar of {}, {form:?}-shaped", scar.name),
        };
        // Depth plotted downwards.
        let points = rows.iter().map(|r| (r[0], -r[2])).collect();
        let depth = Chart::new(title, x(), Axis::new("−depth", "m"));
        let mut charts = vec![depth.with(Series::new(String::new(), points))];
        if S::D == 2
            && let Some(shape) = s.shapes.surfaces[scar.surface].shape.receding()
        {
            let first = scar.vertices().map(|(v, _)| (v.at[0], v.at[1])).collect();
            let now = scar
                .vertices()
                .map(|(v, d)| (v.at[0], v.at[1] - shape.sign() * d));
            charts.push(
                Chart::new(
                    format!("Profile of {}", scar.name),
                    x(),
                    Axis::new("height z", "m"),
                )
                .with(Series::new("before wear", first).style(Style::Dashed))
                .with(Series::new("worn", now.collect())),
            );
        }
        out.push(Output::figure(file_name(&scar.name), charts, 2));
    }
    out
}
