//! Wear scars: columns of the statistics, entries of the summary, and `scar_NAME.csv`.

use super::figures;
use super::output::Output;
use super::quantity::unit::{METRE, VOLUME, WORD};
use super::quantity::{Findings, Role, Topic, quantity};
use super::statistics::Column;
use crate::typed::{ObserverIn, RunEndIn};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_core::wear::{Scar, ScarForm, shape};
use serde::Serialize;

crate::described! {
    /// One scar in the summary (SI).
    #[derive(Clone, Debug, Serialize)]
    pub struct ScarSummary {
        /// Name of the body, with a number if several of its surfaces wear.
        pub body: String => WORD,
        /// Volume worn off.
        pub volume: f64 => VOLUME,
        /// Largest depth.
        pub depth: f64 => METRE,
        /// Position of the largest depth along x, in the body's frame.
        pub deepest_at: f64 => METRE,
        /// `U` deepest in the middle, `W` deeper on both sides, `None`.
        pub form: ScarForm => WORD,
        /// Start of the scar along x; null if there is no scar.
        pub from: Option<f64> => METRE,
        /// End of the scar along x; null if there is no scar.
        pub to: Option<f64> => METRE,
        /// Depth at its middle.
        pub middle: f64 => METRE,
        /// Depth of the deepest slice on the left and on the right of the middle.
        pub sides: [f64; 2] => METRE,
        /// Depth at which the surface is worn through.
        pub thickness: f64 => METRE,
    }
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
            (ScarForm::None, ..) | (_, None, _) | (_, _, None) => "no scar".to_owned(),
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

impl<S: Space> ObserverIn<S> for Scars {
    fn name(&self) -> String {
        "scars".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let two = |name: &String| {
            let (worn, depth) = (format!("{name}_worn"), format!("{name}_depth"));
            [
                Column::new(worn, VOLUME, "volume worn off the body"),
                Column::new(depth, "m", "largest depth of its scar"),
            ]
        };
        self.names.iter().flat_map(two).collect()
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let two = |scar: &Scar<S>| [scar.volume(), scar.deepest()];
        s.state.scars.iter().flat_map(two).collect()
    }

    fn report(&self, end: &RunEndIn<'_, S>, found: &mut Findings) {
        let scars = end.simulation.state.scars.iter();
        let scars: Vec<ScarSummary> = scars.map(ScarSummary::of).collect();
        found.begin(Topic::Wear, Role::Detail);
        found.parts::<ScarSummary>("scars", &scars, "scars of the surfaces that recede");
        for (k, scar) in scars.iter().enumerate().filter(|(_, s)| s.volume > 0.0) {
            found.edit(&format!("scars.{k}.depth"), |q| {
                q.secondary(format!("depth of the scar of {}", scar.body));
                q.sentence(format!("scar of {}", scar.body), scar.outline());
            });
        }
        if scars.is_empty() {
            found.edit("scars", |q| {
                q.lacks("no surface of the case recedes by wear (`wears`)");
            });
        }
    }

    /// The tables of all scars, `scar_NAME.csv`.
    fn files(&self, end: &RunEndIn<'_, S>) -> Vec<Output> {
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

    fn figures(&self, end: &RunEndIn<'_, S>) -> Vec<Output> {
        figures::scars::charts(end.simulation)
    }
}

/// The scar as a table: positions in the body's frame, current and initial height, depth (m). A
/// case can read it as the `file` of a `Profile`.
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
