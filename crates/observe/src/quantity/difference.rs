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

    /// Returns the causes of which only another result has a half-width.
    fn lacks(&self, other: &Self) -> Vec<String> {
        let causes = other.half_widths.iter().map(|(of, _)| of);
        causes.filter(|of| self.by(of).is_none()).cloned().collect()
    }
}

/// Significance of a difference, from the half-widths of 95 % intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Significance {
    /// The values are equal but for rounding, see [`ROUNDING`].
    Equal,
    /// The difference is larger than its half-width.
    Differ,
    /// It is, but other seeds would give other samples, and what they scatter by is not in it.
    DifferInTheseSamples,
    /// The difference is within its half-width.
    NotKnownToDiffer,
    /// The difference is larger than its half-width, but what only one of the two knows may be as
    /// large in the other, see [`UNKNOWN`].
    UnknownMatters,
    /// One of the two has no half-width.
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
            Self::UnknownMatters => "not known to differ, for what is not known of one run",
            Self::NotKnown => "significance not known: no half-width of one run",
            Self::NotTrusted => "no result to rest on: a run is not trustworthy",
            Self::NotDetermined => "not determined",
        }
    }
}

/// A half-width that one run does not know does not matter where the difference exceeds its
/// half-width even if the unknown one is this number of times that of the other run.
pub const UNKNOWN: f64 = 3.0;

/// Difference of two values, relative to the larger, that the rounding of sums over steps and
/// contacts leaves: another number of threads or another order of bodies gives other last digits.
pub const ROUNDING: f64 = 1e-10;

/// Difference of a result of a run, less that of a base.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Value of the run less that of the base.
    pub value: f64,
    /// Half-width of the causes that at least one of the two has: the root of the sum of the
    /// squares; `None` where there are none.
    pub half_width: Option<f64>,
    /// These causes.
    pub causes: Vec<String>,
    /// Causes of which only the base has a half-width, and those of which only the run has one.
    pub unknown: [Vec<String>; 2],
    /// Significance.
    pub significance: Significance,
}

impl Difference {
    /// Returns the difference of a run and a base, whose errors are independent.
    pub fn new(run: &Compared, base: &Compared) -> Self {
        let value = run.value - base.value;
        let rounding = ROUNDING * run.value.abs().max(base.value.abs());
        let own = run.half_widths.iter().map(|(of, _)| of.clone());
        let causes: Vec<String> = own.chain(run.lacks(base)).collect();
        // A half-width that is not known is `unknown` times that of the other run.
        let half = |unknown: f64| {
            let squares = causes.iter().map(|of| {
                let (one, other) = (run.by(of), base.by(of));
                let known = one.or(other).unwrap_or(0.0);
                let both = [one, other].map(|half| half.unwrap_or(unknown * known));
                both[0].hypot(both[1]).powi(2)
            });
            squares.reduce(|a, b| a + b).map(f64::sqrt)
        };
        let half_width = half(0.0);
        let none = run.half_widths.is_empty() || base.half_widths.is_empty();
        let significance = match half_width {
            _ if value.abs() <= rounding => Significance::Equal,
            _ if !(run.trusted && base.trusted) => Significance::NotTrusted,
            _ if !(run.determined && base.determined) => Significance::NotDetermined,
            None => Significance::NotKnown,
            Some(half) if value.abs() <= half => Significance::NotKnownToDiffer,
            Some(_) if none => Significance::NotKnown,
            Some(_) if half(UNKNOWN).is_some_and(|half| value.abs() <= half) => {
                Significance::UnknownMatters
            }
            Some(_) if run.random || base.random => Significance::DifferInTheseSamples,
            Some(_) => Significance::Differ,
        };
        Self {
            value,
            half_width,
            causes,
            unknown: [run.lacks(base), base.lacks(run)],
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
        let of = ["this run", "the first run"].into_iter().zip(&self.unknown);
        let unknown = of.filter(|(_, causes)| !causes.is_empty());
        let unknown =
            unknown.map(|(of, causes)| format!("; of {of} not known: {}", causes.join(", ")));
        format!("{number}: {words}{}", unknown.collect::<String>())
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
            (0.40 + 3e-14, Some(0.04), Significance::Equal, "equal"),
            (
                0.40 + 3e-9,
                Some(0.04),
                Significance::NotKnownToDiffer,
                "3.000e-9 +- 0.050 (step): not known to differ",
            ),
            (
                0.46,
                None,
                Significance::NotKnown,
                "0.06000 +- 0.030 (step): significance not known: no half-width of one run; of this run not known: step",
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
    fn a_cause_that_one_run_knows_counts_and_the_unknown_of_the_other_may_matter() {
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
        // The number of cycles is another, what the scatter is over is the same. The half-width is
        // that of 0.003, 0.003 and 0.02; with a step of 0.06 of the run it is 0.0634.
        let cycles = "within this sample (25 cycles)";
        assert_eq!(
            text(&with(0.46, cycles, None)),
            "0.06000 +- 0.020 (within this sample, step): not known to differ, for what is not known of one run; of this run \
             not known: step"
        );
        assert_eq!(
            text(&with(0.47, cycles, None)),
            "0.07000 +- 0.020 (within this sample, step): they differ; of this run not known: step"
        );
        assert_eq!(
            text(&with(0.41, cycles, None)),
            "0.01000 +- 0.020 (within this sample, step): not known to differ; of this run not known: step"
        );
        assert_eq!(
            text(&with(0.45, "over 8 seeds", Some(0.03))),
            "0.05000 +- 0.036 (step, over 8 seeds, within this sample): they differ; of this run not known: within this \
             sample; of the first run not known: over 8 seeds"
        );
    }
}
