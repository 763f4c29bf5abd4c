//! Gauss-Seidel iterations with Anderson acceleration; see [`crate::solve::extrapolation`].

use super::form::Form;
use super::nlgs::{LocalSweep, Tests};
use super::state::{Best, Budget, Iteration, Solver};
use crate::solve::extrapolation::{Extrapolation, Safeguard};
use pulp::{Arch, Simd, WithSimd};

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Anderson {
    /// Maximum number of stored iterations, after which the memory is restarted.
    pub memory: usize,
    /// Number of iterations without a reduction of the smallest error by a fifth after which to
    /// end; `None` to continue to the end of the budget.
    pub patience: Option<usize>,
}

/// Plain iterations before the acceleration: for problems that converge in a few, its cost would
/// exceed its benefit.
const PLAIN: usize = 8;
/// Over-relaxation of the plain iterations.
const RELAXED: f64 = 1.3;
/// Returns the number of additional windows of [`WINDOW`] iterations to wait for if they would
/// converge at the last rate: in 2D an extrapolation costs as much as an iteration, in 3D less than
/// half.
const fn soon<const D: usize>() -> i32 {
    if D == 2 { 3 } else { 1 }
}
/// Iterations over which the convergence rate is measured.
const WINDOW: usize = 4;

/// Ratio of two errors below which the later one counts as progress.
const PROGRESS: f64 = 0.8;

/// Recovery from stagnation: where the error does not fall for long, extrapolation cycles between
/// contact statuses, and plain iterations lead out.
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
    /// Iterations without a reduction of the error by a fifth that count as stagnation.
    const STALL: usize = 100;
    /// Number of plain iterations that follow.
    const LENGTH: usize = 40;

    /// Returns, after a test, whether a recovery begins.
    fn begins(&mut self, error: f64, done: usize) -> bool {
        if error < PROGRESS * self.error {
            (self.error, self.at) = (error, done);
        } else if done > self.at + Self::STALL {
            (self.at, self.left) = (done, Self::LENGTH);
            return true;
        }
        false
    }

    /// Returns, before an iteration, whether it belongs to the recovery.
    fn lasts(&mut self) -> bool {
        let rests = self.left > 0;
        self.left = self.left.saturating_sub(1);
        rests
    }
}

impl Default for Anderson {
    fn default() -> Self {
        Self {
            memory: 8,
            patience: None,
        }
    }
}

/// Sets p and the next point to the projection of the extrapolated point, for the vector
/// instructions of this machine.
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
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        let Some(mut sweep) = LocalSweep::new(form) else {
            return;
        };
        let mut sequence: Option<Extrapolation> = None;
        let mut best = Best::of(state);
        let mut tests = Tests::default();
        let mut changes = [f64::INFINITY; WINDOW];
        let mut near = false;
        let mut rest = Rest::default();
        let mut done = 0;
        // Smallest error that counted as progress, and the iteration in which it was found.
        let mut progress = (f64::INFINITY, 0);
        while !budget.ends(state) {
            loop {
                if rest.lasts() {
                    sweep.forward(&mut state.p, 1.0);
                } else if sequence.is_none() && (done < PLAIN || near) {
                    // The first iteration often converges, so it is not relaxed.
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
                // The rate is squared, as the changes are.
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
            if best.error < PROGRESS * progress.0 {
                progress = (best.error, done);
            } else if self.patience.is_some_and(|most| done - progress.1 >= most) {
                break;
            }
        }
        best.restore(form, state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::error::Norm;
    use crate::solve::local::Csr;
    use crate::solve::local::block::BlockMatrix;
    use crate::solve::local::form::coulomb;

    /// For u_1 + u_2 = -2, whatever the impulses are, the error has a lower bound.
    #[test]
    fn it_ends_where_the_error_does_not_fall() {
        let entries = [(0, 0, 1.0), (0, 2, -1.0), (2, 0, -1.0), (2, 2, 1.0)];
        let entries: Vec<_> = entries
            .into_iter()
            .chain([(1, 1, 1.0), (3, 3, 1.0)])
            .collect();
        let w = BlockMatrix::<2>::from_csr(&Csr::from_triplets(4, 4, &entries));
        let (q, laws) = ([[-1.0, 0.0]; 2], coulomb(&[0.3; 2]));
        let form = Form::new(&w, &q, &laws, Norm::Field);
        let mut ends = Vec::new();
        for patience in [Some(50), Some(200), None] {
            let mut state = Iteration::new(&form, vec![[0.0; 2]; 2]);
            let mut budget = Budget::new(1e-8, 3000, 10.0);
            budget.history = Some(Vec::new());
            let anderson = Anderson {
                patience,
                ..Anderson::default()
            };
            anderson.solve(&form, &mut state, &mut budget);
            let errors = budget.history.unwrap_or_default();
            let least = errors.iter().map(|e| e.1).fold(f64::INFINITY, f64::min);
            // The result is the best iterate found.
            assert!(
                least > 1e-3 && state.error <= least,
                "{} {least}",
                state.error
            );
            ends.push(state.iterations);
        }
        assert!((50..200).contains(&ends[0]), "{ends:?}");
        assert!((200..1000).contains(&ends[1]), "{ends:?}");
        assert_eq!(ends[2], 3000);
    }
}
