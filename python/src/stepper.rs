//! A simulation with the observers of a run, stepped by hand.

use fretwork::AnySimulation;
use fretwork::record::{Observers, run_observers};
use fretwork::scene::{Built, LoadedCase, processes};
use fretwork::step::{StepError, StepReport};

/// Time and step of a simulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    /// Time (s).
    pub(crate) time: f64,
    /// Length of a step (s).
    pub(crate) step: f64,
}

/// A simulation, the observers whose columns are in the statistics of a run, and the report of the
/// last step.
#[derive(Debug)]
pub(crate) struct Stepper {
    pub(crate) simulation: AnySimulation,
    pub(crate) observers: Observers,
    pub(crate) report: Option<StepReport>,
}

impl Stepper {
    pub(crate) fn new(loaded: &LoadedCase, built: Built, threads: usize) -> Self {
        let mut simulation = built.simulation;
        simulation.options_mut().solver.parallel = threads > 1;
        processes::install(&loaded.case, simulation.setup());
        let mut observers = run_observers(loaded, simulation.view());
        observers.begin(&mut *simulation);
        Self {
            simulation,
            observers,
            report: None,
        }
    }

    pub(crate) fn moment(&self) -> Moment {
        Moment {
            time: self.simulation.time(),
            step: self.simulation.options().scheme.h,
        }
    }

    /// Makes a step, as a run does.
    pub(crate) fn step(&mut self) -> Result<(), StepError> {
        let s = &mut self.simulation;
        let phase = s.phase();
        self.observers.before_step(s.view());
        let report = s.step()?;
        self.observers.after_step(s.view(), &report);
        self.report = Some(report);
        if phase == 1 && s.phase() == 2 {
            self.observers.begin(&mut **s);
        }
        s.between_steps()?;
        self.observers.after_processes(s.view());
        s.check_worn_through()
    }
}
