//! Trust in a run, in three grades: whether its ledgers close and its steps converged, and what is
//! known of the error of its headline.

use super::SampleFacts;
use super::SlidingTest;
use crate::quantity::{Estimate, Findings, Quantity, Role, Topic, percent, short_cause};
use serde::Serialize;

/// Largest error of a headline that counts as small, as a share of its value.
pub const SMALL: f64 = 0.05;

/// Path of the result whose scatter over seeds was studied.
const SLIDING: &str = SlidingTest::COEFFICIENT;

/// Trust in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Grade {
    /// A check failed.
    #[default]
    #[serde(rename = "not trustworthy")]
    NotTrustworthy,
    /// The ledgers close and the steps converged; the error of the headline is large or not known.
    #[serde(rename = "consistent")]
    Consistent,
    /// In addition the error of the headline is known and small, of the causes that are named.
    #[serde(rename = "error known")]
    ErrorKnown,
}

/// What a run knows of the error of its headline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadlineError {
    /// Name of the headline; empty where the run has none.
    pub label: String,
    /// Causes whose effect is known, with the half-width as a share of the value.
    pub known: Vec<(String, f64)>,
    /// Causes whose effect on the headline is not known although the run looked for it.
    pub unknown: Vec<String>,
    /// Causes that one run cannot know, and that were not studied.
    pub beyond: Vec<&'static str>,
}

impl HeadlineError {
    /// Returns what is known of the first headline that has a value, in the order of topics; a
    /// headline with half-widths comes before others of its topic.
    pub fn of(found: &Findings, sample: &SampleFacts) -> Self {
        let value = |q: &&Quantity| {
            let value = q.value.as_f64().filter(|v| v.is_finite() && *v != 0.0);
            q.role == Role::Headline && value.is_some()
        };
        let headlines = found.all().iter().filter(value);
        let headline = headlines.min_by_key(|q| (q.topic, q.estimate.is_none()));
        let Some(headline) = headline else {
            return Self::default();
        };
        let estimate = headline.estimate.clone().unwrap_or_default();
        let mut out = Self {
            label: headline.label(),
            ..Self::default()
        };
        let chosen = chosen_accuracy(found);
        for (of, share) in estimate.shares() {
            match share < 1.0 {
                true => out.known.push((of, share)),
                false => out.unknown.push(of),
            }
        }
        match chosen.filter(|_| estimate.step.is_none()) {
            Some(share) => out.known.push(("step and tolerance".to_owned(), share)),
            None => out.missing(&estimate),
        }
        // A mean over cycles or blocks has a scatter, unless it still changes; of a random sample
        // one cycle is not known to be like the next.
        let one = sample.random && headline.topic == Topic::Friction;
        if (estimate.method.is_some() || one) && estimate.scatter.is_none() {
            out.unknown.push("sample".to_owned());
        }
        if sample.cells {
            out.beyond.push("cells");
        }
        let studied = sample.sliding.filter(|_| headline.name() == SLIDING);
        match studied {
            Some(study) => out
                .known
                .push((format!("over {} seeds", study.seeds), study.half_width())),
            None if sample.random => out.beyond.push("seeds"),
            None => {}
        }
        out
    }

    /// Adds the settings that were not estimated.
    fn missing(&mut self, estimate: &Estimate) {
        for (of, half) in [("step", estimate.step), ("tolerance", estimate.tolerance)] {
            if half.is_none() {
                self.unknown.push(of.to_owned());
            }
        }
    }

    /// Returns the error from all known causes together, as a share of the value.
    pub fn share(&self) -> f64 {
        let squares = self.known.iter().map(|(_, share)| share * share);
        squares.sum::<f64>().sqrt()
    }

    /// Returns the grade of a run that passed all checks.
    pub fn grade(&self) -> Grade {
        let known = !self.known.is_empty() && self.unknown.is_empty();
        match known && self.share() <= SMALL {
            true => Grade::ErrorKnown,
            false => Grade::Consistent,
        }
    }

    /// Returns the verdict on a run in a line: its grade, of what the error is known and by which
    /// causes, and what was not studied.
    pub fn verdict(&self, grade: Grade) -> String {
        let of = match self.label.as_str() {
            "" => "the main result",
            label => label,
        };
        let names: Vec<&str> = self.known.iter().map(|(of, _)| short_cause(of)).collect();
        let beyond = match self.beyond.as_slice() {
            [] => String::new(),
            list => format!("; {}: not studied", list.join(", ")),
        };
        match grade {
            Grade::NotTrustworthy => "NOT TRUSTWORTHY".to_owned(),
            Grade::Consistent => format!(
                "CONSISTENT: ledgers close, steps converged; error of {of} not known to be small"
            ),
            Grade::ErrorKnown => {
                format!("ERROR KNOWN: {of} ({}){beyond}", names.join(", "))
            }
        }
    }

    /// Says what is known of the error and what is not.
    pub fn sentence(&self) -> String {
        if self.label.is_empty() {
            return "the run has no headline result whose error could be known".to_owned();
        }
        let known = self.known.iter();
        let known: Vec<String> = known
            .map(|(of, share)| format!("{of} {}", percent(*share)))
            .collect();
        let beyond = self.beyond.iter().map(|of| (*of).to_owned());
        let unknown: Vec<String> = self.unknown.iter().cloned().chain(beyond).collect();
        let known = known.join(", ");
        let unknown = unknown.join(", ");
        let of = format!("error of {}", self.label);
        match (known.is_empty(), unknown.is_empty()) {
            (true, _) => format!("{of} not known by {unknown}"),
            (false, true) => format!("{of}: {known}"),
            // What is not known comes first, since a line may end before the causes do.
            (false, false) => format!("{of} not known by {unknown}; known: {known}"),
        }
    }
}

