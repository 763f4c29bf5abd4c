//! Stepping a simulation, and saving and restoring its state.

use super::RunView;
use crate::encoding::{EncodingError, decode_first, encode};
use crate::geometry::space::{Space, VectorLike, spin_about};
use crate::solve::local::LocalProblem;
use crate::step::{Options, ProcessState, RepeatError, Simulation, StepError, StepReport};

/// A simulation that is stepped. Its methods are those of [`Simulation`], where their errors are
/// described.
pub trait RunControl: RunView + Send {
    /// Makes one step; see [`Simulation::step`].
    ///
    /// # Errors
    /// The errors of [`Simulation::step`].
    fn step(&mut self) -> Result<StepReport, StepError>;
    /// Detects the contacts at the current positions, without an alert distance.
    fn detect(&mut self);
    /// Calls the processes that are due; see [`Simulation::between_steps`].
    ///
    /// # Errors
    /// The errors of [`Simulation::between_steps`].
    fn between_steps(&mut self) -> Result<(), StepError>;
    /// Ends the processes; see [`Simulation::end`].
    ///
    /// # Errors
    /// The errors of [`Simulation::end`].
    fn end(&mut self) -> Result<(), StepError>;
    /// Whether the current phase is repeated later.
    fn phase_recurs(&self) -> bool;
    /// Checks that no surface is worn through.
    ///
    /// # Errors
    /// A surface is worn through.
    fn check_worn_through(&self) -> Result<(), StepError>;
    /// Returns the mutable options of the computation.
    fn options_mut(&mut self) -> &mut Options;
    /// Continues with another time step (s); see [`Simulation::change_step`].
    fn change_step(&mut self, h: f64);
    /// Continues with steps that each span this number of steps of the case, of `h` (s); see
    /// [`Simulation::span_steps`].
    fn span_steps(&mut self, h: f64, count: u32);
    /// Replaces the tolerance that the current phase has set, see [`RunView::phase_tolerance`].
    fn set_phase_tolerance(&mut self, tolerance: Option<f64>);
    /// Applies an impulse to a body and adds its work to the ledger; see
    /// [`Simulation::apply_impulse`].
    fn apply_impulse(&mut self, body: usize, impulse: [f64; 3], angular: [f64; 3]);
    /// The problem of the last step, solved; see [`Simulation::local_problem`].
    fn local_problem(&self) -> Option<LocalProblem>;

    /// The state as bytes.
    ///
    /// # Errors
    /// The state cannot be serialised.
    fn save(&self) -> Result<Vec<u8>, EncodingError>;
    /// Continues from the state that [`RunControl::save`] wrote at the start of the bytes; returns
    /// the bytes after it, or `None` if the state belongs to another case, or if this simulation
    /// has made steps. See [`Simulation::restore`].
    ///
    /// # Errors
    /// The bytes are not a state.
    fn restore<'a>(&mut self, bytes: &'a [u8]) -> Result<Option<&'a [u8]>, EncodingError>;
    /// The states of the processes.
    ///
    /// # Errors
    /// A state cannot be serialised.
    fn save_processes(&self) -> Result<Vec<ProcessState>, EncodingError>;
    /// Restores the states of the processes.
    ///
    /// # Errors
    /// The states belong to other processes.
    fn restore_processes(&mut self, from: &[ProcessState]) -> Result<(), EncodingError>;
    /// Calls `trial`, which may make steps and change options, and restores the state before it;
    /// see [`Simulation::repeat`].
    ///
    /// # Errors
    /// The errors of [`Simulation::repeat`].
    fn repeat(&mut self, trial: &mut dyn FnMut(&mut dyn RunControl)) -> Result<(), RepeatError>;
    /// Lets `trial` make steps, and restores the state before it if it returns false
    /// ([`Simulation::attempt`]). Returns what `trial` returned.
    ///
    /// # Errors
    /// Returns the errors of [`Simulation::attempt`].
    fn attempt(
        &mut self,
        trial: &mut dyn FnMut(&mut dyn RunControl) -> bool,
    ) -> Result<bool, RepeatError>;
}

