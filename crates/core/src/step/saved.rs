//! State of a simulation between steps: the content of a checkpoint.
//!
//! Everything else (shapes, laws, options) follows from the case and is built again. Work arrays of a step
//! (forms, columns, the solver's problem and its colouring) are not saved; they depend only on this state.

use super::Simulation;
use super::control::Control;
use crate::bodies::Bodies;
use crate::contact::Network;
use crate::energy::Energy;
use crate::geometry::space::Space;
use crate::laws::Kind;
use crate::laws::pass::Carried;
use crate::solve::AutoState;
use crate::wear::{Scar, WornThrough};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// State of a simulation between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Saved<'a, S: Space> {
    bodies: Cow<'a, Bodies<S>>,
    /// The name of each dynamical system, and what it saves of itself.
    systems: Vec<(String, Vec<u8>)>,
    network: Cow<'a, Network<S>>,
    gravity: S::Vector,
    tolerance: f64,
    /// Parameters of the contact law of each interface, which phases may change.
    contact_parameters: Vec<Vec<f64>>,
    time: f64,
    time_excess: f64,
    steps: u64,
    lifted: f64,
    energy: Energy,
    received: Vec<(S::Vector, S::Spin)>,
    scars: Cow<'a, [Scar<S>]>,
    worn_through: Option<WornThrough>,
    control: Control<S>,
    habit: AutoState,
    carried: Carried,
    /// Whether the processes have acted on the state, see [`Simulation::between_steps`].
    settled: bool,
}

impl<S: Space> Saved<'_, S> {
    /// Returns the number of completed steps.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Returns whether the state belongs to a scene with the same numbers of bodies, interfaces and scars.
    fn fits(&self, s: &Simulation<S>) -> bool {
        let parameters = self.contact_parameters.iter().map(Vec::len);
        self.bodies.len() == s.bodies.len()
            && self.bodies.is_complete()
            && self.bodies.carriers == s.bodies.carriers
            && self.bodies.driven.len() == s.bodies.driven.len()
            && (self.bodies.driven.iter().zip(&s.bodies.driven)).all(|(a, b)| a.body == b.body)
            && self.network.names_bodies_below(s.bodies.len())
            && self.received.len() == s.received.len()
            && self.scars.len() == s.scars.len()
            && self.network.memory.len() == s.network.memory.len()
            && parameters.eq(s.laws.iter().map(|l| l.contact().parameters.len()))
    }
}

impl<S: Space> Simulation<S> {
    /// Returns the state to save.
    pub fn save(&self) -> Saved<'_, S> {
        // Named one by one: a new field does not compile before it is state here or known to be none.
        let Self {
            // State.
            bodies,
            systems,
            laws,
            network,
            gravity,
            solver,
            time,
            time_excess,
            steps,
            lifted,
            energy,
            received,
            scars,
            worn_through,
            control,
            habit,
            passes,
            settled,
            // Follows from the state.
            started: _,
            // The case gives it; of the laws and the solver phases change a part.
            shapes: _,
            table: _,
            scheme: _,
            correction: _,
            projection: _,
            coupling: _,
            // What carries the fields is registered by the program.
            fields: _,
            // Processes save themselves, see [`Simulation::save_processes`].
            processes: _,
            // Of one step alone.
            workspace: _,
        } = self;
        let parameters = laws.iter().map(|l| l.contact().parameters.clone());
        Saved {
            bodies: Cow::Borrowed(bodies),
            systems: systems.save(),
            network: Cow::Borrowed(network),
            gravity: *gravity,
            tolerance: solver.tolerance,
            contact_parameters: parameters.collect(),
            time: *time,
            time_excess: *time_excess,
            steps: *steps,
            lifted: *lifted,
            energy: *energy,
            received: received.clone(),
            scars: Cow::Borrowed(scars),
            worn_through: worn_through.clone(),
            control: control.clone(),
            habit: *habit,
            carried: passes.carried(),
            settled: *settled,
        }
    }

    /// Restores a saved state into a simulation that was built from the same case and has not stepped. The
    /// next step gives the same bits as in the saved run. Returns false, and changes nothing, if the state
    /// belongs to another case.
    #[must_use]
    pub fn restore(&mut self, saved: Saved<'_, S>) -> bool {
        if !saved.fits(self) {
            return false;
        }
        let Some(systems) = self.systems.restored(&saved.systems) else {
            return false;
        };
        self.systems = systems;
        self.settled = saved.settled;
        self.bodies = saved.bodies.into_owned();
        let kept = std::mem::replace(&mut self.network, saved.network.into_owned());
        // Results of a step are recorded again where an output requests them.
        self.network.spent = kept.spent;
        self.network.losses = kept.losses;
        self.gravity = saved.gravity;
        self.solver.tolerance = saved.tolerance;
        for (law, values) in self.laws.iter_mut().zip(saved.contact_parameters) {
            if let Some(parameters) = law.parameters_mut(Kind::CONTACT) {
                *parameters = values;
            }
        }
        (self.time, self.steps) = (saved.time, saved.steps);
        self.time_excess = saved.time_excess;
        self.started = self.motion_of_driven();
        self.lifted = saved.lifted;
        self.energy = saved.energy;
        self.received = saved.received;
        self.scars = saved.scars.into_owned();
        for scar in &self.scars {
            scar.show_again(&mut self.shapes);
        }
        self.worn_through = saved.worn_through;
        let phases = std::mem::take(&mut self.control.phases);
        self.control = saved.control;
        self.control.phases = phases;
        self.habit = saved.habit;
        self.passes.carry_on(saved.carried);
        self.measure_areas();
        true
    }
}
