//! Coupling of damage and opening within a step.

use super::{agreement, systems};
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use crate::step::motion::{BodyVelocity, StepStart};
use crate::step::{Coupling, CouplingReport, Simulation, StepError, StepReport};
use std::time::Instant;

/// The fixed-point iteration of a step.
#[derive(Debug)]
pub(super) struct Progress {
    tolerance: f64,
    most: u32,
    report: CouplingReport,
}

impl Progress {
    pub fn new(coupling: &Coupling) -> Self {
        let (tolerance, most) = match coupling {
            Coupling::Explicit | Coupling::Midpoint => (0.0, 1),
            Coupling::Implicit {
                tolerance,
                max_iterations,
            } => (*tolerance, *max_iterations),
        };
        Self {
            tolerance,
            most,
            report: CouplingReport {
                change: f64::INFINITY,
                ..CouplingReport::default()
            },
        }
    }

    /// Records the change of damage of an iteration; returns whether to stop.
    pub fn ends(&mut self, change: f64) -> bool {
        self.report.iterations += 1;
        self.report.change = change;
        self.report.missed = change > self.tolerance;
        !self.report.missed || self.report.iterations >= self.most
    }

    pub fn report(&self) -> CouplingReport {
        self.report
    }
}

/// Prepares and solves the step: once with explicit coupling or with damage predicted at the middle
/// of the step, otherwise until the damage used in the impulses equals the damage that the
/// resulting openings give.
pub(super) fn couple<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    free: &[BodyVelocity<S>],
    info: &StepInfo,
    report: &mut StepReport,
) -> Result<(), StepError> {
    let mut coupling = Progress::new(&s.options.coupling);
    let options = s.solver_in_force();
    s.workspace.solved.predicted = s.options.coupling == Coupling::Midpoint;
    let clock = Instant::now();
    let evaluator = &mut s.workspace.evaluator;
    evaluator.select(&s.laws, &s.state.network);
    report.timing.laws += clock.elapsed();
    loop {
        let clock = Instant::now();
        let prepared = s.workspace.evaluator.prepare(
            &s.laws,
            &mut s.state.law_history,
            &mut s.state.network,
            &s.workspace.solved.before,
            info,
            s.workspace.solved.predicted,
            &mut s.workspace.forms,
            &mut s.workspace.springs,
            &mut s.workspace.moments,
        );
        prepared.map_err(|e| s.law_error(e))?;
        systems::find_turned_systems(s);
        report.timing.laws += clock.elapsed();

        agreement::solve_in_agreement(s, start, free, &options, info, report)?;
        let Coupling::Implicit { .. } = s.options.coupling else {
            return Ok(());
        };
        let clock = Instant::now();
        let change = s.workspace.evaluator.trial_damage(
            &s.laws,
            &mut s.state.law_history,
            &mut s.state.network,
            &s.workspace.solved.step(info),
        );
        let change = change.map_err(|e| s.law_error(e))?;
        report.timing.laws += clock.elapsed();
        if coupling.ends(change) {
            report.coupling = coupling.report();
            return Ok(());
        }
        s.workspace
            .evaluator
            .adopt_trial_damage(&mut s.state.network);
        for (form, contact_step) in s
            .workspace
            .forms
            .iter_mut()
            .zip(&s.workspace.solved.contact_steps)
        {
            form.impulse = contact_step.solution.impulse;
        }
    }
}
