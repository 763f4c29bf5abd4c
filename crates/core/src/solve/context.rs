//! One solve of a step: its input, what was learned in earlier steps, and runs of single methods.

use super::form::ContactForm;
use super::local::solver::Method;
use super::nlgs::{self, Report, SolverOptions};
use super::problem::Problem;
use super::row::MomentForm;
use super::search::SecondSearch;
use super::standard;
use super::velocities::{self, Patience, Start};
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// State that `auto` carries from step to step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AutoState {
    /// Factor on the number of iterations before Newton on W.
    pub(super) patience: f64,
    /// Whether the interior point converged in the last step in which Newton failed; it is then
    /// tried first.
    pub(super) interior_first: bool,
    /// Number of times that the interior point is still to be skipped, and number of skips after
    /// its last failure.
    skipped: [u32; 2],
    /// When to try Newton in velocities.
    pub(super) velocities: Patience,
    /// State of the search for second solutions.
    pub(super) search: SecondSearch,
}

impl Default for AutoState {
    fn default() -> Self {
        Self {
            patience: 1.0,
            interior_first: false,
            skipped: [0; 2],
            velocities: Patience::default(),
            search: SecondSearch::default(),
        }
    }
}

impl AutoState {
    /// Returns the state of the search for second solutions.
    pub fn search(&self) -> &SecondSearch {
        &self.search
    }

    /// Begins a step, whose problem may be solved several times.
    pub fn begin_step(&mut self) {
        self.search.begin_step();
    }

    /// Returns whether to try the interior point: after each failure it is skipped twice as often,
    /// at most 64 times.
    pub(super) fn interior_is_due(&mut self) -> bool {
        let due = self.skipped[0] == 0;
        self.skipped[0] = self.skipped[0].saturating_sub(1);
        due
    }

    /// Changes the patience by whether a factorising method solved the last problem.
    pub(super) fn adapt(&mut self, ended: bool) {
        self.patience *= if ended { 0.5 } else { 2.0 };
        self.patience = self.patience.clamp(1.0, 64.0);
    }

    /// Records the result of an interior-point attempt.
    pub(super) fn learn(&mut self, ended: bool) {
        self.interior_first = ended;
        let next = (2 * self.skipped[1]).clamp(1, 64);
        self.skipped = if ended { [0; 2] } else { [next; 2] };
    }
}

/// Input of a solve, in addition to the problem.
pub(super) struct SolveContext<'a, S: Space> {
    pub(super) forms: &'a [ContactForm<S>],
    pub(super) moments: &'a [MomentForm<S>],
    pub(super) options: &'a SolverOptions,
    /// Velocities before the step, if known.
    pub(super) start: Option<Start<'a, S>>,
}

impl<S: Space> SolveContext<'_, S> {
    /// Runs the Gauss-Seidel iteration over bodies, with an iteration limit.
    pub(super) fn sweep(&self, problem: &mut Problem<S>, most: u32) -> Report {
        self.iterate(problem, Method::Nlgs, most)
    }

    /// Runs the iteration of [`Self::sweep`] with Anderson acceleration.
    pub(super) fn sweep_accelerated(&self, problem: &mut Problem<S>, most: u32) -> Report {
        self.iterate(problem, Method::Anderson, most)
    }

    fn iterate(&self, problem: &mut Problem<S>, method: Method, most: u32) -> Report {
        let options = SolverOptions {
            accelerated: method == Method::Anderson,
            max_iterations: most,
            ..*self.options
        };
        Report {
            used: method,
            ..nlgs::solve(problem, &options)
        }
    }

    /// Improves the solution by a matrix method, whose tolerance applies to its own error measure.
    pub(super) fn improve(
        &self,
        problem: &mut Problem<S>,
        method: Method,
        tolerance: f64,
        most: u32,
    ) -> Report {
        let limits = (self.options.norm, tolerance, most);
        let (forms, moments) = (self.forms, self.moments);
        let iterations = if S::D == 2 {
            standard::improve::<S, 2>(problem, forms, moments, method, limits)
        } else {
            standard::improve::<S, 3>(problem, forms, moments, method, limits)
        };
        Report {
            iterations,
            used: method,
            ..nlgs::check_convergence(problem, self.options)
        }
    }

    /// Solves by Newton's method in the velocities of the bodies, if it serves the problem.
    pub(super) fn solve_in_velocities(
        &self,
        problem: &mut Problem<S>,
        most: u32,
    ) -> Option<Report> {
        if !self.velocities_serve(problem) {
            return None;
        }
        let options = SolverOptions {
            max_iterations: most,
            ..*self.options
        };
        Some(Report {
            used: Method::Newton,
            ..velocities::solve(
                problem,
                self.forms,
                self.moments,
                self.start.as_ref(),
                &options,
            )
        })
    }

    /// Whether Newton's method in the velocities serves the problem.
    pub(super) fn velocities_serve(&self, problem: &Problem<S>) -> bool {
        velocities::serves(problem, self.forms, self.moments)
    }

    /// Restores the impulses of the forms.
    pub(super) fn start_anew(&self, problem: &mut Problem<S>) {
        let impulses: Vec<_> = self.forms.iter().map(|f| Some(f.impulse)).collect();
        let moments: Vec<_> = self.moments.iter().map(|m| Some(m.moment)).collect();
        problem.adopt(&impulses, &moments);
    }
}
