//! Non-linear Gauss-Seidel on a matrix: contact by contact, each solved exactly.

use super::block::BlockMatrix;
use super::contact::Local;
use super::form::Form;
use super::law::Law;
use super::state::{Best, Budget, Solver, State};

/// How contacts are visited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// First to last.
    #[default]
    Forward,
    /// Forwards, then backwards.
    Symmetric,
}

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Nlgs {
    /// How contacts are visited.
    pub order: Order,
    /// Over-relaxation, from 1 (none) to below 2.
    pub relaxation: f64,
}

impl Default for Nlgs {
    fn default() -> Self {
        Self {
            order: Order::Forward,
            relaxation: 1.0,
        }
    }
}

/// The sweep's own memory.
pub struct Sweep<'a, const D: usize> {
    w: &'a BlockMatrix<D>,
    q: &'a [[f64; D]],
    laws: &'a [Law],
    locals: Vec<Local<D>>,
}

impl<'a, const D: usize> Sweep<'a, D> {
    /// Forms the inverses of the diagonal.
    pub fn new(form: &Form<'a, D>) -> Self {
        let w = form.w.matrix();
        Self {
            w,
            q: form.q,
            laws: form.laws,
            locals: w.diagonal.iter().map(Local::new).collect(),
        }
    }

    /// Solves one contact.
    #[inline(always)]
    fn visit(&mut self, c: usize, p: &mut [[f64; D]], relaxation: f64) {
        let f = self.w.gather(c, p, self.q[c]);
        let new = match self.laws[c] {
            Law::Coulomb(mu) => self.locals[c].solve(&f, mu),
            law => self.locals[c].solve_rare(&f, &law, &p[c], p),
        };
        if relaxation == 1.0 {
            p[c] = new;
        } else {
            let old = p[c];
            let far: [f64; D] = std::array::from_fn(|k| old[k] + relaxation * (new[k] - old[k]));
            p[c] = self.laws[c].project(&far, p);
        }
    }

    /// All contacts once.
    pub fn forward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        for c in 0..p.len() {
            self.visit(c, p, relaxation);
        }
    }

    /// All contacts once, last to first.
    pub fn backward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        for c in (0..p.len()).rev() {
            self.visit(c, p, relaxation);
        }
    }
}

/// Sweeps until the next test: often at first, where few may do.
pub fn until_test(done: u32) -> u32 {
    (done / 4).clamp(1, 10)
}

impl<const D: usize> Solver<D> for Nlgs {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        /// Tests without a better error after which there is to be less relaxation.
        const PATIENCE: u32 = 20;
        let mut sweep = Sweep::new(form);
        let mut best = Best::of(state);
        let mut relaxation = self.relaxation;
        let mut stalled = 0;
        let mut done = 0;
        while !budget.ends(state) {
            let last = (state.iterations + until_test(done)).min(budget.max_iterations);
            while state.iterations < last {
                if self.order == Order::Symmetric && state.iterations % 2 == 1 {
                    sweep.backward(&mut state.p, relaxation);
                } else {
                    sweep.forward(&mut state.p, relaxation);
                }
                state.iterations += 1;
                done += 1;
            }
            state.measure(form);
            let better = state.error < 0.99 * best.error;
            let worse = state.error > 4.0 * best.error;
            stalled = if better { 0 } else { stalled + 1 };
            best.keep(state);
            if relaxation > 1.0 && (worse || stalled > PATIENCE) {
                relaxation = 1.0 + 0.5 * (relaxation - 1.0);
                stalled = 0;
            }
        }
        best.restore(form, state);
    }
}
