//! Recession: worn surfaces are lowered by the depth of their scars.
//!
//! What a step wears off is put on the scars with the closest points of its contacts, at q_m; that
//! of a contact on a mean place on all vertices below the facets of its point
//! ([`crate::geometry::mortar`]). The surfaces fall after the step's motion: the gap that opens is
//! met by the next step's detection. Nobody does work in between: a load that sinks into the gap
//! gives its potential energy in the next step, as it does over any open gap.

use super::{Process, ProcessError};
use crate::geometry::space::Space;
use crate::step::{Simulation, StepError, StepReport};
use crate::wear::scar::{Scar, closest_point};

/// Puts what contacts wear off on the scars of a simulation, and lowers its surfaces. It carries
/// nothing: the scars are part of the state of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Recession;

impl<S: Space> Process<S> for Recession {
    fn name(&self) -> &str {
        "wear recession"
    }

    fn repeats(&self) -> bool {
        true
    }

    /// Refuses a step of a surface that is worn through.
    fn at_start(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        s.check_worn_through()?;
        s.state.network.losses.get_or_insert_default();
        Ok(())
    }

    fn after_solve(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        put_losses(s);
        Ok(())
    }

    /// Lowers the surfaces that are due in this step, at the interval `every` of their scars.
    fn after_move(&mut self, s: &mut Simulation<S>, _: &StepReport) -> Result<(), ProcessError> {
        let steps = s.state.steps;
        // A step that wears for many is followed at once: the contact must find what protrudes.
        let many = s.state.network.cycle_multiplier > 1.0;
        lower(s, |scar| many || steps.is_multiple_of(scar.every));
        Ok(())
    }

    /// Lowers all surfaces to the depth of their scars, whatever their interval.
    fn at_end(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        lower(s, |_| true);
        Ok(())
    }
}

impl<S: Space> Simulation<S> {
    /// Has a surface worn by its contacts; the network records their losses from the next step on.
    pub fn follow_wear(&mut self, scar: Scar<S>) {
        if self.process::<Recession>().is_none() {
            self.add_process(Recession);
        }
        self.state.scars.push(scar);
    }

    /// Whether no surface is worn through.
    ///
    /// # Errors
    /// Which is, and where.
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

/// Puts what the step wore off on the scars.
fn put_losses<S: Space>(s: &mut Simulation<S>) {
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
        let put = match below {
            Some(shares) => scar.share(shares, loss.volume),
            None => {
                let carried = &s.shapes.surfaces[scar.surface];
                let rotation = &s.state.bodies.rotation[carried.body as usize];
                let closest_point = closest_point(carried, rotation, &contact.arms[1]);
                scar.put(&s.shapes, &closest_point, loss.volume)
            }
        };
        s.state.worn_through = s.state.worn_through.take().or(put.err());
    }
    s.state.network.losses = losses;
}

fn lower<S: Space>(s: &mut Simulation<S>, due: impl Fn(&Scar<S>) -> bool) {
    let bound = 0.5 * s.state.network.skin;
    let mut far = false;
    for scar in s.state.scars.iter_mut().filter(|scar| due(scar)) {
        far |= scar.show(&mut s.shapes, bound);
    }
    if far {
        s.state.network.forget_neighbours();
    }
}
