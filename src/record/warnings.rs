//! What went wrong in a run without ending it, and what to change.

use super::solving::SolverSummary;
use crate::geometry::space::Space;
use crate::scene::case::Case;
use crate::scene::methods::{Demands, Service};
use crate::scene::sampling;
use crate::solve::Report;
use crate::solve::local::solver::Method;
use crate::step::Simulation;
use serde::Serialize;

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// `TOO FAST`, `MOTION LOST`, `COARSE DRIVE`, `NOT CONVERGED` or `NOT COUPLED`.
    pub of: &'static str,
    /// What was seen, and what to change.
    pub text: String,
}

/// Steps that ended above the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Missed {
    /// How many.
    pub steps: u64,
    /// Number of the first.
    pub first: u64,
    /// Largest error of one.
    pub error: f64,
}

impl Missed {
    /// Counts a step by its number.
    pub fn add(&mut self, report: &Report, step: u64) {
        if report.converged {
            return;
        }
        if self.steps == 0 {
            self.first = step;
        }
        self.steps += 1;
        self.error = self.error.max(report.error);
    }

    /// What to tell the user after `of` steps: only methods that the laws let through are proposed. None where all steps
    /// converged.
    pub fn warning<S: Space>(&self, simulation: &Simulation<S>, of: u64) -> Option<String> {
        if self.steps == 0 {
            return None;
        }
        let options = &simulation.solver;
        let demands = Demands::of(simulation);
        let others = [Method::Auto, Method::Newton, Method::Interior].into_iter();
        let others = others
            .filter(|m| *m != options.method)
            .filter(|m| !matches!(demands.service(*m), Service::Refuses(_)));
        let others: Vec<String> = others.map(|m| format!("{m:?}")).collect();
        let other = if others.is_empty() {
            String::new()
        } else {
            format!(", or try solver.method {}", others.join(" or "))
        };
        // Velocities of bodies that weigh little beside others round to more than a tight tolerance asks for.
        let rounding = if options.tolerance < 1e-6 {
            ", or allow a larger solver.tolerance (rounding may leave more than this one)"
        } else {
            ""
        };
        Some(format!(
            "{} of {of} steps, the first is step {}, ended with an error of up to {:.1e} (tolerance {:.0e}); take a smaller \
             time.step, raise solver.max_iterations (it is {}){other}{rounding}",
            self.steps, self.first, self.error, options.tolerance, options.max_iterations
        ))
    }
}

/// All warnings of a run of a case.
pub(super) fn of<S: Space>(
    case: &Case,
    simulation: &Simulation<S>,
    solver: &SolverSummary,
) -> Vec<Warning> {
    let missed = Missed {
        steps: solver.unconverged_steps,
        first: solver.first_unconverged,
        error: solver.error_max,
    };
    let uncoupled = (solver.uncoupled_steps > 0).then(|| {
        format!(
            "{} steps left damage and opening apart; raise coupling.max_iterations or take a smaller time.step",
            solver.uncoupled_steps
        )
    });
    let haste = &simulation.network.haste;
    let too_fast = [
        ("TOO FAST", haste.warning()),
        ("MOTION LOST", haste.rounding_warning()),
    ];
    let coarse = sampling::warnings(case);
    let coarse = coarse.into_iter().map(|text| ("COARSE DRIVE", Some(text)));
    let told = [
        (
            "NOT CONVERGED",
            missed.warning(simulation, simulation.steps),
        ),
        ("NOT COUPLED", uncoupled),
    ];
    let told = too_fast.into_iter().chain(coarse).chain(told);
    told.filter_map(|(of, text)| text.map(|text| Warning { of, text }))
        .collect()
}
