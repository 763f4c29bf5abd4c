//! Sample of the friction test in a step: forces, slide and cumulative quantities.

use super::Recorder;
use crate::geometry::space::VectorLike;
use crate::record::friction::{Sample, State as Cumulated};
use crate::record::layer::Layer;
use crate::scene::build::Dimensional;

impl<S: Dimensional> Recorder<'_, S> {
    /// Cumulative quantities so far.
    pub(super) fn cumulated(&self) -> Cumulated {
        let s = &self.simulation;
        Cumulated {
            balance: self.layer.balance(s),
            broken: s.network.bonds_broken(),
            worn: self.worn.0,
        }
    }

    pub(super) fn damage_ratio(&self) -> f64 {
        let n = &self.simulation.network;
        if n.bonds_made() > 0 {
            n.bonds_broken() as f64 / n.bonds_made() as f64
        } else {
            0.0
        }
    }

    /// Q, P and slide of the friction test in the last step.
    pub(super) fn sample(&self) -> Option<Sample> {
        let test = self.loaded.case.friction.as_ref()?;
        let (_, place) = self.cycles.as_ref()?;
        let s = &self.simulation;
        let h = s.scheme.h;
        let impulse = s.received[*place].0;
        let slide = h * Layer::velocity(s, *place)[test.along];
        let q = -impulse[test.along] / h;
        Some(Sample {
            time: s.time,
            q,
            p: impulse[test.normal] * self.facing(*place, test.normal) / h,
            slide,
            work: q * slide,
        })
    }

    /// Sign of the force that the contacts of a driven body exert on it along an axis: 1 or -1.
    fn facing(&self, place: usize, axis: usize) -> f64 {
        let s = &self.simulation;
        let body = s.bodies.driven[place].body;
        let push: f64 = s
            .network
            .contacts
            .iter()
            .filter(|c| c.impulse.norm() > 0.0)
            .map(|c| match c.bodies {
                [i, _] if i == body => c.normal[axis],
                [_, j] if j == body => -c.normal[axis],
                _ => 0.0,
            })
            .sum();
        if push < 0.0 { -1.0 } else { 1.0 }
    }
}
