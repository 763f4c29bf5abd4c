//! A process: what acts on a simulation at the named moments of its steps, see [`crate::process`].

pub use super::error::ProcessError;
use super::{Simulation, StepReport};
use crate::code::CodeError;
use crate::geometry::space::Space;
use std::any::Any;
use std::fmt::Debug;

/// Something that acts on a simulation at the named moments of a step, see [`crate::process`]. All
/// moments but those that it needs may be left out. While a process acts, [`Simulation::process`]
/// finds no other.
///
/// An error of a moment ends the step with [`super::StepError::Process`], unless it is a
/// [`super::StepError`] itself; the state is then that of this moment.
pub trait Process<S: Space>: Any + Debug + Send + Sync {
    /// Its name, which identifies it among the processes of a simulation in checkpoints and
    /// messages.
    fn name(&self) -> &str;

    /// At the start of a step, before anything of it is done.
    ///
    /// # Errors
    /// Why the step is not to be made.
    fn at_start(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// When imposed motions have their velocities of the step: where forces act on bodies, see
    /// [`Simulation::apply_impulse`].
    ///
    /// # Errors
    /// Why it cannot go on.
    fn before_detection(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// When the contacts of the step are found, at q_m, before the laws see them: what laws are to
    /// see of contacts is set here. Called again in the same step where its velocities close
    /// further contacts.
    ///
    /// # Errors
    /// Why it cannot go on.
    fn contacts_found(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        Ok(())
    }

    /// When impulses are known and the laws have committed their damage and wear; bodies are at
    /// q_m.
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

    /// After what looks at the step has seen it, and before the next one: where bodies are taken
    /// out, and where the next step is prepared.
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

    /// When a body has been removed from the scene.
    fn body_removed(&mut self, _: &mut Simulation<S>, _body: usize) {}

    /// When the state has been replaced, see [`Simulation::restore`] and [`Simulation::repeat`]:
    /// what follows the state elsewhere, such as the sizes of shapes, is brought up to date.
    fn follow_state(&mut self, _: &mut Simulation<S>) {}

    /// Whether what it was to reach is reached, so that the run may end.
    fn finished(&self) -> bool {
        false
    }

    /// Whether steps in which it acts may be repeated from a saved state, see
    /// [`Simulation::repeat`]: all that it does is undone by restoring the simulation and by
    /// [`Process::restore`]. A run with a process that says no, as by default, does not estimate
    /// its error.
    fn repeats(&self) -> bool {
        false
    }

    /// What it carries from step to step, as bytes for a checkpoint ([`crate::code::encode`]); none
    /// where it carries nothing.
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
