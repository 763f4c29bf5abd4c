//! What solvers share: the iterate, when to stop, and the trait.

use super::form::Form;
use std::time::{Duration, Instant};

/// The iterate: impulses p and velocities u = W p + q.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    /// Impulses; the start of a solve.
    pub p: Vec<[f64; D]>,
    /// Velocities that belong to them.
    pub u: Vec<[f64; D]>,
    /// Error of `p`.
    pub error: f64,
    /// What the residual is divided by.
    pub scale: f64,
    /// Iterations done, in the solver's own unit.
    pub iterations: u32,
}

impl<const D: usize> State<D> {
    /// From impulses.
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
            state.judge(form);
        } else {
            state.measure(form);
        }
        state
    }

    /// Recomputes velocities and error.
    pub fn measure(&mut self, form: &Form<D>) -> f64 {
        form.velocity(&self.p, &mut self.u);
        self.judge(form)
    }

    /// Recomputes the error; `u` must belong to `p`.
    pub fn judge(&mut self, form: &Form<D>) -> f64 {
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
    /// Its error.
    pub error: f64,
    p: Vec<[f64; D]>,
}

impl<const D: usize> Best<D> {
    /// The state at hand.
    pub fn of(state: &State<D>) -> Self {
        Self {
            error: state.error,
            p: state.p.clone(),
        }
    }

    /// Keeps the state if it is better.
    pub fn keep(&mut self, state: &State<D>) {
        if state.error < self.error {
            self.error = state.error;
            self.p.copy_from_slice(&state.p);
        }
    }

    /// Puts the best back into the state.
    pub fn restore(&self, form: &Form<D>, state: &mut State<D>) {
        if state.error > self.error || !state.error.is_finite() {
            state.p.copy_from_slice(&self.p);
            state.measure(form);
        }
    }
}

/// When to stop.
#[derive(Clone, Debug)]
pub struct Budget {
    /// Error to reach.
    pub tolerance: f64,
    /// Iterations at most, of the solver's own unit.
    pub max_iterations: u32,
    /// When to give up.
    pub deadline: Instant,
    /// Where the error went, (iteration, error), if asked for.
    pub history: Option<Vec<(u32, f64)>>,
}

impl Budget {
    /// Limits from now on.
    pub fn new(tolerance: f64, max_iterations: u32, seconds: f64) -> Self {
        let seconds = seconds.clamp(0.0, 1e9);
        Self {
            tolerance,
            max_iterations,
            deadline: Instant::now() + Duration::from_secs_f64(seconds),
            history: None,
        }
    }

    /// Whether the solver is to stop at this state. Takes down the error if asked for.
    pub fn ends<const D: usize>(&mut self, state: &State<D>) -> bool {
        if let Some(history) = &mut self.history {
            history.push((state.iterations, state.error));
        }
        state.error <= self.tolerance
            || state.iterations >= self.max_iterations
            || Instant::now() >= self.deadline
    }

    /// The same end with fewer iterations left.
    #[must_use]
    pub fn at_most(&self, iterations: u32) -> Self {
        Self {
            max_iterations: self.max_iterations.min(iterations),
            history: None,
            ..self.clone()
        }
    }
}

/// A method.
pub trait Solver<const D: usize> {
    /// Improves the state until the budget ends it; returns with the best state it knows, measured.
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget);
}
