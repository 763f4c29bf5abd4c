//! First bodies with imposed motion or force.

use crate::figures;
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::quantity::unit::{FORCE, METRE, SPEED};
use crate::statistics::Column;
use fretwork_core::view::RunView;

/// Observes the driven bodies: positions, velocities and contact forces.
#[derive(Clone, Debug)]
pub struct DrivenBodies {
    /// Index among the driven bodies, and name.
    shown: Vec<(usize, String)>,
    /// Number of dimensions.
    dimension: usize,
    /// Body and axis of an oscillating friction test, whose loops are drawn separately.
    test: Option<(String, usize)>,
}

impl DrivenBodies {
    /// Creates the observer of the driven bodies of a simulation; a body and an axis whose force is
    /// drawn elsewhere may be omitted from the figures.
    pub fn of(run: &dyn RunView, test: Option<(String, usize)>) -> Self {
        let named = run.bodies().driven.iter().enumerate();
        // Walls from a scene file get no columns.
        let shown = named.filter(|(_, d)| !d.name.starts_with("wall_"));
        Self {
            shown: shown.map(|(k, d)| (k, d.name.clone())).collect(),
            dimension: run.dimension(),
            test,
        }
    }
}

impl Observer for DrivenBodies {
    fn name(&self) -> String {
        "driven bodies".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let mut out = Vec::new();
        for (_, name) in &self.shown {
            for (what, unit, doc) in [
                ("", METRE, "position of the body"),
                ("v", SPEED, "velocity of the body"),
                ("f", FORCE, "contact force on the body"),
            ] {
                let axes = ["x", "y", "z"].into_iter().take(self.dimension);
                out.extend(axes.map(|a| Column::new(format!("{name}_{what}{a}"), unit, doc)));
            }
        }
        out
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let mut row = Vec::with_capacity(self.shown.len() * 3 * self.dimension);
        let (bodies, received) = (run.bodies(), run.received());
        let per_time = 1.0 / run.options().scheme.h;
        for (d, _) in &self.shown {
            let b = bodies.driven[*d].body as usize;
            let force = received[*d][0].map(|impulse| impulse * per_time);
            for values in [bodies.position.at(b), bodies.velocity.at(b), force] {
                row.extend_from_slice(&values[..self.dimension]);
            }
        }
        row
    }

    fn file_names(&self) -> Vec<String> {
        vec!["force_displacement.png".to_owned()]
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let test = self
            .test
            .as_ref()
            .map(|(body, axis)| (body.as_str(), *axis));
        let drives = figures::drives(end.simulation, test);
        vec![figures::force_displacement(&drives)]
    }
}
