//! First bodies whose motion is prescribed or forced.

use crate::figures;
use crate::output::Output;
use crate::quantity::unit::{FORCE, METRE, SPEED};
use crate::statistics::Column;
use crate::typed::{ObserverIn, RunEndIn};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;

/// Observes the driven bodies: places, velocities and contact forces.
#[derive(Clone, Debug)]
pub struct DrivenBodies {
    /// Place among the driven bodies, and name.
    shown: Vec<(usize, String)>,
    /// Body and axis of an oscillating friction test, whose loops are drawn by themselves.
    test: Option<(String, usize)>,
}

impl DrivenBodies {
    /// Of the driven bodies of a simulation; a body and an axis whose force is drawn elsewhere may
    /// be left out of the figures.
    pub fn of<S: Space>(s: &Simulation<S>, test: Option<(String, usize)>) -> Self {
        let named = s.state.bodies.driven.iter().enumerate();
        // Walls that a scene file brought are not worth columns.
        let shown = named.filter(|(_, d)| !d.name.starts_with("wall_"));
        Self {
            shown: shown.map(|(k, d)| (k, d.name.clone())).collect(),
            test,
        }
    }
}

impl<S: Space> ObserverIn<S> for DrivenBodies {
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
                let axes = ["x", "y", "z"].into_iter().take(S::D);
                out.extend(axes.map(|a| Column::new(format!("{name}_{what}{a}"), unit, doc)));
            }
        }
        out
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let mut row = Vec::with_capacity(self.shown.len() * 3 * S::D);
        for (d, _) in &self.shown {
            let b = s.state.bodies.driven[*d].body as usize;
            let force = s.state.received[*d].0 * (1.0 / s.options.scheme.h);
            for values in [
                s.state.bodies.position[b],
                s.state.bodies.velocity[b],
                force,
            ] {
                row.extend((0..S::D).map(|k| values[k]));
            }
        }
        row
    }

    fn figures(&self, end: &RunEndIn<'_, S>) -> Vec<Output> {
        let test = self
            .test
            .as_ref()
            .map(|(body, axis)| (body.as_str(), *axis));
        let drives = figures::drives(end.simulation, test);
        vec![figures::force_displacement(&drives)]
    }
}
