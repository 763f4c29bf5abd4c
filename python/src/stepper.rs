//! A simulation with the observers of a run, stepped by hand.

use fretwork::geometry::space::Space;
use fretwork::record::{Observers, run_observers};
use fretwork::scene::{Built, Loaded, processes};
use fretwork::step::{Simulation, StepError, StepReport};

/// Where a simulation is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    /// Time (s).
    pub(crate) time: f64,
    /// Length of a step (s).
    pub(crate) step: f64,
}

/// A simulation, the observers whose columns the statistics of a run have, and the report of the
/// last step.
#[derive(Debug)]
pub(crate) struct Stepper<S: Space> {
    pub(crate) simulation: Simulation<S>,
    pub(crate) observers: Observers,
    pub(crate) report: Option<StepReport>,
}

impl<S: Space> Stepper<S> {
    pub(crate) fn new(loaded: &Loaded, built: Built<S>, threads: usize) -> Box<Self> {
        let mut simulation = built.simulation;
        simulation.options.solver.parallel = threads > 1;
        processes::install(&loaded.case, &mut simulation);
        let mut observers = run_observers(loaded, &simulation);
        observers.begin(&mut simulation);
        Box::new(Self {
            simulation,
            observers,
            report: None,
        })
    }

    pub(crate) fn moment(&self) -> Moment {
        Moment {
            time: self.simulation.state.time,
            step: self.simulation.options.scheme.h,
        }
    }

    /// A step, as a run makes it.
    pub(crate) fn step(&mut self) -> Result<(), StepError> {
        let s = &mut self.simulation;
        let phase = s.state.control.phase();
        self.observers.before_step(s);
        let report = s.step()?;
        self.observers.after_step(s, &report);
        self.report = Some(report);
        if phase == 1 && s.state.control.phase() == 2 {
            self.observers.begin(s);
        }
        s.between_steps()?;
        self.observers.after_processes(s);
        s.check_worn_through()
    }
}
