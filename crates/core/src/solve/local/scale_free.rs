//! A second error measure: the error in velocities, which does not depend on units.
//!
//! The error measure of the literature divides by max(|q|, |p|, |u|). Where W is far from 1,
//! impulses dominate velocities, and an error of 1e-8 may hide velocities that are entirely wrong.
//! The scale-free error is [`Norm::Velocity`] of [`crate::solve::error`]:
//!
//! ```text
//! error = |r| / max(|u|, |q|)
//! r_c = (p_c - proj_Kc(p_c - rho_c (u_c + mu_c |u_t,c| n))) / rho_c
//! rho_c = 1 / lambda_max(W_cc)
//! ```
//!
//! Scaling W by s and p by 1/s, or changing the units of q, u and p, gives the same number.

use super::LocalProblem;
use super::block::BlockMatrix;
use super::form::{Form, coulomb, magnitude};
use super::state::{Budget, Iteration, Limits};
use crate::solve::error::Norm;

/// The formula, for reports.
pub const FORMULA: &str = "|r| / max(|u|, |q|), r = (p - proj_K(p - rho (u + mu |u_t| n))) / rho, rho = 1 / lambda_max(W_cc)";

/// Maximum number of alternations between the two error measures.
const TURNS: u32 = 6;

/// Returns the scale-free error above which a solution that meets the usual error measure is
/// reported as doubtful, if no tolerance is given: a hundred times the tolerance, but at least 1e-3
/// and at most 0.1.
pub fn usual_limit(tolerance: f64) -> f64 {
    (100.0 * tolerance).clamp(1e-3, 0.1)
}

/// Returns the scale-free error of impulses p, with u = W p + q; infinite where a number is not
/// finite.
pub fn scale_free_error(problem: &LocalProblem, p: &[f64]) -> f64 {
    match problem.dimension {
        2 => measured::<2>(problem, p),
        _ => measured::<3>(problem, p),
    }
}

fn measured<const D: usize>(problem: &LocalProblem, p: &[f64]) -> f64 {
    let w = BlockMatrix::<D>::from_csr(&problem.w);
    // Velocities are divided by the largest free velocity, rounded to a power of two, so that no
    // bit changes and no square overflows.
    let unit = magnitude(problem.q.iter());
    let scaled = |x: &[f64]| -> Vec<[f64; D]> {
        let blocks = x.as_chunks::<D>().0.iter();
        blocks.map(|b| b.map(|x| x / unit)).collect()
    };
    let (q, p) = (scaled(&problem.q), scaled(p));
    let laws = coulomb(&problem.mu);
    let form = Form::new(&w, &q, &laws, Norm::Velocity);
    let mut u = vec![[0.0; D]; q.len()];
    form.velocity(&p, &mut u);
    form.error(&p, &u).error
}

/// Reduces both the usual and, if requested, the scale-free error of a state below their tolerances
/// by alternating between them, always continuing with the larger one. `solve` runs the method; the
/// budget limits the work.
pub(super) fn meet<'a, const D: usize>(
    field: &Form<'a, D>,
    velocity: &Form<'a, D>,
    state: &mut Iteration<D>,
    limits: &Limits,
    budget: &mut Budget,
    mut solve: impl FnMut(&Form<'a, D>, &mut Iteration<D>, &mut Budget),
) {
    solve(field, state, budget);
    let Some(limit) = limits.scale_free else {
        return;
    };
    // Slightly below the tolerance, so that errors recomputed in another order of summation are
    // still within it.
    let within = 1.0 - 1e-9;
    let mut tighter = 1.0;
    for _ in 0..TURNS {
        let spent = state.iterations >= budget.max_iterations
            || std::time::Instant::now() >= budget.deadline;
        let error = velocity.error(&state.p, &state.u).error;
        if error > limit {
            if spent {
                break;
            }
            budget.tolerance = limit * within * tighter;
            // Reducing the other error may undo part of the progress.
            tighter *= 0.1;
            state.update_error(velocity);
            solve(velocity, state, budget);
        } else if state.update_error(field) > limits.tolerance && !spent {
            budget.tolerance = limits.tolerance * within;
            solve(field, state, budget);
        } else {
            break;
        }
    }
    state.update_error(field);
}
