//! Non-linear Gauss-Seidel on a matrix: contact by contact, each solved exactly.

use super::block::BlockMatrix;
use super::contact::Local;
use super::form::Form;
use super::law::Law;
use super::state::{Budget, Solver, State};

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

    /// Solves one contact; returns the square of its change.
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
            let far: [f64; D] =
                std::array::from_fn(|k| old[k] + relaxation * (new[k] - old[k]));
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

impl<const D: usize> Solver<D> for Nlgs {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let mut sweep = Sweep::new(form);
        let mut next_test = state.iterations + 1;
        let mut best = (state.error, state.p.clone());
        let mut relaxation = self.relaxation;
        let mut stalled = 0;
        while !budget.ends(state) {
            while state.iterations < next_test.min(budget.max_iterations) {
                if self.order == Order::Symmetric && state.iterations % 2 == 1 {
                    sweep.backward(&mut state.p, relaxation);
                } else {
                    sweep.forward(&mut state.p, relaxation);
                }
                state.iterations += 1;
            }
            state.measure(form);
            if state.error < 0.99 * best.0 {
                best.0 = state.error;
                best.1.copy_from_slice(&state.p);
                stalled = 0;
            } else {
                stalled += 1;
                if stalled > 20 && relaxation > 1.0 || state.error > 4.0 * best.0 {
                    relaxation = 1.0 + 0.5 * (relaxation - 1.0);
                    stalled = 0;
                }
            }
            next_test = state.iterations + (state.iterations / 4).clamp(1, 10);
        }
        if state.error > best.0 {
            state.p.copy_from_slice(&best.1);
            state.measure(form);
        }
    }
}
