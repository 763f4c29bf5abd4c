//! Difference of a result between two runs, and what their half-widths say of it.

use super::{Estimate, quantity, with_half_width};

/// A result of a run, to be compared with that of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Value to which the half-widths refer.
    pub value: f64,
    /// Half-widths by cause: settings, and what the scatter is over without its number, such as
    /// `within this sample`.
    pub half_widths: Vec<(String, f64)>,
    /// Whether the result is determined, see [`super::DETERMINED`].
    pub determined: bool,
    /// Whether all checks of its run passed.
    pub trusted: bool,
    /// Whether another seed gives another sample.
    pub random: bool,
}

impl Compared {
    /// Returns a value with its estimate, if there is one, of a run without random numbers that
    /// passed all checks.
    pub fn new(value: f64, estimate: Option<&Estimate>) -> Self {
        let mean = estimate.and_then(|e| e.value).unwrap_or(value);
        let determined = estimate.and_then(Estimate::is_determined) != Some(false);
        let scatter = estimate.and_then(|e| {
            let scope = e.scope.as_deref().unwrap_or("within this sample");
            let over = scope.split_once(" (").map_or(scope, |(over, _)| over);
            Some((over.to_owned(), e.scatter?))
        });
        // The coupling is a part of the effect of the step.
        let settings = estimate.into_iter().flat_map(Estimate::settings);
        let settings = settings.filter(|(of, _)| *of != "coupling");
        let settings = settings.map(|(of, half)| (of.to_owned(), half));
        Self {
            value: mean,
            half_widths: settings.chain(scatter).collect(),
            determined,
            trusted: true,
            random: false,
        }
    }

    /// Returns its half-width of a cause.
    fn by(&self, cause: &str) -> Option<f64> {
        let own = self.half_widths.iter().find(|(of, _)| of == cause);
        own.map(|(_, half)| *half)
    }

    /// Returns the causes that this and another result have, or that this one alone has.
    fn causes(&self, other: &Self, shared: bool) -> Vec<String> {
        let own = self.half_widths.iter().map(|(of, _)| of);
        let own = own.filter(|of| other.by(of).is_some() == shared);
        own.cloned().collect()
    }
}

/// Significance of a difference, from the half-widths of 95 % intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Significance {
    /// The values are equal to the last digit.
    Equal,
    /// The difference is larger than its half-width.
    Differ,
    /// It is, but other seeds would give other samples, and what they scatter by is not in it.
    DifferInTheseSamples,
    /// The difference is within its half-width.
    NotKnownToDiffer,
    /// The two have no half-width of the same cause.
    NotKnown,
    /// A check of one of the two runs failed.
    NotTrusted,
    /// One of the two is not determined.
    NotDetermined,
}

impl Significance {
    /// Words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Differ => "they differ",
            Self::DifferInTheseSamples => {
                "these samples differ, what other seeds give is not known"
            }
            Self::NotKnownToDiffer => "not known to differ",
            Self::NotKnown => "significance not known: no half-width of a cause that both know",
            Self::NotTrusted => "no result to rest on: a run is not trustworthy",
            Self::NotDetermined => "not determined",
        }
    }
}

/// Difference of a result of a run, less that of a base.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Value of the run less that of the base.
    pub value: f64,
    /// Half-width of the causes that both have: the root of the sum of the squares; `None` where
    /// they share none.
    pub half_width: Option<f64>,
    /// These causes.
    pub causes: Vec<String>,
    /// Causes of which only one of the two has a half-width, which is not counted.
    pub left_out: Vec<String>,
    /// Significance.
    pub significance: Significance,
}

