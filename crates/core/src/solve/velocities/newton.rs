//! Newton's iteration with a line search on the residual.

use super::Solve;
use super::balance::{Evaluated, Motion};
use crate::geometry::space::Space;
use crate::solve::problem::Problem;

/// Number of iterations after which the interior point method takes over.
const ITERATIONS: u32 = 15;
/// Number of times that a step is halved.
const HALVINGS: u32 = 6;
/// Share of the step by which the residual has to fall at least.
const DECREASE: f64 = 0.1;
/// Number of successive iterations with a short step that ends the attempt.
const SHORT: u32 = 4;
/// Ratio of successive residuals of the last iterations from the interior point method.
const FINAL_DECREASE: f64 = 0.7;
/// Largest number of these iterations.
const FINAL_ITERATIONS: u32 = 8;

/// Iterates from some velocities until the problem is solved, or no progress is made.
pub(super) fn solve<S: Space>(solve: &mut Solve<S>, problem: &mut Problem<S>, begin: &[Motion<S>]) {
    let mut at = solve.balance.evaluate(begin.to_vec());
    let mut short = 0;
    for _ in 0..ITERATIONS {
        solve.measure(problem, &at);
        if solve.ended() || short == SHORT {
            return;
        }
        let Some((next, factor)) = step(solve, &at, HALVINGS) else {
            return;
        };
        short = if factor < 0.25 { short + 1 } else { 0 };
        at = next;
    }
    solve.measure(problem, &at);
}

/// Ends a solve near its solution with whole steps; returns early where the residual does not fall.
pub(super) fn finish<S: Space>(
    solve: &mut Solve<S>,
    problem: &mut Problem<S>,
    mut at: Evaluated<S>,
) {
    for _ in 0..FINAL_ITERATIONS {
        let Some((next, _)) = step(solve, &at, 0) else {
            return;
        };
        if next.size.is_nan() || next.size > FINAL_DECREASE * at.size {
            return;
        }
        at = next;
        solve.measure(problem, &at);
        if solve.ended() {
            return;
        }
    }
}

/// Returns the best velocities along Newton's direction, and the factor on the whole step.
fn step<S: Space>(
    solve: &mut Solve<S>,
    at: &Evaluated<S>,
    halvings: u32,
) -> Option<(Evaluated<S>, f64)> {
    solve.iterations += 1;
    let balance = &mut solve.balance;
    let change = balance.direction(&at.residual, &at.slopes)?;
    let mut best: Option<(Evaluated<S>, f64)> = None;
    let mut factor = 1.0;
    for _ in 0..=halvings {
        let next = balance.evaluate(balance.moved(&at.motions, &change, factor));
        let enough = next.size <= (1.0 - DECREASE * factor) * at.size;
        if best
            .as_ref()
            .is_none_or(|(best, _)| best.size.is_nan() || next.size < best.size)
        {
            best = Some((next, factor));
        }
        if enough {
            break;
        }
        factor *= 0.5;
    }
    best
}
