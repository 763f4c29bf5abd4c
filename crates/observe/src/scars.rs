//! Wear scars: columns of the statistics, entries of the summary, and `scar_NAME.csv`.

use super::figures;
use super::observer::{Observer, RunEnd};
use super::output::Output;
use super::quantity::quantity;
use super::statistics::Column;
use super::summary::Summary;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_core::wear::{Form, Scar, shape};
use serde::Serialize;

/// One scar in the summary (SI).
#[derive(Clone, Debug, Serialize)]
pub struct ScarSummary {
    /// Name of the body, with a number if several of its surfaces wear.
    pub body: String,
    /// Volume worn off (m^3; m^3/m).
    pub volume: f64,
    /// Largest depth (m).
    pub depth: f64,
    /// Position of the largest depth along x, in the body's frame (m).
    pub deepest_at: f64,
    /// `U`, `W` or `None`; see [`fretwork_core::wear::shape`].
    pub form: Form,
    /// Start of the scar along x (m); null if there is no scar.
    pub from: Option<f64>,
    /// End of the scar along x (m); null if there is no scar.
    pub to: Option<f64>,
    /// Depth at its middle (m).
    pub middle: f64,
    /// Depth of the deepest slice on the left and on the right of the middle (m).
    pub sides: [f64; 2],
    /// Depth at which the surface is worn through (m).
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

    /// Describes its form and extent; volume and depths are reported with the wear of its body.
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

/// Observes the scars.
#[derive(Clone, Debug)]
pub struct Scars {
    /// Their names.
    names: Vec<String>,
}

impl Scars {
    /// Of the surfaces of a simulation that follow their wear.
    pub fn of<S: Space>(s: &Simulation<S>) -> Self {
        Self {
            names: s.state.scars.iter().map(|scar| scar.name.clone()).collect(),
        }
    }
}

impl<S: Space> Observer<S> for Scars {
    fn name(&self) -> String {
        "scars".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let volume = if S::D == 2 { "m^3/m" } else { "m^3" };
        let two = |name: &String| {
            let (worn, depth) = (format!("{name}_worn"), format!("{name}_depth"));
            [
                Column::new(worn, volume, "volume worn off the body"),
                Column::new(depth, "m", "largest depth of its scar"),
            ]
        };
        self.names.iter().flat_map(two).collect()
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let two = |scar: &Scar<S>| [scar.volume(), scar.deepest()];
        s.state.scars.iter().flat_map(two).collect()
    }

    fn summarise(&self, end: &RunEnd<'_, S>, summary: &mut Summary) {
        summary.scars = end
            .simulation
            .state
            .scars
            .iter()
            .map(ScarSummary::of)
            .collect();
    }

    /// The tables of all scars, `scar_NAME.csv`.
    fn files(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let s = end.simulation;
        let file = |scar: &Scar<S>| Output::Text {
            file: format!("{}.csv", file_name(&scar.name)),
            text: table(s, scar),
        };
        s.state.scars.iter().map(file).collect()
    }

    fn file_names(&self) -> Vec<String> {
        let names = self.names.iter().map(|name| file_name(name));
        names
            .flat_map(|name| [".csv", ".png"].map(|end| format!("{name}{end}")))
            .collect()
    }

    fn figures(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        figures::scars::charts(end.simulation)
    }
}

/// The scar as a table: positions in the body's frame, current and initial height, depth (m). A case can read
/// it as the `file` of a `Profile`.
pub fn table<S: Space>(s: &Simulation<S>, scar: &Scar<S>) -> String {
    let across = if S::D == 2 { "x [m]" } else { "x [m],y [m]" };
    let mut text = format!("{across},z [m],z_first [m],depth [m]\n");
    let Some(shape) = s.shapes.surfaces[scar.surface].shape.receding() else {
        return text;
    };
    let mut rows: Vec<(S::Vector, f64)> = scar.vertices().map(|(v, d)| (v.at, d)).collect();
    let repeated = rows.first().map(|r| r.1);
    // The scar of a surface that deforms is not in the frame of the surface.
    let (scar_at, shape_at) = (rows.first().map(|r| r.0), shape.vertices());
    let end = shape.end().zip(scar_at).zip(shape_at.first());
    let end = end.map(|((end, first), v)| end + (first - v.at));
    rows.extend(end.zip(repeated));
    // From left to right, independent of the orientation of the profile.
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

/// Names of files take letters, digits, `-` and `_` of the name of a body.
pub fn file_name(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    };
    format!("scar_{}", name.chars().map(plain).collect::<String>())
}
