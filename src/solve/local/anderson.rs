//! Gauss-Seidel sweeps with Anderson's acceleration, see [`crate::solve::extrapolation`].

use super::form::Form;
use super::nlgs::{Sweep, Tests};
use super::state::{Best, Budget, Solver, State};
use crate::solve::extrapolation::{Extrapolation, Safeguard};

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Anderson {
    /// Sweeps remembered at most, after which the memory is begun anew.
    pub memory: usize,
}

/// Sweeps before the memory is begun: where few do, its sums would cost more than they save.
const PLAIN: u32 = 8;
/// Over-relaxation of these.
const RELAXED: f64 = 1.3;

impl Default for Anderson {
    fn default() -> Self {
        Self { memory: 8 }
    }
}

/// p and the start = the admissible point next to it.
fn adopt<const D: usize>(form: &Form<D>, start: &mut [f64], state: &mut State<D>) {
    state.p.as_flattened_mut().copy_from_slice(start);
    for c in 0..state.p.len() {
        state.p[c] = form.laws[c].project(&state.p[c], &state.p);
    }
    start.copy_from_slice(state.p.as_flattened());
}

impl<const D: usize> Solver<D> for Anderson {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let mut sweep = Sweep::new(form);
        let mut sequence: Option<Extrapolation> = None;
        let mut best = Best::of(state);
        let mut tests = Tests::default();
        let mut done = 0;
        while !budget.ends(state) {
            loop {
                if done < PLAIN {
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
                        adopt(form, &mut sequence.start, state);
                    }
                    sweep.forward(&mut state.p, 1.0);
                }
                done += 1;
                state.iterations += 1;
                if tests.due(&sweep, state, budget) {
                    break;
                }
            }
            state.measure(form);
            best.keep(state);
        }
        best.restore(form, state);
    }
}
