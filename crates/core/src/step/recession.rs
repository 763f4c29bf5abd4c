//! Wear of surfaces during the run.
//!
//! The volume worn in a step is added to the scars at the contact points at q_m. Surfaces recede after the
//! motion of the step; detection in the next step sees the opened gap. Recession itself does no work: a load
//! that sinks into the gap releases its potential energy in the next step, as over any open gap.

use super::{Simulation, StepError};
use crate::geometry::space::Space;
use crate::wear::scar::{Scar, WornThrough, closest_point};

impl<S: Space> Simulation<S> {
    /// Lets the surface of a scar wear by its contacts; the network records their worn volumes from now on.
    pub fn follow_wear(&mut self, scar: Scar<S>) {
        self.network.losses.get_or_insert_default();
        self.scars.push(scar);
    }

    /// Checks that no surface is worn through.
    ///
    /// # Errors
    /// The first surface that is, and where.
    pub fn whole(&self) -> Result<(), StepError> {
        let error = |source: &WornThrough| StepError::WornThrough {
            step: self.steps,
            time: self.time,
            source: source.clone(),
        };
        self.worn_through.as_ref().map_or(Ok(()), |w| Err(error(w)))
    }

    /// Adds the volumes worn in the step to the scars.
    pub(super) fn put_losses(&mut self) {
        let Some(losses) = &self.network.losses else {
            return;
        };
        for loss in losses {
            let contact = &self.network.contacts[loss.contact as usize];
            let surface = contact.key.surface();
            let mut scars = self.scars.iter_mut();
            let Some(scar) = scars.find(|s| Some(s.surface) == surface) else {
                continue;
            };
            let carried = &self.shapes.surfaces[scar.surface];
            let rotation = &self.bodies.rotation[carried.body as usize];
            let closest_point = closest_point(carried, rotation, &contact.arms[1]);
            let put = scar.put(&self.shapes, &closest_point, loss.volume);
            self.worn_through = self.worn_through.take().or(put.err());
        }
    }

    /// Lowers the surfaces that are due.
    pub(super) fn recede(&mut self) {
        let steps = self.steps;
        // A step that represents many cycles is applied at once: the next detection must see the changed
        // profile.
        let many = self.network.cycle_multiplier > 1.0;
        self.lower(|scar| many || steps.is_multiple_of(scar.every));
    }

    /// Lowers all surfaces to the depth of their scars, regardless of their interval.
    pub fn show_wear(&mut self) {
        self.lower(|_| true);
    }

    fn lower(&mut self, due: impl Fn(&Scar<S>) -> bool) {
        let bound = 0.5 * self.network.skin;
        let mut far = false;
        for scar in self.scars.iter_mut().filter(|s| due(s)) {
            far |= scar.show(&mut self.shapes, bound);
        }
        if far {
            self.network.forget_neighbours();
        }
    }
}
