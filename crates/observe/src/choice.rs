//! What `auto` chose over a run, in one sentence.

use fretwork_core::solve::local::solver::Method;
use fretwork_core::solve::{Attempt, Report, SolvePath};
use serde::{Deserialize, Serialize};

/// Counts over the steps of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Steps in which Newton or the interior point was tried.
    pub factorised: u64,
    /// Steps in which Newton was tried.
    pub newton_tried: u64,
    /// Steps which it ended.
    pub newton_ended: u64,
    /// Steps in which the interior point was tried.
    pub interior_tried: u64,
    /// Steps which it ended.
    pub interior_ended: u64,
    /// Mean over the steps in which either was tried: unknowns that carry over degrees of freedom that they move.
    pub hyperstaticity_mean: f64,
    /// Mean sweeps before them.
    pub sweeps_before_mean: f64,
    /// Steps that sweeps ended after Newton would have been due, on hyperstatic sets, where it comes later.
    pub swept_longer: u64,
    /// Steps that swept on because Newton does not serve friction against rotation.
    pub newton_unserved: u64,
    /// Steps that swept on because there were too many contacts to factorise.
    pub too_large: u64,
}

impl Choice {
    /// Counts a step.
    pub fn add(&mut self, report: &Report) {
        match report.chosen {
            SolvePath::Sweeps => {}
            SolvePath::Longer { .. } => self.swept_longer += 1,
            SolvePath::Unserved => self.newton_unserved += 1,
            SolvePath::Large => self.too_large += 1,
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

    /// What was chosen and why.
    pub fn why(&self, method: Method, steps: u64) -> String {
        if method != Method::Auto {
            return format!("{} was asked for", method.name());
        }
        if self.factorised > 0 {
            let set = if self.hyperstaticity_mean > 1.0 {
                "hyperstatic"
            } else {
                "not hyperstatic"
            };
            return format!(
                "methods that factorise were tried in {} of {steps} steps, after {:.0} sweeps on average had not been enough ({:.2} unknowns a degree of freedom: {set}): newton ended {} of {}, interior {} of {}; sweeps did the rest{}",
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
        if self.swept_longer > 0 {
            return format!(
                "sweeps alone; in {} of {steps} steps newton was due, but comes later on hyperstatic contacts",
                self.swept_longer
            );
        }
        if self.newton_unserved > 0 {
            return format!(
                "sweeps alone; in {} of {steps} steps newton was due and does not serve friction against rotation",
                self.newton_unserved
            );
        }
        if self.too_large > 0 {
            return format!(
                "sweeps alone; in {} of {steps} steps newton was due and there were too many contacts to factorise",
                self.too_large
            );
        }
        "sweeps, which were enough before a factorisation would have paid".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_says_what_was_counted() {
        let mut choice = Choice::default();
        choice.add(&Report::default());
        assert!(choice.why(Method::Auto, 1).starts_with("sweeps"));
        assert_eq!(choice.why(Method::Pg, 1), "pg was asked for");
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
            "newton ended 1 of 2",
            "interior 1 of 1",
        ] {
            assert!(why.contains(part), "{why}");
        }
        let unserved = Choice {
            newton_unserved: 4,
            ..Choice::default()
        };
        assert!(unserved.why(Method::Auto, 9).contains("4 of 9"));
    }
}
