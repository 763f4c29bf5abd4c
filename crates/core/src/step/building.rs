//! Additions to a scene, and external actions on it.

use super::process::Process;
use super::{Simulation, control, motion};
use crate::bodies::DynamicalSystem;
use crate::geometry::algebra::{MatrixLike, VectorLike};
use crate::geometry::space::Space;

impl<S: Space> Simulation<S> {
    /// Adds a dynamical system to a scene that has not stepped, with a body for each contactor and
    /// its ball, point or surface; gives its index. The bodies are
    /// [`crate::bodies::Systems::bodies`]: other shapes may be added to them.
    ///
    /// The energy that the system stores counts as work done on it before the start.
    pub fn add_system(&mut self, system: Box<dyn DynamicalSystem<S>>) -> usize {
        motion::add_system(self, system)
    }

    /// Adds a process, which acts from now on, after earlier ones.
    pub fn add_process(&mut self, process: impl Process<S>) {
        self.processes.push(Box::new(process));
    }

    /// Adds a feature of the core, which acts from now on, before features added earlier and before
    /// all processes. Its data from step to step are in the state.
    pub(crate) fn add_feature(&mut self, feature: impl Process<S>) {
        self.features.insert(0, Box::new(feature));
    }

    /// Gives driven bodies their imposed velocities at time zero, for code that inspects the scene
    /// before the first step. The drives of the first phase are included.
    pub fn set_in_motion(&mut self) {
        control::set_in_motion(self);
    }

    /// Measures the loaded areas of all servo pressures.
    pub fn measure_areas(&mut self) {
        for servo in &self.state.control.servos {
            servo.measure(&mut self.state.bodies, &mut self.state.systems);
        }
    }

    /// Applies an impulse (N s; N s/m in 2D) at the centre of a body and an angular impulse (N m s;
    /// N s in 2D), and adds the work to the energy ledger. Degrees of freedom with imposed motion
    /// are not affected, nor is a body that represents a contactor of a dynamical system.
    pub fn apply_impulse(&mut self, body: usize, impulse: &S::Vector, angular: &S::Spin) {
        let bodies = &mut self.state.bodies;
        let before = bodies.energy_of(body);
        bodies.velocity[body] += impulse.scaled_by(&bodies.inverse_mass[body]);
        let spin = bodies.inverse_tensor(body).apply(angular);
        bodies.spin[body] += spin;
        let work = bodies.energy_of(body) - before;
        self.workspace.pushed = true;
        self.state.energy.raise_scale(work);
        self.state.energy.external_work += work;
    }

    /// Removes a grain permanently: it is at rest, has no contacts, and its bonds break. Its
    /// kinetic energy becomes an entry of the energy ledger.
    pub fn remove_body(&mut self, body: usize) {
        let energy = self.state.bodies.energy_of(body);
        self.state.energy.carried += energy;
        self.state.energy.kinetic -= energy;
        self.state.bodies.remove_body(body);
        self.notify(|process, simulation| process.body_removed(simulation, body));
        self.state.network.forget_neighbours();
    }
}
