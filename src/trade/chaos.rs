//! Test whether a case without random numbers is chaotic.
//!
//! The case's own setting is run twice, the second time with a step longer by 1e-10 of itself. If no
//! difference grows, the outputs agree to a similar accuracy; if contacts are chaotic, they differ as those
//! of two seeds do. Then runs whose steps are longer by k times 1e-10 take the place of seeds, and errors
//! have intervals.

use super::TradeError;
use super::child::{Ended, Launcher, Status, summary};
use super::output::{Output, Wanted};
use super::setting::Setting;
use super::study::Study;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Relative increase of the step for the second run; twice this for the third, and so on.
const RELATIVE_PERTURBATION: f64 = 1e-10;

/// Smallest noticed difference, as a fraction of the wanted error.
const NOTICED: f64 = 0.01;

/// Largest fraction of the budget for the two runs.
const SHARE: f64 = 0.2;

/// Distinction of the runs of a case without random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Seed of the unperturbed run.
    pub first: u64,
    /// The case's own step (s).
    pub step: f64,
}

impl Perturbation {
    /// Step of a run with these `--set` arguments (s); `None` if it is the setting's own, or is part of a
    /// whole `time`.
    pub fn step(&self, sets: &[&str], seed: u64) -> Option<f64> {
        let times = seed.wrapping_sub(self.first);
        let key = |set: &&str| set.split('=').next().unwrap_or_default().trim().to_owned();
        if times == 0 || sets.iter().any(|s| key(s) == "time") {
            return None;
        }
        let last = sets.iter().rfind(|s| key(s) == "time.step");
        let value = last.and_then(|s| s.split_once('=')?.1.trim().parse().ok());
        Some(value.unwrap_or(self.step) * (1.0 + RELATIVE_PERTURBATION * times as f64))
    }
}

impl Study {
    /// Tests a case without random numbers for chaos; if it is chaotic, each setting gets `runs` perturbed runs.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn test_for_chaos(&mut self, runs: u64, stop: &AtomicBool) -> Result<(), TradeError> {
        let first = self.seeds[0];
        if self.random || runs < 2 {
            return Ok(());
        }
        let own = Setting::own(&self.parameters);
        let sets = own.sets(&self.parameters);
        let deadline = self.started + self.budget.mul_f64(SHARE);
        let mut places = Vec::new();
        for seed in [first, first.wrapping_add(1)] {
            let run = match self.launcher.stored(&sets, seed) {
                Some(run) => run,
                None => match self.launcher.run(&sets, seed, deadline, None, stop)? {
                    Ended::Finished(run) => {
                        self.done.insert((own.clone(), seed), run.clone());
                        run
                    }
                    Ended::Interrupted => {
                        self.notes.push(format!(
                            "Whether contacts are chaotic was not tested: two runs take more than {:.0} % of the budget.",
                            100.0 * SHARE
                        ));
                        return Ok(());
                    }
                },
            };
            if run.status != Status::Done {
                return Ok(());
            }
            places.push(self.launcher.place(&sets, seed));
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
            Some(told) => {
                self.random = true;
                self.seeds = (0..runs).map(|k| first.wrapping_add(k)).collect();
                self.notes.push(format!(
                    "Nothing in the case is drawn from its seed, but a relative change of the step by {RELATIVE_PERTURBATION:e} changes {told}: \
                     contacts are chaotic, and runs with steps longer by multiples of that take the place of seeds."
                ));
            }
        }
        Ok(())
    }
}

/// Description of an output's difference between two runs, if it is noticed.
fn difference(output: &Output, one: &Path, other: &Path) -> Option<String> {
    let [a, b] = [one, other].map(|place| output.read(&summary(place), place));
    let (a, b) = (a?, b?);
    let wanted = match output.wanted {
        Wanted::Relative(w) => w * a.abs(),
        Wanted::Absolute(w) => w,
    };
    ((a - b).abs() > NOTICED * wanted).then(|| format!("`{}` from {a:.6e} to {b:.6e}", output.name))
}

impl Launcher {
    /// The `time.step` of a perturbed run.
    pub(super) fn perturbed_step(&self, sets: &[&str], seed: u64) -> Option<String> {
        let step = self.perturbation?.step(sets, seed)?;
        Some(format!("time.step={step:e}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perturbed_step_is_that_of_the_setting() {
        let perturbation = Perturbation {
            first: 7,
            step: 1e-3,
        };
        assert_eq!(perturbation.step(&[], 7), None);
        let twice = perturbation.step(&["solver.tolerance=1e-3"], 9).unwrap();
        assert!((twice / 1e-3 - 1.0 - 2e-10).abs() < 1e-15);
        let set = perturbation.step(&["time.step=5e-4", "time.step = 2e-4"], 8);
        assert!((set.unwrap() / 2e-4 - 1.0 - 1e-10).abs() < 1e-15);
        assert_eq!(perturbation.step(&["time=(step: 1e-4, end: 1.0)"], 8), None);
    }
}
