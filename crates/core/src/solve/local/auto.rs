//! Automatic choice of the method for a problem given as a matrix.
//!
//! Gauss-Seidel with Anderson acceleration comes first and solves most problems. When it has cost
//! about as much as some factorisations, or its error has not fallen for the cost of a few, Newton
//! continues from its result. Then long runs of Gauss-Seidel alternate with Newton, and after the
//! first run the interior point tries from its own start. The order and the lengths follow from
//! problem sizes and errors alone, so that a problem takes the same path on any machine.

use super::anderson::Anderson;
use super::form::Form;
use super::interior::Interior;
use super::newton::Newton;
use super::nlgs::{Nlgs, Order};
use super::state::{Best, Budget, Iteration, Solver};

/// The method; [`Auto::names`] returns the methods it used.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    used: std::cell::RefCell<Vec<&'static str>>,
}

/// Returns how many iterations cost as much as one factorisation of W.
///
/// Fitted to the 41 local problems of the table in the docs: an iteration takes 1 ns per entry and
/// 60 ns per contact, a factorisation 0.9 ns times entries^1.5 (sparse; about the same for small
/// dense ones).
pub fn sweeps_per_factorisation(entries: f64, contacts: f64) -> f64 {
    0.9 * entries.powf(1.5) / (entries + 60.0 * contacts)
}

/// Cost of Gauss-Seidel before Newton, in factorisations: more at a loose tolerance.
pub fn factorisations_before_newton(tolerance: f64) -> f64 {
    if tolerance >= 1e-5 { 40.0 } else { 20.0 }
}

/// Cost of Gauss-Seidel without progress, in factorisations, after which Newton is tried at once.
const STALLED: f64 = 10.0;
/// Steps of Newton from the first sweeps.
const FIRST_NEWTON: u32 = 40;
/// Steps of Newton from the sweeps of a round.
const ROUND_NEWTON: u32 = 80;
/// Steps of the interior point.
const INTERIOR: u32 = 80;

impl Auto {
    /// Returns the methods used in the last solve, in the order of first use.
    pub fn names(&self) -> Vec<&'static str> {
        self.used.borrow().clone()
    }

    fn run<const D: usize>(
        &self,
        name: &'static str,
        solver: &dyn Solver<D>,
        form: &Form<D>,
        state: &mut Iteration<D>,
        budget: &mut Budget,
        iterations: u32,
    ) -> bool {
        if !self.used.borrow().contains(&name) {
            self.used.borrow_mut().push(name);
        }
        let mut own = budget.at_most(state.iterations.saturating_add(iterations));
        own.history = budget.history.take();
        solver.solve(form, state, &mut own);
        budget.history = own.history.take();
        state.error <= budget.tolerance
    }
}

impl<const D: usize> Solver<D> for Auto {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        self.used.borrow_mut().clear();
        let Some(w) = form.w.matrix() else {
            return;
        };
        let blocks = w.others() + form.len();
        let per = sweeps_per_factorisation((blocks * D * D) as f64, form.len() as f64);
        let worth = factorisations_before_newton(budget.tolerance);
        let sweeps = (worth * per).clamp(100.0, 1e6) as u32;
        let newton_serves = Newton::serves(form.laws).is_ok();
        let first = Anderson {
            patience: newton_serves.then_some((STALLED * per).clamp(100.0, 1e6) as usize),
            ..Anderson::default()
        };
        let start = state.iterations;
        if self.run("anderson", &first, form, state, budget, sweeps) {
            return;
        }
        let left = sweeps.saturating_sub(state.iterations - start);
        let newton = Newton { alpha: 1e-4 };
        let mut best = Best::of(state);
        if newton_serves && self.run("newton", &newton, form, state, budget, FIRST_NEWTON) {
            return;
        }
        best.keep(state);
        if f64::from(left) > per {
            // The error stalled and Newton did not help: the remaining sweeps follow, if they cost
            // more than a step of Newton, then Newton from their result.
            let rest = Anderson::default();
            if self.run("anderson", &rest, form, state, budget, left) {
                return;
            }
            best.keep(state);
            if newton_serves && self.run("newton", &newton, form, state, budget, FIRST_NEWTON) {
                return;
            }
            best.keep(state);
        }
        best.restore(form, state);
        // The remaining problems have many solutions and local minima of the merit function: every
        // round uses a different start.
        let base = (worth * per).clamp(1000.0, 10_000.0) as u32;
        let mut round = 0u32;
        while !budget.ends(state) {
            let sweeps = base.saturating_mul(1 << (round / 4).min(16));
            let gauss_seidel = Nlgs {
                relaxation: [1.5, 1.3, 1.0][round as usize % 3],
                order: if round == 0 {
                    Order::Forward
                } else {
                    Order::Shuffled(round.into())
                },
                last: true,
            };
            if self.run("nlgs", &gauss_seidel, form, state, budget, sweeps) {
                return;
            }
            best.keep(state);
            if newton_serves
                && self.run(
                    "newton",
                    &Newton { alpha: 1e-5 },
                    form,
                    state,
                    budget,
                    ROUND_NEWTON,
                )
            {
                return;
            }
            best.keep(state);
            // The interior point uses its own start; it rarely helps where Newton failed, and costs
            // more than a round.
            if round == 0 && Interior::serves(form.laws).is_ok() {
                if self.run("interior", &Interior, form, state, budget, INTERIOR) {
                    return;
                }
                best.keep(state);
                best.restore(form, state);
            }
            round += 1;
        }
        best.restore(form, state);
    }
}
