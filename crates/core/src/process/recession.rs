//! Recession: worn surfaces are lowered by the depth of their scars.
//!
//! The volume worn in a step is removed from the scars at the closest points of its contacts, at
//! q_m; at a contact with a mean position from all vertices below the facets of its point
//! ([`crate::geometry::mortar`]). The surfaces recede after the motion of the step; the next
//! detection finds the gap that opens. No work is done in between: a load that falls into the gap
//! releases its potential energy in the next step, as over any open gap.

use super::{Process, ProcessError};
use crate::geometry::space::Space;
use crate::step::{Simulation, StepError, StepReport};
use crate::wear::scar::{Scar, closest_point};

/// Removes the volumes worn at contacts from the scars of a simulation, and lowers its surfaces. It
/// has no state of its own: the scars are part of the state of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Recession;

impl<S: Space> Process<S> for Recession {
    fn name(&self) -> &str {
        "wear recession"
    }

    fn repeats(&self) -> bool {
        true
    }

    /// Refuses a step if a surface is worn through.
    fn at_start(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        s.check_worn_through()?;
        s.state.network.losses.get_or_insert_default();
        Ok(())
    }

    fn after_solve(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        apply_losses(s);
        Ok(())
    }

    /// Lowers the surfaces that are due in this step, at the interval `every` of their scars.
    fn after_move(&mut self, s: &mut Simulation<S>, _: &StepReport) -> Result<(), ProcessError> {
        let steps = s.state.steps;
        // After a step that represents several cycles the surface recedes at once, so that the next
        // contacts are at protruding places.
        let jumps = s.state.network.cycle_multiplier > 1.0;
        lower(s, |scar| jumps || steps.is_multiple_of(scar.every));
        Ok(())
    }

    /// Lowers all surfaces to the depth of their scars, independent of their interval.
    fn at_end(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        lower(s, |_| true);
        Ok(())
    }
}

impl<S: Space> Simulation<S> {
    /// Lets a surface wear by its contacts; the network records their losses from the next step on.
    pub fn follow_wear(&mut self, scar: Scar<S>) {
        if self.process::<Recession>().is_none() {
            self.add_process(Recession);
        }
        self.state.scars.push(scar);
    }

    /// Checks that no surface is worn through.
    ///
    /// # Errors
    /// Returns the surface that is worn through, and where.
    pub fn check_worn_through(&self) -> Result<(), StepError> {
        match &self.state.worn_through {
            None => Ok(()),
            Some(source) => Err(StepError::WornThrough {
                step: self.state.steps,
                time: self.state.time,
                source: source.clone(),
            }),
        }
    }
}

/// Removes the volumes worn in the step from the scars.
fn apply_losses<S: Space>(s: &mut Simulation<S>) {
    let losses = s.state.network.losses.take();
    for loss in losses.iter().flatten() {
        let contact = &s.state.network.contacts[loss.contact as usize];
        let surface = contact.key.surface();
        let mut scars = s.state.scars.iter();
        let Some(scar) = scars.position(|s| Some(s.surface) == surface) else {
            continue;
        };
        let below = s.worn_shares(contact).map(|shares| {
            let shares = shares.iter().map(|(k, part)| (*k as usize, *part));
            shares.collect::<Vec<_>>()
        });
        let scar = &mut s.state.scars[scar];
        let worn = match below {
            Some(shares) => scar.wear_vertices(shares, loss.volume),
            None => {
                let carried = &s.shapes.surfaces[scar.surface];
                let rotation = &s.state.bodies.rotation[carried.body as usize];
                let closest_point = closest_point(carried, rotation, &contact.arms[1]);
                scar.wear_at(&s.shapes, &closest_point, loss.volume)
            }
        };
        s.state.worn_through = s.state.worn_through.take().or(worn.err());
    }
    s.state.network.losses = losses;
}

fn lower<S: Space>(s: &mut Simulation<S>, due: impl Fn(&Scar<S>) -> bool) {
    let bound = 0.5 * s.state.network.skin;
    let mut far = false;
    for scar in s.state.scars.iter_mut().filter(|scar| due(scar)) {
        far |= scar.apply_depth(&mut s.shapes, bound);
    }
    if far {
        s.state.network.forget_neighbours();
    }
}