/// Returns the share to which a run has chosen step and tolerance, if that was reached.
fn chosen_accuracy(found: &Findings) -> Option<f64> {
    let reached = found.quantity("accuracy.reached")?.value.as_bool()?;
    found.number("accuracy.share").filter(|_| reached)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::unit::ONE;
    use crate::summary::SeedScatter;

    fn found(estimate: Estimate) -> Findings {
        let mut found = Findings::new(2);
        found.begin(Topic::Wear, Role::Headline);
        found.add("worn", 2.0, ONE, "wear").headline("wear");
        found.begin(Topic::Friction, Role::Headline);
        found.add("none", (), ONE, "no value").headline("slip");
        found.add("mu", 0.4, ONE, "friction").headline("friction");
        found.estimate("mu", &estimate);
        found
    }

    fn known() -> Estimate {
        Estimate {
            value: Some(0.4),
            scatter: Some(0.004),
            step: Some(0.002),
            tolerance: Some(0.0004),
            method: Some("Student".to_owned()),
            scope: Some("within this sample (3 cycles)".to_owned()),
            ..Estimate::default()
        }
    }

    #[test]
    fn the_error_of_the_headline_is_known_where_each_cause_is_and_small_below_a_twentieth() {
        let random = SampleFacts {
            random: true,
            ..SampleFacts::default()
        };
        let of = |estimate| HeadlineError::of(&found(estimate), &random);
        let error = of(known());
        assert_eq!(error.grade(), Grade::ErrorKnown);
        assert_eq!(
            error.sentence(),
            "error of friction not known by seeds; known: step 0.50 %, tolerance 0.10 %, within this sample (3 cycles) 1.0 %"
        );
        assert_eq!(
            error.verdict(error.grade()),
            "ERROR KNOWN: friction (step, tolerance, cycles); seeds: not studied"
        );
        for (estimate, says) in [
            (
                Estimate {
                    step: None,
                    ..known()
                },
                "not known by step, seeds",
            ),
            (
                Estimate {
                    step: Some(0.5),
                    ..known()
                },
                "not known by step, seeds",
            ),
            (
                Estimate {
                    scatter: None,
                    ..known()
                },
                "not known by sample, seeds",
            ),
            (
                Estimate {
                    tolerance: Some(0.03),
                    ..known()
                },
                "tolerance 7.5 %",
            ),
        ] {
            let error = of(estimate);
            assert_eq!(error.grade(), Grade::Consistent, "{error:?}");
            let text = error.sentence();
            assert!(text.contains(says), "{text}");
        }
    }

    /// One cycle of a random sample has no scatter, and says nothing of the next.
    #[test]
    fn friction_of_one_cycle_of_a_random_sample_is_not_known() {
        let one = || Estimate {
            scatter: None,
            scope: None,
            method: None,
            ..known()
        };
        let of = |random| {
            let sample = SampleFacts {
                random,
                ..SampleFacts::default()
            };
            HeadlineError::of(&found(one()), &sample)
        };
        assert_eq!(of(false).grade(), Grade::ErrorKnown);
        let error = of(true);
        assert_eq!(error.grade(), Grade::Consistent);
        assert!(
            error.sentence().contains("not known by sample, seeds"),
            "{error:?}"
        );
        assert!(
            error
                .verdict(error.grade())
                .ends_with("error of friction not known to be small"),
            "{error:?}"
        );
    }

    #[test]
    fn a_studied_scatter_of_seeds_is_a_known_cause_of_the_coefficient_of_sliding() {
        let of = |deviation, path: &str| {
            let sample = SampleFacts {
                random: true,
                sliding: Some(SeedScatter {
                    seeds: 5,
                    mean: 0.4,
                    deviation,
                }),
                ..SampleFacts::default()
            };
            let mut found = Findings::new(2);
            found.begin(Topic::Friction, Role::Headline);
            found.add(path, 0.4, ONE, "friction").headline("friction");
            found.estimate(path, &known());
            HeadlineError::of(&found, &sample)
        };
        let small = of(0.01, SLIDING);
        assert_eq!(small.grade(), Grade::ErrorKnown);
        assert_eq!(
            small.verdict(small.grade()),
            "ERROR KNOWN: friction (step, tolerance, cycles, seeds)"
        );
        // 0.06 by one seed.
        let large = of(0.02, SLIDING);
        assert_eq!(large.grade(), Grade::Consistent, "{large:?}");
        assert!(large.sentence().contains("over 5 seeds 6.1 %"), "{large:?}");
        assert_eq!(of(0.02, "another").beyond, ["seeds"]);
    }

    #[test]
    fn a_run_without_a_headline_is_consistent_at_best() {
        let cells = SampleFacts {
            cells: true,
            ..SampleFacts::default()
        };
        let none = HeadlineError::of(&Findings::new(2), &cells);
        assert_eq!(none.grade(), Grade::Consistent);
        assert!(none.sentence().contains("no headline"));
    }

    #[test]
    fn a_reached_accuracy_is_a_known_error_of_step_and_tolerance() {
        let mut all = found(Estimate {
            step: None,
            tolerance: None,
            ..known()
        });
        all.add("accuracy.reached", true, ONE, "");
        all.add("accuracy.share", 0.03, ONE, "");
        let error = HeadlineError::of(&all, &SampleFacts::default());
        assert_eq!(error.grade(), Grade::ErrorKnown, "{error:?}");
        assert!(error.sentence().contains("step and tolerance 3.0 %"));
    }
}
