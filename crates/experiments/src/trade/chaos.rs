//! Test whether a case without random numbers is chaotic.
//!
//! The case's own setting is run twice, the second time with a step longer by 1e-10 of itself. If
//! no difference grows, the outputs agree to a similar accuracy; if contacts are chaotic, they
//! differ as those of two seeds do. Then runs whose steps are longer by k times 1e-10 take the
//! place of seeds, and errors have intervals.

use super::combination::Combination;
use super::output::{ErrorTarget, Output};
use super::plan::Trade;
use crate::Error;
use crate::runs::launcher::WaitLimits;
use crate::runs::perturbation::RELATIVE_PERTURBATION;
use crate::runs::stored::{Status, summary};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Smallest difference that is noticed, as a fraction of the wanted error.
const NOTICED: f64 = 0.01;

/// Largest fraction of the budget for the two runs.
const SHARE: f64 = 0.2;

impl Trade {
    /// Tests a case without random numbers for chaos; if it is chaotic, each setting gets `runs`
    /// perturbed runs.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn test_for_chaos(&mut self, runs: u64, stop: &AtomicBool) -> Result<(), Error> {
        let first = self.seeds[0];
        if self.random || runs < 2 {
            return Ok(());
        }
        let own = Combination::own(&self.parameters);
        let wait = WaitLimits {
            deadline: Some(self.started + self.budget.mul_f64(SHARE)),
            limit: None,
            stop,
        };
        let mut places = Vec::new();
        for seed in [first, first.wrapping_add(1)] {
            let run = self.run_of(&own, seed);
            places.push(self.launcher.place(&run));
            if let Some(stored) = self.launcher.stored(&run) {
                if stored.status != Status::Done {
                    return Ok(());
                }
                continue;
            }
            let Some(finished) = self.launcher.run(&run, wait)? else {
                self.notes.push(format!(
                    "Whether contacts are chaotic was not tested: two runs take more than {:.0} % of the budget.",
                    100.0 * SHARE
                ));
                return Ok(());
            };
            let done = finished.status == Status::Done;
            self.done.insert((own.clone(), seed), finished);
            if !done {
                return Ok(());
            }
        }
        self.fresh = self.done.len();
        let [one, other] = [&places[0], &places[1]];
        let difference = self.outputs.iter().find_map(|o| difference(o, one, other));
        match difference {
            None => {
                self.done.remove(&(own, first.wrapping_add(1)));
                self.notes.push(format!(
                    "Nothing in the case is drawn from its seed, and a relative change of the step by {RELATIVE_PERTURBATION:e} changes no output \
                     by a hundredth of the error wanted: one run a setting, and errors without intervals."
                ));
            }
            Some(changed) => {
                self.random = true;
                self.seeds = (0..runs).map(|k| first.wrapping_add(k)).collect();
                self.notes.push(format!(
                    "Nothing in the case is drawn from its seed, but a relative change of the step by {RELATIVE_PERTURBATION:e} changes {changed}: \
                     contacts are chaotic, and runs with steps longer by multiples of that take the place of seeds."
                ));
            }
        }
        Ok(())
    }
}

/// Describes an output's difference between two runs, if it is noticed.
fn difference(output: &Output, one: &Path, other: &Path) -> Option<String> {
    let [a, b] = [one, other].map(|place| output.quantity.read(&summary(place), place));
    let (a, b) = (a?, b?);
    let wanted = match output.wanted {
        ErrorTarget::Relative(w) => w * a.abs(),
        ErrorTarget::Absolute(w) => w,
    };
    ((a - b).abs() > NOTICED * wanted)
        .then(|| format!("`{}` from {a:.6e} to {b:.6e}", output.name()))
}
