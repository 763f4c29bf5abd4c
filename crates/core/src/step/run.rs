//! Steps, and the moments at which processes act.

use super::process::{Process, ProcessError};
use super::{Simulation, StepError, StepReport};
use crate::geometry::space::Space;
use std::ops::ControlFlow;

impl<S: Space> Simulation<S> {
    /// Makes steps until a time (s) is reached, and calls `after` with the state and the report at
    /// the end of every step. Break from `after` to stop early, for instance where the phases of a
    /// case have ended ([`Simulation::finished`]). Returns why the run stopped early, if it did;
    /// the simulation can go on.
    ///
    /// # Errors
    /// Returns the errors of [`Simulation::step`].
    pub fn run_until<B>(
        &mut self,
        end: f64,
        mut after: impl FnMut(&Self, &StepReport) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, StepError> {
        // If a whole number of steps reaches the end up to rounding, no further step is made.
        while self.state.time < end - 1e-6 * self.options.scheme.h {
            let report = self.step()?;
            if let ControlFlow::Break(reason) = after(self, &report) {
                return Ok(ControlFlow::Break(reason));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Calls the processes between two steps, once for each step. An observer of each step calls
    /// this after reading the state; otherwise the next step calls it first.
    ///
    /// # Errors
    /// Returns why a process cannot continue. The processes after it have not acted, and will not
    /// act on this state: the simulation has ended.
    pub fn between_steps(&mut self) -> Result<(), StepError> {
        if std::mem::replace(&mut self.state.settled, true) {
            return Ok(());
        }
        self.act(Process::between_steps)
    }

    /// Calls the processes after the last step, for actions at intervals of steps; actions that are
    /// due between steps come first.
    ///
    /// # Errors
    /// Returns why a process cannot complete.
    pub fn end(&mut self) -> Result<(), StepError> {
        self.between_steps()?;
        self.act(Process::at_end)
    }

    /// Calls the features and then the processes in their order, until one fails.
    pub(super) fn act(
        &mut self,
        mut moment: impl FnMut(&mut (dyn Process<S> + 'static), &mut Self) -> Result<(), ProcessError>,
    ) -> Result<(), StepError> {
        let mut features = std::mem::take(&mut self.features);
        let acted = features
            .iter_mut()
            .try_for_each(|f| self.act_one(f, &mut moment));
        self.features = features;
        acted?;
        let mut list = std::mem::take(&mut self.processes);
        let acted = list
            .iter_mut()
            .try_for_each(|p| self.act_one(p, &mut moment));
        // A process that was added acts after the existing ones; while they act it cannot see them.
        let added = std::mem::take(&mut self.processes);
        for process in added {
            if list.iter().all(|p| p.name() != process.name()) {
                list.push(process);
            }
        }
        self.processes = list;
        acted
    }

    fn act_one(
        &mut self,
        process: &mut Box<dyn Process<S>>,
        moment: &mut impl FnMut(&mut (dyn Process<S> + 'static), &mut Self) -> Result<(), ProcessError>,
    ) -> Result<(), StepError> {
        let Err(source) = moment(process.as_mut(), self) else {
            return Ok(());
        };
        Err(match source.downcast() {
            Ok(own) => *own,
            Err(source) => StepError::Process {
                step: self.state.steps,
                time: self.state.time,
                process: process.name().to_owned(),
                source,
            },
        })
    }

    /// Notifies features and processes that the state was replaced, or that a body was removed.
    pub(super) fn notify(
        &mut self,
        mut what: impl FnMut(&mut (dyn Process<S> + 'static), &mut Self),
    ) {
        let acted = self.act(|process, simulation| {
            what(process, simulation);
            Ok(())
        });
        debug_assert!(acted.is_ok(), "nothing refused");
    }
}
