//! The stepper's part of processes: when they act, and how they are kept.

use super::process::{Process, ProcessError};
use super::{Simulation, StepError};
use crate::code::CodeError;
use crate::geometry::algebra::{MatrixLike, VectorLike};
use crate::geometry::space::Space;
use std::any::Any;

/// The state of one process: its name and its bytes.
pub type ProcessState = (String, Vec<u8>);

impl<S: Space> Simulation<S> {
    /// Has a process act from now on, after those that are there.
    pub fn add_process(&mut self, process: impl Process<S>) {
        self.processes.push(Box::new(process));
    }

    /// The process of a type, the first where there are several.
    pub fn process<P: Process<S>>(&self) -> Option<&P> {
        let mut list = self.processes.iter();
        list.find_map(|p| (p.as_ref() as &dyn Any).downcast_ref())
    }

    /// Has the processes act on the state after a step, once a step. The next step does it first where this was not called; who
    /// looks at each step calls it when that is done.
    ///
    /// # Errors
    /// Why a process cannot go on. The processes after it have not acted then, and do not act on this state any more: the
    /// simulation has ended.
    pub fn between_steps(&mut self) -> Result<(), StepError> {
        if std::mem::replace(&mut self.state.settled, true) {
            return Ok(());
        }
        self.act(|process, simulation| process.between_steps(simulation))
    }

    /// Has the processes do after the last step what they do every so many steps, and first what is due between steps.
    ///
    /// # Errors
    /// Why a process cannot.
    pub fn end(&mut self) -> Result<(), StepError> {
        self.between_steps()?;
        self.act(|process, simulation| process.at_end(simulation))
    }

    /// Whether the last phase has come to its end, or a process has reached what it was to reach.
    pub fn finished(&self) -> bool {
        self.phases_finished() || self.processes.iter().any(|p| p.finished())
    }

    /// Gives a body an impulse (N s; N s/m in 2D) at its centre and an angular impulse (N m s; N s in 2D), and books the work in
    /// the energy ledger. Degrees of freedom whose motion is imposed take none, nor does a body that stands for a contactor of a
    /// dynamical system.
    pub fn apply_impulse(&mut self, body: usize, impulse: &S::Vector, angular: &S::Spin) {
        let bodies = &mut self.state.bodies;
        let before = bodies.energy_of(body);
        bodies.velocity[body] += impulse.scaled_by(&bodies.inverse_mass[body]);
        let spin = bodies.inverse_tensor(body).apply(angular);
        bodies.spin[body] += spin;
        let work = bodies.energy_of(body) - before;
        self.workspace.pushed = true;
        self.state.energy.see(work);
        self.state.energy.external_work += work;
    }

    /// What the processes carry from step to step, in their order.
    ///
    /// # Errors
    /// One cannot be put into bytes.
    pub fn save_processes(&self) -> Result<Vec<ProcessState>, CodeError> {
        let list = self.processes.iter();
        list.map(|p| Ok((p.name().to_owned(), p.save()?))).collect()
    }

    /// Has the processes go on from what [`Simulation::save_processes`] gave of a simulation with the same ones.
    ///
    /// # Errors
    /// The states are of other processes; where one cannot be read, those before it are restored already.
    pub fn restore_processes(&mut self, from: &[ProcessState]) -> Result<(), CodeError> {
        let names = self.processes.iter().map(|p| p.name());
        if !names.eq(from.iter().map(|(name, _)| name.as_str())) {
            return Err(CodeError::other("processes"));
        }
        let mut pairs = self.processes.iter_mut().zip(from);
        pairs.try_for_each(|(process, (_, bytes))| process.restore(bytes))
    }

    /// Has all processes act in their order, until one refuses.
    pub(super) fn act(
        &mut self,
        mut moment: impl FnMut(&mut dyn Process<S>, &mut Self) -> Result<(), ProcessError>,
    ) -> Result<(), StepError> {
        let mut list = std::mem::take(&mut self.processes);
        let failed = list.iter_mut().find_map(|process| {
            let source = moment(process.as_mut(), self).err()?;
            Some((process.name().to_owned(), source))
        });
        // A process that was added acts after those that were there; while they acted it could not see them.
        let added = std::mem::take(&mut self.processes);
        for process in added {
            if list.iter().all(|p| p.name() != process.name()) {
                list.push(process);
            }
        }
        self.processes = list;
        match failed {
            None => Ok(()),
            Some((process, source)) => Err(StepError::Process {
                step: self.state.steps,
                time: self.state.time,
                process,
                source,
            }),
        }
    }
}
