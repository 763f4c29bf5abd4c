//! Figure of a wear scar.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use crate::scars::file_name;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_core::wear::{Form, shape};

/// Draws the scars: the initial and the current profile, and the depth; in 3D averaged across the sliding.
///
/// # Errors
/// A file cannot be written.
pub(crate) fn charts<S: Space>(title: &str, s: &Simulation<S>) -> Vec<Output> {
    let mut out = Vec::new();
    for scar in s.state.scars.iter().filter(|c| c.deepest() > 0.0) {
        let rows = scar.along();
        let o = shape::outline(&rows);
        let mut depth = Chart::new(
            match o.form {
                Form::None => format!("Wear scar of {}", scar.name),
                form => format!("Wear scar of {}, {form:?}-shaped", scar.name),
            },
            Axis::new("position x", "m"),
            Axis::new("−depth", "m"),
        );
        depth.subtitle = Some(title.to_owned());
        // Depth plotted downwards.
        let points = rows.iter().map(|r| (r[0], -r[2])).collect();
        let mut charts = vec![depth.with(Series::new(String::new(), points))];
        if S::D == 2
            && let Some(shape) = s.shapes.surfaces[scar.surface].shape.receding()
        {
            let first = scar.vertices().map(|(v, _)| (v.at[0], v.at[1])).collect();
            let now = scar
                .vertices()
                .map(|(v, d)| (v.at[0], v.at[1] - shape.sign() * d));
            let mut chart = Chart::new(
                format!("Profile of {}", scar.name),
                Axis::new("position x", "m"),
                Axis::new("height z", "m"),
            );
            chart.subtitle = Some(title.to_owned());
            charts.push(
                chart
                    .with(Series::new("before wear", first).style(Style::Dashed))
                    .with(Series::new("worn", now.collect())),
            );
        }
        let columns = charts.len();
        let file = format!("{}.png", file_name(&scar.name));
        out.push(Output::charts(file, charts, columns));
    }
    out
}
