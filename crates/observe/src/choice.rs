//! Statistics of the solvers that `auto` chose during a run.

use super::quantity::unit::ONE;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::solve::{Attempt, Report, SolvePath};
use serde::{Deserialize, Serialize};

crate::described! {
    /// Counts over the steps of a run.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SolverStats {
        /// Steps in which Newton or the interior point solver was tried.
        pub factorised: u64 => ONE,
        /// Steps in which Newton was tried.
        pub newton_tried: u64 => ONE,
        /// Steps in which Newton converged.
        pub newton_ended: u64 => ONE,
        /// Steps in which the interior point solver was tried.
        pub interior_tried: u64 => ONE,
        /// Steps in which the interior point solver converged.
        pub interior_ended: u64 => ONE,
        /// Steps in which Newton in velocities was tried.
        pub velocities_tried: u64 => ONE,
        /// Steps in which Newton in velocities converged.
        pub velocities_ended: u64 => ONE,
        /// Ratio of unknowns to degrees of freedom of the contacts that carry force; mean over the
        /// steps in which either solver was tried.
        pub hyperstaticity_mean: f64 => ONE,
        /// Mean number of NLGS iterations before either solver was tried.
        pub sweeps_before_mean: f64 => ONE,
        /// Steps in which NLGS converged after Newton would have been tried on other contact sets;
        /// on hyperstatic sets it is tried later.
        pub swept_longer: u64 => ONE,
        /// Steps that stayed with NLGS because Newton does not support friction against rotation.
        pub newton_unserved: u64 => ONE,
        /// Steps that stayed with NLGS because there were too many contacts to factorise.
        pub too_large: u64 => ONE,
    }
}

impl SolverStats {
    /// Adds a step.
    pub fn add(&mut self, report: &Report) {
        match report.chosen {
            SolvePath::Sweeps => {}
            SolvePath::Longer { .. } => self.swept_longer += 1,
            SolvePath::Unserved => self.newton_unserved += 1,
            SolvePath::Large => self.too_large += 1,
            SolvePath::InVelocities { newton, .. } => {
                self.velocities_tried += u64::from(newton != Attempt::No);
                self.velocities_ended += u64::from(newton == Attempt::Ended);
            }
            SolvePath::Factorised {
                after,
                hyperstaticity,
                newton,
                interior,
            } => {
                self.newton_tried += u64::from(newton != Attempt::No);
                self.newton_ended += u64::from(newton == Attempt::Ended);
                self.interior_tried += u64::from(interior != Attempt::No);
                self.interior_ended += u64::from(interior == Attempt::Ended);
                self.factorised += 1;
                let part = 1.0 / self.factorised as f64;
                self.hyperstaticity_mean += (hyperstaticity - self.hyperstaticity_mean) * part;
                self.sweeps_before_mean += (f64::from(after) - self.sweeps_before_mean) * part;
            }
        }
    }

    /// Describes the choice and its reason.
    pub fn why(&self, method: Method, steps: u64) -> String {
        if method != Method::Auto {
            return format!("{} was requested", method.name());
        }
        if self.factorised > 0 {
            let set = if self.hyperstaticity_mean > 1.0 {
                "hyperstatic"
            } else {
                "not hyperstatic"
            };
            return format!(
                "solvers with a factorisation were tried in {} of {steps} steps, after {:.0} sweeps on average had not converged ({:.2} unknowns per degree of freedom: {set}): newton converged in {} of {}, interior in {} of {}; sweeps solved the other steps{}",
                self.factorised,
                self.sweeps_before_mean,
                self.hyperstaticity_mean,
                self.newton_ended,
                self.newton_tried,
                self.interior_ended,
                self.interior_tried,
                match self.swept_longer {
                    0 => String::new(),
                    n => format!(", {n} of them because the contacts were hyperstatic"),
                }
            );
        }
        if self.velocities_tried > 0 {
            return format!(
                "newton in velocities was tried in {} of {steps} steps, after sweeps had not converged in its time, and converged in {}; sweeps solved the other steps",
                self.velocities_tried, self.velocities_ended
            );
        }
        if self.swept_longer > 0 {
            return format!(
                "sweeps only; in {} of {steps} steps newton would have been tried, but on hyperstatic contacts it is tried later",
                self.swept_longer
            );
        }
        if self.newton_unserved > 0 {
            return format!(
                "sweeps only; in {} of {steps} steps newton would have been tried, but it does not support friction against rotation",
                self.newton_unserved
            );
        }
        if self.too_large > 0 {
            return format!(
                "sweeps only; in {} of {steps} steps newton would have been tried, but there were too many contacts to factorise",
                self.too_large
            );
        }
        "sweeps, which converged before a factorisation would have been worth its cost".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_says_what_was_counted() {
        let mut choice = SolverStats::default();
        choice.add(&Report::default());
        assert!(choice.why(Method::Auto, 1).starts_with("sweeps"));
        assert_eq!(choice.why(Method::Pg, 1), "pg was requested");
        for (after, hyperstaticity, newton, interior) in [
            (100, 1.0, Attempt::Ended, Attempt::No),
            (300, 2.0, Attempt::Failed, Attempt::Ended),
        ] {
            choice.add(&Report {
                chosen: SolvePath::Factorised {
                    after,
                    hyperstaticity,
                    newton,
                    interior,
                },
                ..Report::default()
            });
        }
        let why = choice.why(Method::Auto, 3);
        for part in [
            "2 of 3 steps",
            "200 sweeps",
            "1.50",
            ": hyperstatic",
            "newton converged in 1 of 2",
            "interior in 1 of 1",
        ] {
            assert!(why.contains(part), "{why}");
        }
        let unserved = SolverStats {
            newton_unserved: 4,
            ..SolverStats::default()
        };
        assert!(unserved.why(Method::Auto, 9).contains("4 of 9"));
    }
}
