//! Common parts of the solvers: the iterate, stopping criteria, and the trait.

use super::form::Form;
use std::time::{Duration, Instant};

/// The iterate: impulses p and velocities u = W p + q.
#[derive(Clone, Debug)]
pub struct Iteration<const D: usize> {
    /// Impulses; the initial value of a solve.
    pub p: Vec<[f64; D]>,
    /// Velocities of these impulses.
    pub u: Vec<[f64; D]>,
    /// Error of `p`.
    pub error: f64,
    /// Value by which the residual is divided.
    pub scale: f64,
    /// Iterations done, as counted by the solver.
    pub iterations: u32,
}

impl<const D: usize> Iteration<D> {
    /// Creates a state from impulses.
    pub fn new(form: &Form<D>, p: Vec<[f64; D]>) -> Self {
        let mut state = Self {
            u: vec![[0.0; D]; p.len()],
            p,
            error: f64::INFINITY,
            scale: 0.0,
            iterations: 0,
        };
        if state.p.iter().all(|p| *p == [0.0; D]) {
            state.u.copy_from_slice(form.q);
            state.update_error(form);
        } else {
            state.measure(form);
        }
        state
    }

    /// Recomputes velocities and error; returns the error.
    pub fn measure(&mut self, form: &Form<D>) -> f64 {
        form.velocity(&self.p, &mut self.u);
        self.update_error(form)
    }

    /// Recomputes the error; `u` must belong to `p`.
    pub fn update_error(&mut self, form: &Form<D>) -> f64 {
        let measure = form.error(&self.p, &self.u);
        (self.error, self.scale) = (measure.error, measure.scale);
        if self.error.is_nan() {
            self.error = f64::INFINITY;
        }
        self.error
    }
}

/// The best iterate so far.
#[derive(Clone, Debug)]
pub struct Best<const D: usize> {
    /// Error of the iterate.
    pub error: f64,
    p: Vec<[f64; D]>,
}

impl<const D: usize> Best<D> {
    /// Starts with the current state.
    pub fn of(state: &Iteration<D>) -> Self {
        Self {
            error: state.error,
            p: state.p.clone(),
        }
    }

    /// Stores the state if it is better.
    pub fn keep(&mut self, state: &Iteration<D>) {
        if state.error < self.error {
            self.error = state.error;
            self.p.copy_from_slice(&state.p);
        }
    }

    /// Copies the best iterate back to the state.
    pub fn restore(&self, form: &Form<D>, state: &mut Iteration<D>) {
        if state.error > self.error || !state.error.is_finite() {
            state.p.copy_from_slice(&self.p);
            state.measure(form);
        }
    }
}

/// Stopping criteria of the solve of a problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The [`field_error`](super::solver::field_error) to reach.
    pub tolerance: f64,
    /// The [`scale_free_error`](super::solver::Outcome::scale_free_error) to reach as well; `None`
    /// to report it only.
    pub scale_free: Option<f64>,
    /// Maximum number of iterations.
    pub max_iterations: u32,
    /// Maximum time (s).
    pub seconds: f64,
}

/// Stopping criteria of one run of a method.
#[derive(Clone, Debug)]
pub struct Budget {
    /// Error to reach.
    pub tolerance: f64,
    /// Maximum number of iterations, as counted by the solver.
    pub max_iterations: u32,
    /// Time at which to stop.
    pub deadline: Instant,
    /// History (iteration, error), if requested.
    pub history: Option<Vec<(u32, f64)>>,
}

impl Budget {
    /// Creates limits that start now.
    pub fn new(tolerance: f64, max_iterations: u32, seconds: f64) -> Self {
        let seconds = seconds.clamp(0.0, 1e9);
        Self {
            tolerance,
            max_iterations,
            deadline: Instant::now() + Duration::from_secs_f64(seconds),
            history: None,
        }
    }

    /// Returns whether to stop at this state; records the error if requested.
    pub fn ends<const D: usize>(&mut self, state: &Iteration<D>) -> bool {
        if let Some(history) = &mut self.history {
            history.push((state.iterations, state.error));
        }
        state.error <= self.tolerance
            || state.iterations >= self.max_iterations
            || Instant::now() >= self.deadline
    }

    /// Returns the same budget with fewer iterations.
    #[must_use]
    pub fn at_most(&self, iterations: u32) -> Self {
        Self {
            max_iterations: self.max_iterations.min(iterations),
            history: None,
            ..self.clone()
        }
    }
}

/// A solution method.
pub trait Solver<const D: usize> {
    /// Improves the state until the budget ends; leaves the best state found, with its error.
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget);
}
