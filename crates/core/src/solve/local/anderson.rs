//! Gauss-Seidel sweeps with Anderson's acceleration, see [`crate::solve::extrapolation`].

use super::form::Form;
use super::nlgs::{Sweep, Tests};
use super::state::{Best, Budget, Solver, State};
use crate::solve::extrapolation::{Extrapolation, Safeguard};
use pulp::{Arch, Simd, WithSimd};

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Anderson {
    /// Sweeps remembered at most, after which the memory is begun anew.
    pub memory: usize,
}

/// Sweeps before the memory is begun: where few do, its sums would cost more than they save.
const PLAIN: usize = 8;
/// Over-relaxation of these.
const RELAXED: f64 = 1.3;
/// So many times [`WINDOW`] more of them are waited for, where they would do at the rate of the last: in the
/// plane an extrapolation costs as much as a sweep, in space less than half.
const fn soon<const D: usize>() -> i32 {
    if D == 2 { 3 } else { 1 }
}
/// Sweeps over which the rate is formed.
const WINDOW: usize = 4;

/// Ends a stall: where the error does not fall for long, extrapolations go round in circles between contacts'
/// branches, and plain sweeps lead out.
struct Rest {
    error: f64,
    at: usize,
    left: usize,
}

impl Default for Rest {
    fn default() -> Self {
        Self {
            error: f64::INFINITY,
            at: 0,
            left: 0,
        }
    }
}

impl Rest {
    /// Sweeps without a fall by a fifth that are a stall.
    const STALL: usize = 100;
    /// Plain sweeps after it.
    const LENGTH: usize = 40;

    /// After a test: whether a rest begins.
    fn begins(&mut self, error: f64, done: usize) -> bool {
        if error < 0.8 * self.error {
            (self.error, self.at) = (error, done);
        } else if done > self.at + Self::STALL {
            (self.at, self.left) = (done, Self::LENGTH);
            return true;
        }
        false
    }

    /// Before a sweep: whether it is one of the rest.
    fn lasts(&mut self) -> bool {
        let rests = self.left > 0;
        self.left = self.left.saturating_sub(1);
        rests
    }
}

impl Default for Anderson {
    fn default() -> Self {
        Self { memory: 8 }
    }
}

/// p and the start = the admissible point next to it, for the vectors at hand.
struct Adopt<'a, const D: usize>(&'a Form<'a, D>, &'a mut [f64], &'a mut [[f64; D]]);

impl<const D: usize> WithSimd for Adopt<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        let Self(form, start, p) = self;
        p.as_flattened_mut().copy_from_slice(start);
        for c in 0..p.len() {
            p[c] = form.laws[c].project(&p[c], p);
        }
        start.copy_from_slice(p.as_flattened());
    }
}

impl<const D: usize> Solver<D> for Anderson {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let Some(mut sweep) = Sweep::new(form) else {
            return;
        };
        let mut sequence: Option<Extrapolation> = None;
        let mut best = Best::of(state);
        let mut tests = Tests::default();
        let mut changes = [f64::INFINITY; WINDOW];
        let mut near = false;
        let mut rest = Rest::default();
        let mut done = 0;
        while !budget.ends(state) {
            loop {
                if rest.lasts() {
                    sweep.forward(&mut state.p, 1.0);
                } else if sequence.is_none() && (done < PLAIN || near) {
                    // The first sweep often ends it, so it is not relaxed.
                    let relaxation = if done == 0 { 1.0 } else { RELAXED };
                    sweep.forward(&mut state.p, relaxation);
                } else {
                    match &mut sequence {
                        Some(sequence) => sequence.next(state.p.as_flattened()),
                        none => {
                            let p = state.p.as_flattened();
                            *none = Some(Extrapolation::new(self.memory, Safeguard::Anew, p));
                        }
                    }
                    if let Some(sequence) = &mut sequence {
                        Arch::new().dispatch(Adopt(form, &mut sequence.start, &mut state.p));
                    }
                    sweep.forward(&mut state.p, 1.0);
                }
                // Squared, as changes are.
                let rate = sweep.change / changes[done % WINDOW];
                changes[done % WINDOW] = sweep.change;
                let end = tests.expected(&sweep, state) * rate.powi(soon::<D>());
                near = end <= budget.tolerance * budget.tolerance;
                done += 1;
                state.iterations += 1;
                if tests.due(&sweep, state, budget) {
                    break;
                }
            }
            state.measure(form);
            if rest.begins(state.error, done) {
                sequence = None;
            }
            best.keep(state);
        }
        best.restore(form, state);
    }
}
