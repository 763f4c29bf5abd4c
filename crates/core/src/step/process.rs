//! A process: what acts on a simulation at the named moments of its steps, see [`crate::process`].

use super::{Simulation, StepReport};
use crate::code::CodeError;
use crate::geometry::space::Space;
use std::any::Any;
use std::fmt::Debug;

/// Why a process cannot go on; it ends the run.
pub type ProcessError = Box<dyn std::error::Error + Send + Sync>;

/// Something that acts on a simulation at the named moments of a step, see [`crate::process`]. All moments but those that it needs may be
/// left out. While a process acts, [`Simulation::process`] finds no other.
///
/// An error of a moment ends the step with [`super::StepError::Process`]; the state is then that of this moment.
pub trait Process<S: Space>: Any + Debug + Send + Sync {
    /// Its name: tells processes of one simulation apart in checkpoints and messages.
    fn name(&self) -> &str;

    /// At the start of a step, when imposed motions have their velocities of the step: where forces act on bodies, see
    /// [`Simulation::apply_impulse`].
    ///
    /// # Errors
    /// Why it cannot go on.
    fn before_detection(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// When impulses are known and the laws have committed their damage and wear; bodies are at q_m.
    ///
    /// # Errors
    /// Why it cannot go on.
    fn after_solve(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// When bodies and time are at the end of the step.
    ///
    /// # Errors
    /// Why it cannot go on.
    fn after_move(&mut self, _: &mut Simulation<S>, _: &StepReport) -> Result<(), ProcessError> {
        Ok(())
    }

    /// After what looks at the step has seen it, and before the next one: where bodies are taken out, and where the next step is
    /// prepared.
    ///
    /// # Errors
    /// Why it cannot go on.
    fn between_steps(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// After the last step of a run: what is otherwise done every so many steps is done now.
    ///
    /// # Errors
    /// Why it cannot.
    fn at_end(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// Whether what it was to reach is reached, so that the run may end.
    fn finished(&self) -> bool {
        false
    }

    /// Whether steps in which it acts may be repeated from a saved state, see [`Simulation::repeat`]: all that it does is undone by
    /// restoring the simulation and by [`Process::restore`]. A run with a process that says no, as by default, does not estimate its error.
    fn repeats(&self) -> bool {
        false
    }

    /// What it carries from step to step, as bytes for a checkpoint ([`crate::code::encode`]); none where it carries nothing.
    ///
    /// # Errors
    /// It cannot be put into bytes.
    fn save(&self) -> Result<Vec<u8>, CodeError> {
        Ok(Vec::new())
    }

    /// Goes on from what [`Process::save`] gave.
    ///
    /// # Errors
    /// The bytes are of something else.
    fn restore(&mut self, _: &[u8]) -> Result<(), CodeError> {
        Ok(())
    }
}
