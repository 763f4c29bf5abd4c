//! One step of a packing, solved from zero by every solver.

use fretwork::solve::error::Norm;
use fretwork::solve::local::LocalProblem;
use fretwork::solve::local::block::BlockMatrix;
use fretwork::solve::local::form::{Form, coulomb};
use fretwork::solve::local::solver::Method;
use fretwork::solve::local::state::{Budget, Iteration};
use std::time::Instant;

/// Result of a solver on a problem.
#[derive(Clone, Debug)]
pub struct Fared {
    /// The method.
    pub method: Method,
    /// Pairs (iteration, error).
    pub history: Vec<(u32, f64)>,
    /// Seconds per iteration, including tests of the error.
    pub each: f64,
}

impl Fared {
    /// Iterations needed for an error, if it was reached.
    pub fn to(&self, error: f64) -> Option<u32> {
        self.history.iter().find(|h| h.1 <= error).map(|h| h.0)
    }
}

/// Solves a 2D problem from p = 0 with at most `most` iterations, or to 1e-10.
pub fn solve(problem: &LocalProblem, method: Method, most: u32) -> Fared {
    const GOAL: f64 = 1e-10;
    let w = BlockMatrix::<2>::from_csr(&problem.w);
    let (q, laws) = (problem.q.as_chunks::<2>().0, coulomb(&problem.mu));
    let form = Form::new(&w, q, &laws, Norm::Balance);
    let mut state = Iteration::new(&form, vec![[0.0; 2]; laws.len()]);
    let mut budget = Budget::new(GOAL, most, 600.0);
    budget.history = Some(Vec::new());
    let clock = Instant::now();
    method.solver::<2>().solve(&form, &mut state, &mut budget);
    let seconds = clock.elapsed().as_secs_f64();
    Fared {
        method,
        history: budget.history.unwrap_or_default(),
        each: seconds / f64::from(state.iterations.max(1)),
    }
}
