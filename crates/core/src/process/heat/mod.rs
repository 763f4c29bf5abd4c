//! Heat and current in the step: laws receive the temperatures at its start, and heat flows at its
//! end.
//!
//! Temperatures and the account of heat are in [`crate::step::State::heat`], so that a checkpoint
//! contains them.

mod flow;
mod temperatures;

use super::{Process, ProcessError};
use crate::geometry::space::Space;
use crate::heat::{Heat, HeatState};
use crate::step::fields::{heat_of_contacts, heat_of_grains};
use crate::step::{Simulation, StepError};
use std::sync::Arc;

/// Heat and current, as given by a case.
#[derive(Debug)]
pub struct HeatFlow(Arc<Heat>);

impl HeatFlow {
    /// Lets a simulation compute heat, and current if there is a circuit, from now on.
    pub fn add_to<S: Space>(s: &mut Simulation<S>, heat: Heat, state: HeatState) {
        s.fields.grains.add(heat_of_grains());
        for field in heat_of_contacts() {
            s.fields.contacts.add(field);
        }
        let heat = Arc::new(heat);
        s.heat = Some(Arc::clone(&heat));
        s.state.heat = Some(state);
        s.add_feature(Self(heat));
    }
}

impl<S: Space> Process<S> for HeatFlow {
    fn name(&self) -> &str {
        "heat"
    }

    fn at_start(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        s.state.network.dissipation.get_or_insert_default();
        Ok(())
    }

    fn contacts_found(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        temperatures::gather_temperatures(&self.0, s);
        Ok(())
    }

    fn after_solve(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        flow::conduct(&self.0, s).map_err(|source| {
            let (step, time) = (s.state.steps + 1, s.state.time);
            StepError::Heat { step, time, source }.into()
        })
    }

    /// Isolates a removed body from its surroundings.
    fn body_removed(&mut self, s: &mut Simulation<S>, body: usize) {
        if let Some(state) = &mut s.state.heat {
            for node in &mut state.nodes[self.0.nodes[body].range()] {
                node.surroundings = 0.0;
            }
        }
    }
}

/// Returns whether heat flows in the current step: the midpoint of the step counts.
pub(super) fn has_begun<S: Space>(heat: &Heat, s: &Simulation<S>) -> bool {
    s.state.time + 0.5 * s.options.scheme.h >= heat.start
}
