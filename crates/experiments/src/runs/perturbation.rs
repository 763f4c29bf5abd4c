//! Runs of a case without random numbers, distinguished by a change of the step far below its error
//! instead of by seeds.

/// Relative increase of the step for the second run; twice this for the third, and so on.
pub const RELATIVE_PERTURBATION: f64 = 1e-10;

/// Perturbation that distinguishes the runs of a case without random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Seed of the unperturbed run.
    pub first: u64,
}

impl Perturbation {
    /// Returns whether the run with this seed has a perturbed step.
    pub fn of(&self, seed: u64) -> bool {
        seed != self.first
    }

    /// Returns the step of the run with this seed (s), for a setting with this step.
    pub fn step(&self, step: f64, seed: u64) -> f64 {
        step * (1.0 + RELATIVE_PERTURBATION * seed.wrapping_sub(self.first) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perturbed_step_is_that_of_the_setting() {
        let perturbation = Perturbation { first: 7 };
        assert!(!perturbation.of(7) && perturbation.of(8));
        assert_eq!(perturbation.step(1e-3, 7), 1e-3);
        let twice = perturbation.step(1e-3, 9);
        assert!((twice / 1e-3 - 1.0 - 2e-10).abs() < 1e-15);
    }
}
