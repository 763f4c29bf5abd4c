//! Surfaces follow their wear.
//!
//! What a step wears off is put on the scars with the feet of its contacts, at q_m. The surfaces fall after the step's
//! motion: the gap that opens is met by the next step's detection. Nobody does work in between: a load that
//! sinks into the gap gives its potential energy in the next step, as it does over any open gap.

use super::{Simulation, StepError};
use crate::geometry::space::Space;
use crate::wear::scar::{Scar, WornThrough, closest_point};

impl<S: Space> Simulation<S> {
    /// Has a surface worn by its contacts; the network keeps their losses from now on.
    pub fn follow_wear(&mut self, scar: Scar<S>) {
        self.network.losses.get_or_insert_default();
        self.scars.push(scar);
    }

    /// Whether no surface is worn through.
    ///
    /// # Errors
    /// Which is, and where.
    pub fn whole(&self) -> Result<(), StepError> {
        let error = |source: &WornThrough| StepError::WornThrough {
            step: self.steps,
            time: self.time,
            source: source.clone(),
        };
        self.worn_through.as_ref().map_or(Ok(()), |w| Err(error(w)))
    }

    /// Puts what the step wore off on the scars.
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

    /// Lowers the surfaces whose turn it is.
    pub(super) fn recede(&mut self) {
        let steps = self.steps;
        // A step that wears for many is followed at once: the contact must find what stands proud.
        let many = self.network.cycle_multiplier > 1.0;
        self.lower(|scar| many || steps.is_multiple_of(scar.every));
    }

    /// Lowers all surfaces to the depth of their scars, whatever their interval.
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
