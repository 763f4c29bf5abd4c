//! Wear scars: columns of the statistics, what the summary says, `scar_NAME.csv` and `scar_NAME.png`.

use super::statistics::Column;
use super::summary::quantity::quantity;
use crate::geometry::space::Space;
use crate::report::{Axis, Chart, ReportError, Series, Style, draw_panels};
use crate::step::Simulation;
use crate::wear::{Form, Scar, shape};
use serde::Serialize;
use std::path::Path;

/// One scar in the summary (SI).
#[derive(Clone, Debug, Serialize)]
pub struct ScarSummary {
    /// Body, with a number where several of its surfaces wear.
    pub body: String,
    /// Volume worn off (m^3; m^3/m).
    pub volume: f64,
    /// Largest depth (m).
    pub depth: f64,
    /// Where it is along x, in the body's frame (m).
    pub deepest_at: f64,
    /// `U`, `W` or `None`; see [`crate::wear::shape`].
    pub form: Form,
    /// Where the scar begins and ends along x (m); null where there is none.
    pub from: Option<f64>,
    /// Its other end (m).
    pub to: Option<f64>,
    /// Depth of its middle (m).
    pub middle: f64,
    /// Depth of its deepest slice on the left and on the right (m).
    pub sides: [f64; 2],
    /// Depth at which it is worn through (m).
    pub thickness: f64,
}

impl ScarSummary {
    fn of<S: Space>(scar: &Scar<S>) -> Self {
        let o = shape::outline(&scar.along());
        Self {
            body: scar.name.clone(),
            volume: scar.volume(),
            depth: scar.deepest(),
            deepest_at: scar.deepest_at()[0],
            form: o.form,
            from: o.from.is_finite().then_some(o.from),
            to: o.to.is_finite().then_some(o.to),
            middle: o.middle,
            sides: o.sides,
            thickness: scar.thickness,
        }
    }

    /// Its form and extent in words; volume and depths stand with the wear of its body.
    pub fn outline(&self) -> String {
        match (self.form, self.from, self.to) {
            (Form::None, ..) | (_, None, _) | (_, _, None) => "no scar".to_owned(),
            (form, Some(from), Some(to)) => {
                let [left, right] = self.sides;
                let m = |x: f64| quantity(x, "m");
                format!(
                    "{form:?} from x = {} to {}, deepest at x = {}; middle {}, sides {} and {} deep",
                    m(from),
                    m(to),
                    m(self.deepest_at),
                    m(self.middle),
                    m(left),
                    m(right)
                )
            }
        }
    }
}

/// What the summary says of the scars.
pub fn outcome<S: Space>(s: &Simulation<S>) -> Vec<ScarSummary> {
    s.scars.iter().map(ScarSummary::of).collect()
}

/// Columns of the statistics.
pub fn columns<S: Space>(s: &Simulation<S>) -> Vec<Column> {
    let volume = if S::D == 2 { "m^3/m" } else { "m^3" };
    let two = |scar: &Scar<S>| {
        [
            Column::new(
                format!("{}_worn", scar.name),
                volume,
                "volume worn off the body",
            ),
            Column::new(
                format!("{}_depth", scar.name),
                "m",
                "largest depth of its scar",
            ),
        ]
    };
    s.scars.iter().flat_map(two).collect()
}

/// Values of [`columns`].
pub fn row<S: Space>(s: &Simulation<S>) -> impl Iterator<Item = f64> + '_ {
    s.scars.iter().flat_map(|c| [c.volume(), c.deepest()])
}

/// The scar as a table: places in the body's frame, height now and at first, depth (m). A run reads it again as the
/// `file` of a `Profile`.
pub fn table<S: Space>(s: &Simulation<S>, scar: &Scar<S>) -> String {
    let across = if S::D == 2 { "x [m]" } else { "x [m],y [m]" };
    let mut text = format!("{across},z [m],z_first [m],depth [m]\n");
    let Some(shape) = s.shapes.surfaces[scar.surface].shape.receding() else {
        return text;
    };
    let mut rows: Vec<(S::Vector, f64)> = scar.vertices().map(|(v, d)| (v.at, d)).collect();
    let repeated = rows.first().map(|r| r.1);
    rows.extend(shape.end().zip(repeated));
    // From left to right, whichever way the chain goes.
    if S::D == 2 && shape.sign() < 0.0 {
        rows.reverse();
    }
    for (at, depth) in rows {
        let first = at[S::D - 1];
        let places = (0..S::D - 1).map(|k| at[k]);
        let heights = [first - shape.sign() * depth, first, depth];
        let numbers: Vec<String> = places.chain(heights).map(|x| format!("{x:e}")).collect();
        text += &(numbers.join(",") + "\n");
    }
    text
}

/// Writes the tables.
///
/// # Errors
/// A file cannot be written.
pub fn write<S: Space>(dir: &Path, s: &Simulation<S>) -> Result<(), ReportError> {
    for scar in &s.scars {
        let path = dir.join(format!("{}.csv", file_name(&scar.name)));
        if let Err(e) = std::fs::write(&path, table(s, scar)) {
            let reason = e.to_string();
            return Err(ReportError::Write { path, reason });
        }
    }
    Ok(())
}

/// Draws the scars: the profile at first and now, and the depth; in space as means across the sliding.
///
/// # Errors
/// A file cannot be written.
pub fn draw<S: Space>(dir: &Path, title: &str, s: &Simulation<S>) -> Result<(), ReportError> {
    for scar in s.scars.iter().filter(|c| c.deepest() > 0.0) {
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
        // Downwards, as it lies.
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
        let path = dir.join(format!("{}.png", file_name(&scar.name)));
        draw_panels(&charts, charts.len(), &path)?;
    }
    Ok(())
}

/// Names of files take letters, digits, `-` and `_` of the name of a body.
fn file_name(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    };
    format!("scar_{}", name.chars().map(plain).collect::<String>())
}
