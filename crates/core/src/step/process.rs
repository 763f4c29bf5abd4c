//! Processes act on a simulation at the named moments of its steps, see [`crate::process`].

pub use super::error::ProcessError;
use super::{Simulation, StepReport};
use crate::encoding::EncodingError;
use crate::geometry::space::Space;
use std::any::Any;
use std::fmt::Debug;

/// A process acts on a simulation at the named moments of a step, see [`crate::process`]. Moments
/// that it does not need may be left out. While a process acts, [`Simulation::process`] finds no
/// other.
///
/// An error at a moment ends the step with [`super::StepError::Process`], unless it is a
/// [`super::StepError`] itself; the state is then that of this moment.
pub trait Process<S: Space>: Any + Debug + Send + Sync {
    /// Returns the name, which identifies the process in checkpoints and messages.
    fn name(&self) -> &str;

    /// Acts at the start of a step, before any of its stages.
    ///
    /// # Errors
    /// Returns why the step cannot be made.
    fn at_start(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts when imposed motions have their velocities of the step. This is the moment at which to
    /// apply forces to bodies, see [`Simulation::apply_impulse`].
    ///
    /// # Errors
    /// Returns why the process cannot continue.
    fn before_detection(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts when the contacts of the step are found, at q_m, before the laws are called: quantities
    /// of contacts that laws read are set here. It is called again in the same step if the
    /// velocities close further contacts.
    ///
    /// # Errors
    /// Returns why the process cannot continue.
    fn contacts_found(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts when impulses are known and the laws have updated damage and wear; bodies are at q_m.
    ///
    /// # Errors
    /// Returns why the process cannot continue.
    fn after_solve(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts when bodies and time are at the end of the step.
    ///
    /// # Errors
    /// Returns why the process cannot continue.
    fn after_move(&mut self, _: &mut Simulation<S>, _: &StepReport) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts after observers of the step, and before the next step: bodies are removed and the next
    /// step is prepared here.
    ///
    /// # Errors
    /// Returns why the process cannot continue.
    fn between_steps(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Acts after the last step of a run: actions at intervals of steps are completed here.
    ///
    /// # Errors
    /// Returns why the process cannot complete.
    fn at_end(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Called when a body has been removed from the scene.
    fn body_removed(&mut self, _: &mut Simulation<S>, _body: usize) {}

    /// Called when the state has been replaced, see [`Simulation::restore`] and
    /// [`Simulation::repeat`]: data outside the state that depend on it, such as the sizes of
    /// shapes, are updated here.
    fn follow_state(&mut self, _: &mut Simulation<S>) {}

    /// Returns whether the process has reached its goal, so that the run may end.
    fn finished(&self) -> bool {
        false
    }

    /// Returns whether steps in which the process acts may be repeated from a saved state, see
    /// [`Simulation::repeat`]: all its effects are undone by restoring the simulation and by
    /// [`Process::restore`]. The default is no; the error of a run with such a process is not
    /// estimated.
    fn repeats(&self) -> bool {
        false
    }

    /// Returns the state that the process carries from step to step, as bytes for a checkpoint
    /// ([`crate::encoding::encode`]); empty if there is none.
    ///
    /// # Errors
    /// The state cannot be encoded.
    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        Ok(Vec::new())
    }

    /// Restores the state that [`Process::save`] returned.
    ///
    /// # Errors
    /// The bytes are of something else.
    fn restore(&mut self, _: &[u8]) -> Result<(), EncodingError> {
        Ok(())
    }
}
