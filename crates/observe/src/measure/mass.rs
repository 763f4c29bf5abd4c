//! Mass above a level, for example the content of a silo.

use super::{grains, line, since};
use crate::chart::Axis;
use crate::figures::history;
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::quantity::Findings;
use crate::quantity::unit::{MASS, MASS_FLOW};
use crate::statistics::Column;
use fretwork_core::view::RunView;

/// Observer for [`fretwork_scene::measures::MeasureSpec::Mass`].
#[derive(Clone, Debug)]
pub struct Mass {
    pub(super) name: String,
    pub(super) axis: usize,
    pub(super) above: f64,
    pub(super) start: f64,
    pub(super) inertia_scaling: f64,
}

impl Observer for Mass {
    fn name(&self) -> String {
        super::name_of("mass", &self.name)
    }

    fn columns(&self) -> Vec<Column> {
        vec![Column::new(
            self.name.clone(),
            MASS,
            "mass of the grains above a level",
        )]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let all = grains(run);
        let above = all.iter().filter(|g| g.at[self.axis] > self.above);
        vec![above.map(|g| g.mass).sum::<f64>() / self.inertia_scaling]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let points = since(end.table, &self.name, self.start);
        let rate = line(points.iter().copied());
        let doc = "change of the mass above a level, a line through its course";
        found.measure(&format!("{}_rate", self.name), rate, MASS_FLOW, doc);
    }

    fn file_names(&self) -> Vec<String> {
        vec![format!("{}.png", self.name)]
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let heading = format!("Mass, {}", self.name);
        let chart = history(heading, Axis::of_rows("mass m"), &[("", &self.name)]);
        vec![Output::figure(&self.name, [chart], 1)]
    }
}
