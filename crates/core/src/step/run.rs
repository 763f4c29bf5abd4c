//! Many steps, watched and stopped by the caller.

use super::{Simulation, StepError, StepReport};
use crate::geometry::space::Space;
use std::ops::ControlFlow;

impl<S: Space> Simulation<S> {
    /// Steps until a time (s) is reached, and hands the state and the report to `after` at the end of every step, which
    /// stops the run by [`ControlFlow::Break`]; so does who wants to end with the phases of a case, see [`Simulation::finished`]. It comes back whether and why it was stopped; the simulation can go on.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn run_until<B>(
        &mut self,
        end: f64,
        mut after: impl FnMut(&Self, &StepReport) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, StepError> {
        // An end that a whole number of steps reaches up to rounding takes no step more.
        while self.state.time < end - 1e-6 * self.options.scheme.h {
            let report = self.step()?;
            if let ControlFlow::Break(reason) = after(self, &report) {
                return Ok(ControlFlow::Break(reason));
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}