impl dyn RunControl + '_ {
    /// Returns the result of `trial`, and restores the state before it, see [`RunControl::repeat`].
    ///
    /// # Errors
    /// Returns the errors of [`RunControl::repeat`].
    pub fn repeated<R>(
        &mut self,
        trial: impl FnOnce(&mut dyn RunControl) -> R,
    ) -> Result<R, RepeatError> {
        let (mut trial, mut result) = (Some(trial), None);
        self.repeat(&mut |run| result = trial.take().map(|trial| trial(run)))?;
        match result {
            Some(result) => Ok(result),
            None => unreachable!("the trial is made once"),
        }
    }

    /// Returns the result of `trial`, and restores the state before it if that is an error, see
    /// [`RunControl::attempt`].
    ///
    /// # Errors
    /// Returns the errors of [`RunControl::attempt`].
    pub fn attempted<R, E>(
        &mut self,
        trial: impl FnOnce(&mut dyn RunControl) -> Result<R, E>,
    ) -> Result<Result<R, E>, RepeatError> {
        let (mut trial, mut result) = (Some(trial), None);
        self.attempt(&mut |run| {
            result = trial.take().map(|trial| trial(run));
            matches!(result, Some(Ok(_)))
        })?;
        match result {
            Some(result) => Ok(result),
            None => unreachable!("the trial is made once"),
        }
    }
}

impl<S: Space> RunControl for Simulation<S> {
    fn step(&mut self) -> Result<StepReport, StepError> {
        self.step()
    }
    fn detect(&mut self) {
        self.detect();
    }
    fn between_steps(&mut self) -> Result<(), StepError> {
        self.between_steps()
    }
    fn end(&mut self) -> Result<(), StepError> {
        self.end()
    }
    fn phase_recurs(&self) -> bool {
        self.phase_recurs()
    }
    fn check_worn_through(&self) -> Result<(), StepError> {
        self.check_worn_through()
    }
    fn options_mut(&mut self) -> &mut Options {
        &mut self.options
    }
    fn change_step(&mut self, h: f64) {
        self.change_step(h);
    }
    fn span_steps(&mut self, h: f64, count: u32) {
        self.span_steps(h, count);
    }
    fn set_phase_tolerance(&mut self, tolerance: Option<f64>) {
        self.state.control.tolerance = tolerance;
    }
    fn apply_impulse(&mut self, body: usize, impulse: [f64; 3], angular: [f64; 3]) {
        let (impulse, angular) = (S::Vector::from_slice(&impulse), spin_about::<S>(&angular));
        self.apply_impulse(body, &impulse, &angular);
    }
    fn local_problem(&self) -> Option<LocalProblem> {
        self.local_problem()
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }
    fn restore<'a>(&mut self, bytes: &'a [u8]) -> Result<Option<&'a [u8]>, EncodingError> {
        let (state, rest) = decode_first(bytes)?;
        Ok(self.restore(state).then_some(rest))
    }
    fn save_processes(&self) -> Result<Vec<ProcessState>, EncodingError> {
        self.save_processes()
    }
    fn restore_processes(&mut self, from: &[ProcessState]) -> Result<(), EncodingError> {
        self.restore_processes(from)
    }
    fn repeat(&mut self, trial: &mut dyn FnMut(&mut dyn RunControl)) -> Result<(), RepeatError> {
        self.repeat(|s| trial(s))
    }
    fn attempt(
        &mut self,
        trial: &mut dyn FnMut(&mut dyn RunControl) -> bool,
    ) -> Result<bool, RepeatError> {
        let made = self.attempt(|s| if trial(s) { Ok(()) } else { Err(()) });
        Ok(made?.is_ok())
    }
}
