//! The choice for a problem given as a matrix.
//!
//! Sweeps with Anderson's acceleration come first and solve most problems. When they have cost about as
//! much as some factorisations would, Newton goes on from there, then the interior point tries from its own
//! start, and then come long runs of sweeps with attempts of Newton between them. The order and the
//! lengths follow from sizes alone, so the same problem takes the same path on any machine.

use super::anderson::Anderson;
use super::form::Form;
use super::interior::Interior;
use super::newton::Newton;
use super::nlgs::{Nlgs, Order};
use super::state::{Best, Budget, Solver, State};

/// The method; [`Auto::names`] tells what it used.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    used: std::cell::RefCell<Vec<&'static str>>,
}

/// How many sweeps cost as much as one factorisation of W.
///
/// Fitted on the 41 local problems of the docs' table: a sweep takes 1 ns an entry and 60 ns a contact, a
/// factorisation 0.9 ns times entries^1.5 (sparse; about the same for the small dense ones).
pub fn sweeps_per_factorisation(entries: f64, contacts: f64) -> f64 {
    0.9 * entries.powf(1.5) / (entries + 60.0 * contacts)
}

impl Auto {
    /// The methods used in the last solve, in the order of their first use.
    pub fn names(&self) -> Vec<&'static str> {
        self.used.borrow().clone()
    }

    fn run<const D: usize>(
        &self,
        name: &'static str,
        solver: &dyn Solver<D>,
        form: &Form<D>,
        state: &mut State<D>,
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
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        /// Factorisations' worth of sweeps before the interior point, at a loose and at a tight tolerance.
        const LOOSE: f64 = 40.0;
        const TIGHT: f64 = 20.0;
        self.used.borrow_mut().clear();
        let Some(w) = form.w.matrix() else {
            return;
        };
        let blocks = w.others() + form.len();
        let per = sweeps_per_factorisation((blocks * D * D) as f64, form.len() as f64);
        let worth = if budget.tolerance >= 1e-5 {
            LOOSE
        } else {
            TIGHT
        };
        let sweeps = (worth * per).clamp(100.0, 1e6) as u32;
        if self.run(
            "anderson",
            &Anderson::default(),
            form,
            state,
            budget,
            sweeps,
        ) {
            return;
        }
        let newton = Newton { alpha: 1e-4 };
        let mut best = Best::of(state);
        let bends = Newton::serves(form.laws).is_ok();
        if bends && self.run("newton", &newton, form, state, budget, 40) {
            return;
        }
        best.keep(state);
        if Interior::serves(form.laws).is_ok() {
            if self.run("interior", &Interior, form, state, budget, 80) {
                return;
            }
            best.keep(state);
        }
        best.restore(form, state);
        // What is left has many solutions and dead ends between them: every round takes another way.
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
            if bends && self.run("newton", &Newton { alpha: 1e-5 }, form, state, budget, 200) {
                return;
            }
            best.keep(state);
            round += 1;
        }
        best.restore(form, state);
    }
}
