//! The time step, compiled once for each dimension, so that dependent crates do not compile the solver
//! again.

use super::{Simulation, StepError, StepReport};
use crate::geometry::space::{Dim2, Dim3, Space};

/// A dimension for which this crate compiles the time step.
pub trait Steps: Space {
    /// Performs one step of a scene; see [`Simulation::step`].
    ///
    /// # Errors
    /// As [`Simulation::step`].
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError>;
}

impl Steps for Dim2 {
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError> {
        simulation.one_step()
    }
}

impl Steps for Dim3 {
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError> {
        simulation.one_step()
    }
}

impl<S: Steps> Simulation<S> {
    /// One step of h. Processes act at its named moments, see [`crate::process`]; those that are due between the last step and
    /// this one first, where [`Simulation::between_steps`] was not called.
    ///
    /// # Errors
    /// A law or a process failed, the method does not support what the laws require, or a velocity is not finite; the state is
    /// then that of the failed step, or of the end of the previous one if a process failed between the two. A surface was worn
    /// through in the previous step; the state is then that at its end.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        S::step(self)
    }
}
