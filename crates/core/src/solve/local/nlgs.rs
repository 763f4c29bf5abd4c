//! Non-linear Gauss-Seidel on a matrix: contact by contact, each solved exactly.

use super::block::BlockMatrix;
use super::contact::Local;
use super::form::{Form, largest};
use super::law::Law;
use super::state::{Best, Budget, Iteration, Solver};
use crate::solve::error::Norm;
use pulp::{Arch, Simd, WithSimd};

/// Order in which contacts are visited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The first to the last contact.
    #[default]
    Forward,
    /// Forwards, then backwards.
    Symmetric,
    /// A random order from a seed, the same in every iteration.
    Shuffled(u64),
}

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Nlgs {
    /// Order in which contacts are visited.
    pub order: Order,
    /// Over-relaxation factor, from 1 (no relaxation) to below 2.
    pub relaxation: f64,
    /// Whether to end with the last iterate instead of the best, for iterations that are continued
    /// later.
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

/// Working memory of the Gauss-Seidel iteration.
pub struct LocalSweep<'a, const D: usize> {
    w: &'a BlockMatrix<D>,
    q: &'a [[f64; D]],
    laws: &'a [Law],
    locals: Vec<Local<D>>,
    /// Estimated sensitivity of the residual to a change of impulse; see [`Tests`].
    reach: Vec<f64>,
    /// Estimated squared residual removed by the last iteration.
    pub change: f64,
}

impl<'a, const D: usize> LocalSweep<'a, D> {
    /// Computes the inverses of the diagonal; `None` where W is not available as a matrix.
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

    /// Visits all contacts once.
    pub fn forward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        Arch::new().dispatch(Forward(self, p, relaxation));
    }

    /// Visits all contacts once, in the given order.
    pub fn along(&mut self, order: &[u32], p: &mut [[f64; D]], relaxation: f64) {
        self.change = 0.0;
        for c in order {
            self.visit(*c as usize, p, relaxation);
        }
    }

    /// Visits all contacts once, from last to first.
    pub fn backward(&mut self, p: &mut [[f64; D]], relaxation: f64) {
        self.change = 0.0;
        for c in (0..p.len()).rev() {
            self.visit(c, p, relaxation);
        }
    }
}

/// [`LocalSweep::forward`] for the vector instructions of this machine.
struct Forward<'s, 'a, const D: usize>(&'s mut LocalSweep<'a, D>, &'s mut [[f64; D]], f64);

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

/// Decides when to evaluate the error, which costs about half an iteration: when it may have
/// reached the tolerance, if it decreased like the change per iteration since the last evaluation.
#[derive(Default)]
pub struct Tests {
    done: u32,
    since: u32,
    /// [`LocalSweep::change`] at the last test.
    change: f64,
}

impl Tests {
    /// Maximum number of iterations between two evaluations; fewer at first, when impulses may
    /// still change in directions that the error does not detect.
    const MAX_SWEEPS_APART: u32 = 10;
    /// Ratio of expected error to tolerance from which the error is evaluated.
    const NEAR: f64 = 1.5;

    /// Returns, after an iteration, whether to evaluate the error. The first iteration often
    /// converges.
    pub fn due<const D: usize>(
        &mut self,
        sweep: &LocalSweep<D>,
        state: &Iteration<D>,
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

    /// Returns the squared error expected after an iteration; 0 where nothing changes any more, so
    /// that it is evaluated.
    pub fn expected<const D: usize>(&self, sweep: &LocalSweep<D>, state: &Iteration<D>) -> f64 {
        if sweep.change == 0.0 {
            return 0.0;
        }
        state.error * state.error * (sweep.change / self.change)
    }
}

/// Returns the contacts in a random order from a seed.
fn shuffled(seed: u64, count: usize) -> Vec<u32> {
    use rand::seq::SliceRandom;
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.shuffle(&mut rand_pcg::Pcg64::new(seed.into(), 0xa02_bdbf_7bb3_c0a7));
    order
}

impl<const D: usize> Solver<D> for Nlgs {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        /// Evaluations without a smaller error after which the relaxation is reduced.
        const PATIENCE: u32 = 20;
        let Some(mut sweep) = LocalSweep::new(form) else {
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
