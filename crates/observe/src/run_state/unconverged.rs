//! Steps that ended above the tolerance of the solver.

use fretwork_core::solve::Report;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::view::RunView;
use fretwork_scene::methods::{SolverRequirements, SolverSupport};

/// Steps that ended above the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnconvergedSteps {
    /// Number of these steps.
    pub steps: u64,
    /// Number of the first of these steps.
    pub first: u64,
    /// Largest error in these steps.
    pub error: f64,
}

impl UnconvergedSteps {
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

    /// Returns advice to the user after `of` steps; proposes only solvers that the laws permit.
    /// `None` if all steps converged.
    pub fn warning(&self, run: &dyn RunView, of: u64) -> Option<String> {
        let options = run.solver_in_force();
        let seen = self.seen(of, options.tolerance)?;
        let requirements = SolverRequirements::of(run);
        let others = [Method::Auto, Method::Newton, Method::Interior].into_iter();
        let others = others
            .filter(|m| *m != options.method)
            .filter(|m| !matches!(requirements.support(*m), SolverSupport::Refuses(_)));
        let others: Vec<String> = others.map(|m| format!("{m:?}")).collect();
        let other = if others.is_empty() {
            String::new()
        } else {
            format!(", or try solver.method {}", others.join(" or "))
        };
        // Velocities of bodies much lighter than their neighbours have rounding errors above a
        // tight tolerance.
        let rounding = if options.tolerance < 1e-6 {
            ", or allow a larger solver.tolerance (rounding may leave more than this one)"
        } else {
            ""
        };
        Some(format!(
            "{seen}, raise solver.max_iterations (it is {}){other}{rounding}",
            options.max_iterations
        ))
    }

    /// Returns a description of the missed steps among `of`, and the first setting to change.
    /// `None` if all steps converged.
    pub(super) fn seen(&self, of: u64, tolerance: f64) -> Option<String> {
        (self.steps > 0).then(|| {
            format!(
                "{} of {of} steps, the first is step {}, ended with an error of up to {:.1e} (tolerance \
                 {tolerance:.0e}); take a smaller time.step",
                self.steps, self.first, self.error
            )
        })
    }
}
