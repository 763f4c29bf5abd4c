//! Runs of a case without random numbers told apart by a change of the step far below its error, in place of seeds.

/// Relative increase of the step for the second run; twice this for the third, and so on.
pub const RELATIVE_PERTURBATION: f64 = 1e-10;

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
    pub fn step(&self, sets: &[String], seed: u64) -> Option<f64> {
        let times = seed.wrapping_sub(self.first);
        let key = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
        if times == 0 || sets.iter().any(|s| key(s) == "time") {
            return None;
        }
        let last = sets.iter().rfind(|s| key(s) == "time.step");
        let value = last.and_then(|s| s.split_once('=')?.1.trim().parse().ok());
        Some(value.unwrap_or(self.step) * (1.0 + RELATIVE_PERTURBATION * times as f64))
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
        let step = |sets: &[&str], seed| {
            let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
            perturbation.step(&sets, seed)
        };
        assert_eq!(step(&[], 7), None);
        let twice = step(&["solver.tolerance=1e-3"], 9).unwrap();
        assert!((twice / 1e-3 - 1.0 - 2e-10).abs() < 1e-15);
        let set = step(&["time.step=5e-4", "time.step = 2e-4"], 8);
        assert!((set.unwrap() / 2e-4 - 1.0 - 1e-10).abs() < 1e-15);
        assert_eq!(step(&["time=(step: 1e-4, end: 1.0)"], 8), None);
    }
}
