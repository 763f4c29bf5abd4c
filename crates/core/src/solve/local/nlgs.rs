//! Non-linear Gauss-Seidel on a matrix: contact by contact, each solved exactly.

use super::block::BlockMatrix;
use super::contact::Local;
use super::form::{Form, largest};
use super::law::Law;
use super::state::{Best, Budget, Solver, State};
use crate::solve::error::Norm;
use pulp::{Arch, Simd, WithSimd};

/// How contacts are visited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// First to last.
    #[default]
    Forward,
    /// Forwards, then backwards.
    Symmetric,
    /// In an order drawn from a seed, the same in every sweep.
    Shuffled(u64),
}

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Nlgs {
    /// How contacts are visited.
    pub order: Order,
    /// Over-relaxation, from 1 (none) to below 2.
    pub relaxation: f64,
    /// Ends with the last iterate instead of the best: for sweeps that are to go on.
    pub last: bool,
}

impl Default for Nlgs {
    fn default() -> Self {
        Self {
            order: Order::Forward,
            relaxation: 1.0,
            last: false,
        }
    }
}

/// The sweep's own memory.
pub struct Sweep<'a, const D: usize> {
    w: &'a BlockMatrix<D>,
    q: &'a [[f64; D]],
    laws: &'a [Law],
    locals: Vec<Local<D>>,
    /// What a change of impulse does to the residual, about: see [`Tests`].
    reach: Vec<f64>,
    /// Square of the residual that the last sweep took away, about.
    pub change: f64,
}

impl<'a, const D: usize> Sweep<'a, D> {
    /// Forms the inverses of the diagonal; none where W cannot be had as a matrix.
    pub fn new(form: &Form<'a, D>) -> Option<Self> {
        let w = form.w.matrix()?;
        Some(Self {
            w,
            q: form.q,
            laws: form.laws,
            locals: w
                .diagonal
                .iter()
                .zip(form.laws)
                .map(|(w, law)| Local::new(w, law.friction()))
                .collect(),
            reach: w
                .diagonal
                .iter()
                .map(|w| {
                    let largest = largest(w);
                    let reach = match form.norm {
                        Norm::Field => largest.min(1.0),
                        _ => largest,
                    };
                    reach * reach
                })
                .collect(),
            change: f64::INFINITY,
        })
    }

    /// Solves one contact.
    #[inline(always)]
    fn visit(&mut self, c: usize, p: &mut [[f64; D]], relaxation: f64) {
        let f = self.w.gather(c, p, self.q[c]);
        let new = match self.laws[c] {
            Law::Coulomb(_) => self.locals[c].solve(&f),
            law => self.locals[c].solve_rare(&f, &law, &p[c], p),
        };
        let old = p[c];
        let mut squared = 0.0;
        for k in 0..D {
            squared += (new[k] - old[k]) * (new[k] - old[k]);
        }
        self.change += self.reach[c] * squared;
        if relaxation == 1.0 {
            p[c] = new;
        } else {
            let far: [f64; D] = std::array::from_fn(|k| old[k] + relaxation * (new[k] - old[k]));
            p[c] = self.laws[c].project(&far, p);
        }
    }

    /// All contacts once.
    pub fn forward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        Arch::new().dispatch(Forward(self, p, relaxation));
    }

    /// All contacts once, in an order.
    pub fn along(&mut self, order: &[u32], p: &mut [[f64; D]], relaxation: f64) {
        self.change = 0.0;
        for c in order {
            self.visit(*c as usize, p, relaxation);
        }
    }

    /// All contacts once, last to first.
    pub fn backward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        self.change = 0.0;
        for c in (0..p.len()).rev() {
            self.visit(c, p, relaxation);
        }
    }
}

/// [`Sweep::forward`] for the vectors at hand.
struct Forward<'s, 'a, const D: usize>(&'s mut Sweep<'a, D>, &'s mut [[f64; D]], f64);

impl<const D: usize> WithSimd for Forward<'_, '_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        let Self(sweep, p, relaxation) = self;
        sweep.change = 0.0;
        for c in 0..p.len() {
            sweep.visit(c, p, relaxation);
        }
    }
}

/// When to measure the error, which costs about half a sweep: where it may be reached, if it followed the
/// change of a sweep since it was measured last.
#[derive(Default)]
pub struct Tests {
    done: u32,
    since: u32,
    /// [`Sweep::change`] at the last test.
    change: f64,
}

impl Tests {
    /// Sweeps at most between two tests; fewer at first, where impulses may go on to change in directions that
    /// the error does not see.
    const MAX_SWEEPS_APART: u32 = 10;
    /// The expected error over the tolerance from which to test.
    const NEAR: f64 = 1.5;

    /// After a sweep: whether to measure. The first often ends it.
    pub fn due<const D: usize>(
        &mut self,
        sweep: &Sweep<D>,
        state: &State<D>,
        budget: &Budget,
    ) -> bool {
        self.done += 1;
        self.since += 1;
        let near = Self::NEAR * budget.tolerance;
        let due = self.since >= (self.done / 2).clamp(1, Self::MAX_SWEEPS_APART)
            || self.expected(sweep, state) <= near * near
            || state.iterations >= budget.max_iterations;
        if due {
            self.since = 0;
            self.change = sweep.change;
        }
        due
    }

    /// Square of the error to expect after a sweep. 0 where nothing changes any more: that is to be
    /// measured.
    pub fn expected<const D: usize>(&self, sweep: &Sweep<D>, state: &State<D>) -> f64 {
        if sweep.change == 0.0 {
            return 0.0;
        }
        state.error * state.error * (sweep.change / self.change)
    }
}

/// The contacts in an order drawn from a seed.
fn shuffled(seed: u64, count: usize) -> Vec<u32> {
    use rand::seq::SliceRandom;
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.shuffle(&mut rand_pcg::Pcg64::new(seed.into(), 0xa02_bdbf_7bb3_c0a7));
    order
}

impl<const D: usize> Solver<D> for Nlgs {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        /// Tests without a better error after which there is to be less relaxation.
        const PATIENCE: u32 = 20;
        let Some(mut sweep) = Sweep::new(form) else {
            return;
        };
        let order = match self.order {
            Order::Shuffled(seed) => shuffled(seed, form.len()),
            _ => Vec::new(),
        };
        let mut best = Best::of(state);
        let mut relaxation = self.relaxation;
        let mut stalled = 0;
        let mut tests = Tests::default();
        while !budget.ends(state) {
            loop {
                match self.order {
                    Order::Symmetric if state.iterations % 2 == 1 => {
                        sweep.backward(&mut state.p, relaxation);
                    }
                    Order::Shuffled(_) => sweep.along(&order, &mut state.p, relaxation),
                    _ => sweep.forward(&mut state.p, relaxation),
                }
                state.iterations += 1;
                if tests.due(&sweep, state, budget) {
                    break;
                }
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
        if !self.last {
            best.restore(form, state);
        }
    }
}
