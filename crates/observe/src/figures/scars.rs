//! Figures of wear scars.

use crate::chart::{Axis, Chart, Series, Style};
use crate::output::Output;
use crate::scars::file_name;
use fretwork_core::view::RunView;
use fretwork_core::wear::{ScarForm, shape};

/// Returns charts of the scars: the depth, in 3D averaged across the sliding, and in 2D the initial
/// and the current profile.
pub(crate) fn charts(run: &dyn RunView) -> Vec<Output> {
    let mut out = Vec::new();
    let scars = run.scars().into_iter().enumerate();
    for (k, scar) in scars.filter(|(_, scar)| scar.deepest > 0.0) {
        let rows = run.scar_profile(k);
        let x = || Axis::new("position x", "m");
        let title = match shape::outline(&rows).form {
            ScarForm::None => format!("Wear scar of {}", scar.name),
            form => format!("Wear scar of {}, {form:?}-shaped", scar.name),
        };
        // The depth is plotted downwards.
        let points = rows.iter().map(|r| (r[0], -r[2])).collect();
        let depth = Chart::new(title, x(), Axis::new("−depth", "m"));
        let mut charts = vec![depth.with(Series::new(String::new(), points))];
        if run.dimension() == 2
            && let Some(sign) = run.scar_sign(k)
        {
            let vertices = run.scar_vertices(k);
            let first = vertices.iter().map(|v| (v.at[0], v.at[1])).collect();
            let now = vertices.iter();
            let now = now.map(|v| (v.at[0], v.at[1] - sign * v.depth));
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
        out.push(Output::leading(file_name(scar.name), charts, 2));
    }
    out
}
