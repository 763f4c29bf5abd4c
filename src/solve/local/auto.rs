//! The choice for a problem given as a matrix.
//!
//! Sweeps with Anderson's acceleration come first and solve most problems. When they have cost about as
//! much as factorisations would, the interior point takes over, then Newton from the best point, and then
//! long runs of sweeps with Newton's attempts between them. The order and the lengths follow from sizes
//! alone, so the same problem takes the same path on any machine.

use super::anderson::Anderson;
use super::form::Form;
use super::interior::Interior;
use super::newton::Newton;
use super::nlgs::Nlgs;
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
fn sweeps_per_factorisation(entries: f64, contacts: f64) -> f64 {
    0.9 * entries.powf(1.5) / (entries + 60.0 * contacts)
}

impl Auto {
    /// The methods used in the last solve, in their order.
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
        if self.used.borrow().last() != Some(&name) {
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
        const TIGHT: f64 = 15.0;
        self.used.borrow_mut().clear();
        let blocks = form.w.matrix().blocks.len() + form.len();
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
        if Interior::serves(form.laws) {
            let mut best = Best::of(state);
            if self.run("interior", &Interior, form, state, budget, 80) {
                return;
            }
            best.keep(state);
            best.restore(form, state);
        }
        if self.run("newton", &Newton::default(), form, state, budget, 150) {
            return;
        }
        let mut sweeps = (worth * per).clamp(1000.0, 1e5) as u32;
        let gauss_seidel = Nlgs {
            relaxation: 1.5,
            ..Nlgs::default()
        };
        // From the sweeps' own point: what Newton reached may be a piece that leads nowhere.
        loop {
            if self.run("nlgs", &gauss_seidel, form, state, budget, sweeps) {
                return;
            }
            let best = Best::of(state);
            let newton = Newton { alpha: 1e-5 };
            if self.run("newton", &newton, form, state, budget, 60) {
                return;
            }
            best.restore(form, state);
            sweeps = sweeps.saturating_add(sweeps / 2);
            if budget.ends(state) {
                return;
            }
        }
    }
}
