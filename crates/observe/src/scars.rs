//! Wear scars: columns of the statistics, entries of the summary, and `scar_NAME.csv`.

use super::figures;
use super::output::Output;
use super::quantity::unit::{METRE, VOLUME, WORD};
use super::quantity::{Findings, Role, Topic, quantity, values};
use super::statistics::Column;
use crate::observer::{Observer, RunEnd};
use fretwork_core::view::{RunView, ScarView};
use fretwork_core::wear::{ScarForm, shape};
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
        pub sides: [f64; 2] = values(METRE),
        /// Depth at which the surface is worn through.
        pub thickness: f64 => METRE,
    }
}

impl ScarSummary {
    fn of(run: &dyn RunView, place: usize, scar: &ScarView<'_>) -> Self {
        let o = shape::outline(&run.scar_profile(place));
        Self {
            body: scar.name.to_owned(),
            volume: scar.volume,
            depth: scar.deepest,
            deepest_at: scar.deepest_at[0],
            form: o.form,
            from: o.from.is_finite().then_some(o.from),
            to: o.to.is_finite().then_some(o.to),
            middle: o.middle,
            sides: o.sides,
            thickness: scar.thickness,
        }
    }

    /// Describes form and extent of the scar; volume and depths are reported with the wear of its
    /// body.
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
    /// Names of the scars.
    names: Vec<String>,
}

impl Scars {
    /// Creates the observer of the surfaces of a simulation that recede by wear.
    pub fn of(run: &dyn RunView) -> Self {
        Self {
            names: run
                .scars()
                .iter()
                .map(|scar| scar.name.to_owned())
                .collect(),
        }
    }
}

impl Observer for Scars {
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

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let scars = run.scars().into_iter();
        scars.flat_map(|scar| [scar.volume, scar.deepest]).collect()
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let run = end.simulation;
        let scars = run.scars().into_iter().enumerate();
        let scars: Vec<ScarSummary> = scars.map(|(k, s)| ScarSummary::of(run, k, &s)).collect();
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

    /// Returns the tables of all scars, `scar_NAME.csv`.
    fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let run = end.simulation;
        let file = |(place, scar): (usize, ScarView<'_>)| Output::Text {
            file: format!("{}.csv", file_name(scar.name)),
            text: table(run, place),
        };
        run.scars().into_iter().enumerate().map(file).collect()
    }

    fn file_names(&self) -> Vec<String> {
        let names = self.names.iter().map(|name| file_name(name));
        names
            .flat_map(|name| [".csv", ".png"].map(|end| format!("{name}{end}")))
            .collect()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        figures::scars::charts(end.simulation)
    }
}

/// Returns the scar as a table: positions in the body's frame, current and initial height, depth
/// (m). A case can read it as the `file` of a `Profile`.
pub fn table(run: &dyn RunView, scar: usize) -> String {
    let dimension = run.dimension();
    let across = if dimension == 2 {
        "x [m]"
    } else {
        "x [m],y [m]"
    };
    let mut text = format!("{across},z [m],z_first [m],depth [m]\n");
    let Some(sign) = run.scar_sign(scar) else {
        return text;
    };
    let vertices = run.scar_vertices(scar).into_iter();
    let mut rows: Vec<([f64; 3], f64)> = vertices.map(|v| (v.at, v.depth)).collect();
    let repeated = rows.first().map(|r| r.1);
    rows.extend(run.scar_end(scar).zip(repeated));
    // The points go from left to right, independent of the orientation of the profile.
    if dimension == 2 && sign < 0.0 {
        rows.reverse();
    }
    for (at, depth) in rows {
        let first = at[dimension - 1];
        let places = at[..dimension - 1].iter().copied();
        let heights = [first - sign * depth, first, depth];
        let numbers: Vec<String> = places.chain(heights).map(|x| format!("{x:e}")).collect();
        text += &(numbers.join(",") + "\n");
    }
    text
}

/// Returns a file name with the letters, digits, `-` and `_` of the name of a body.
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
