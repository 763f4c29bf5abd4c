//! Angle of a free surface: a straight line through the highest grain of each column.

use super::{grains, line, mean, since};
use crate::chart::{Axis, Chart, Series, Value};
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::quantity::Findings;
use crate::quantity::unit::RADIAN;
use crate::statistics::Column;
use fretwork_core::view::RunView;

/// Observer for [`fretwork_scene::measures::MeasureSpec::Slope`].
#[derive(Clone, Debug)]
pub struct Slope {
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) start: f64,
}

impl Observer for Slope {
    fn name(&self) -> String {
        super::name_of("slope", &self.name)
    }

    fn columns(&self) -> Vec<Column> {
        vec![Column::new(
            self.name.clone(),
            "rad",
            "angle of the free surface",
        )]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        // Grains in free flight are not part of the surface.
        let mut touched = vec![false; run.bodies().len()];
        run.visit_contacts(&mut |contact| {
            if contact.impulse != [0.0; 3] {
                let bodies = contact.bodies.iter();
                bodies.for_each(|b| touched[*b as usize] = true);
            }
        });
        let wide = self.to - self.from;
        let all = grains(run);
        let sum: f64 = all.iter().map(|g| 2.0 * g.radius).sum();
        // Columns are two mean diameters wide.
        let width = 2.0 * sum / all.len().max(1) as f64;
        let columns = if width > 0.0 {
            (wide / width).floor().clamp(2.0, 1e6) as usize
        } else {
            2
        };
        let mut tops = vec![None::<f64>; columns];
        for g in &all {
            let k = ((g.at[0] - self.from) / wide * columns as f64).floor();
            if touched[g.body] && k >= 0.0 && (k as usize) < columns {
                let top = g.at[run.dimension() - 1] + g.rise(run);
                let old = &mut tops[k as usize];
                *old = Some(old.map_or(top, |o| o.max(top)));
            }
        }
        let points = tops
            .iter()
            .enumerate()
            .filter_map(|(k, top)| Some(((k as f64 + 0.5) / columns as f64 * wide, (*top)?)));
        vec![line(points).map_or(f64::NAN, f64::atan)]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let mean = mean(&since(end.table, &self.name, self.start));
        found.measure(&self.name, mean, RADIAN, "mean angle of the free surface");
    }

    fn file_names(&self) -> Vec<String> {
        vec![format!("{}.png", self.name)]
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let value = Value {
            factor: 1f64.to_degrees(),
            ..Value::from(self.name.as_str())
        };
        let heading = format!("Angle of the surface, {}", self.name);
        let chart = Chart::new(heading, Axis::time(), Axis::new("angle θ", "deg"))
            .with(Series::rows("", "time", value));
        vec![Output::figure(&self.name, [chart], 1)]
    }
}