impl Difference {
    /// Returns the difference of a run and a base, whose errors are independent.
    pub fn new(run: &Compared, base: &Compared) -> Self {
        let value = run.value - base.value;
        let causes = run.causes(base, true);
        let squares = causes.iter().map(|of| {
            let both = [run, base].map(|one| one.by(of).unwrap_or(0.0));
            both[0].hypot(both[1]).powi(2)
        });
        let half_width = squares.reduce(|a, b| a + b).map(f64::sqrt);
        let significance = match half_width {
            _ if value == 0.0 => Significance::Equal,
            _ if !(run.trusted && base.trusted) => Significance::NotTrusted,
            _ if !(run.determined && base.determined) => Significance::NotDetermined,
            None => Significance::NotKnown,
            Some(half) if value.abs() <= half => Significance::NotKnownToDiffer,
            Some(_) if run.random || base.random => Significance::DifferInTheseSamples,
            Some(_) => Significance::Differ,
        };
        let left_out = [run.causes(base, false), base.causes(run, false)].concat();
        Self {
            value,
            half_width,
            causes,
            left_out,
            significance,
        }
    }

    /// Returns the difference with its half-width in a unit, what that is over, and its
    /// significance. A difference of a result that is not determined is not shown as a number.
    pub fn text(&self, unit: &str) -> String {
        let words = self.significance.words();
        let number = match (self.significance, self.half_width) {
            (Significance::Equal | Significance::NotDetermined, _) => return words.to_owned(),
            (_, Some(half)) => {
                let causes = self.causes.join(", ");
                format!("{} ({causes})", with_half_width(self.value, half, unit))
            }
            (_, None) => quantity(self.value, unit),
        };
        let left_out = match self.left_out.as_slice() {
            [] => String::new(),
            causes => format!("; {} known of one run only, not counted", causes.join(", ")),
        };
        format!("{number}: {words}{left_out}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, step: Option<f64>) -> Compared {
        let estimate = Estimate {
            value: Some(value),
            step,
            ..Estimate::default()
        };
        Compared::new(value, Some(&estimate))
    }

    #[test]
    fn a_difference_is_a_fact_beyond_the_half_widths_of_both() {
        let base = of(0.40, Some(0.03));
        for (value, half, significance, text) in [
            (
                0.46,
                Some(0.04),
                Significance::Differ,
                "0.06000 +- 0.050 (step): they differ",
            ),
            (
                0.44,
                Some(0.04),
                Significance::NotKnownToDiffer,
                "0.04000 +- 0.050 (step): not known to differ",
            ),
            (0.40, Some(0.04), Significance::Equal, "equal"),
            (
                0.46,
                None,
                Significance::NotKnown,
                "0.06000: significance not known: no half-width of a cause that both know; step known of one run only, not counted",
            ),
            // More than a quarter of the value.
            (
                0.46,
                Some(0.2),
                Significance::NotDetermined,
                "not determined",
            ),
        ] {
            let difference = Difference::new(&of(value, half), &base);
            assert_eq!(difference.significance, significance, "{value} {half:?}");
            assert_eq!(difference.text("1"), text);
        }
        let none = Difference::new(&Compared::new(0.5, None), &base);
        assert_eq!(none.significance, Significance::NotKnown);
        let run = of(0.46, Some(0.04));
        for (run, significance) in [
            (
                Compared {
                    random: true,
                    ..run.clone()
                },
                Significance::DifferInTheseSamples,
            ),
            (
                Compared {
                    trusted: false,
                    ..run
                },
                Significance::NotTrusted,
            ),
        ] {
            let difference = Difference::new(&run, &base);
            assert_eq!(difference.significance, significance);
        }
    }

    #[test]
    fn half_widths_of_different_causes_are_not_combined() {
        let with = |value, scope: &str, step| {
            let estimate = Estimate {
                value: Some(value),
                scatter: Some(0.003),
                scope: Some(scope.to_owned()),
                step,
                coupling: step,
                ..Estimate::default()
            };
            Compared::new(value, Some(&estimate))
        };
        let base = with(0.40, "within this sample (3 cycles)", Some(0.02));
        let text = |run: &Compared| Difference::new(run, &base).text("1");
        // The number of cycles is another, what the scatter is over is the same.
        assert_eq!(
            text(&with(0.46, "within this sample (25 cycles)", None)),
            "0.06000 +- 0.0042 (within this sample): they differ; step known of one run only, not counted"
        );
        assert_eq!(
            text(&with(0.46, "over 8 seeds", None)),
            "0.06000: significance not known: no half-width of a cause that both know; over 8 seeds, step, within this sample \
             known of one run only, not counted"
        );
    }
}
