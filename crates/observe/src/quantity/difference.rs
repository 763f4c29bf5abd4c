//! Difference of a result between two runs, and what their half-widths say of it.

use super::{Estimate, quantity, with_half_width};

/// A result of a run, to be compared with that of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Value to which the half-width refers.
    pub value: f64,
    /// Half-width of all causes together; `None` where it was not estimated.
    pub half_width: Option<f64>,
    /// Whether the result is determined, see [`super::DETERMINED`].
    pub determined: bool,
}

impl Compared {
    /// Returns a value with its estimate, if there is one.
    pub fn new(value: f64, estimate: Option<&Estimate>) -> Self {
        let mean = estimate.and_then(|e| e.value).unwrap_or(value);
        let determined = estimate.and_then(Estimate::is_determined) != Some(false);
        Self {
            value: mean,
            half_width: estimate.and_then(Estimate::half_width),
            determined,
        }
    }
}

/// Significance of a difference, from the half-widths of 95 % intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Significance {
    /// The values are equal to the last digit.
    Equal,
    /// The difference is larger than its half-width.
    Differ,
    /// The difference is within its half-width.
    NotKnownToDiffer,
    /// A half-width of one of the two was not estimated.
    NotKnown,
    /// One of the two is not determined.
    NotDetermined,
}

impl Significance {
    /// Words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Differ => "they differ",
            Self::NotKnownToDiffer => "not known to differ",
            Self::NotKnown => "significance not known: no half-width",
            Self::NotDetermined => "not determined",
        }
    }
}

/// Difference of a result of a run, less that of a base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Value of the run less that of the base.
    pub value: f64,
    /// Half-width: the root of the sum of the squares of both; `None` where one is not known.
    pub half_width: Option<f64>,
    /// Significance.
    pub significance: Significance,
}

impl Difference {
    /// Returns the difference of a run and a base, whose errors are independent.
    pub fn new(run: &Compared, base: &Compared) -> Self {
        let value = run.value - base.value;
        let both = run.half_width.zip(base.half_width);
        let half_width = both.map(|(a, b)| a.hypot(b));
        let significance = match half_width {
            _ if value == 0.0 => Significance::Equal,
            _ if !(run.determined && base.determined) => Significance::NotDetermined,
            None => Significance::NotKnown,
            Some(half) if value.abs() > half => Significance::Differ,
            Some(_) => Significance::NotKnownToDiffer,
        };
        Self {
            value,
            half_width,
            significance,
        }
    }

    /// Returns the difference with its half-width in a unit, and its significance. A difference of
    /// a result that is not determined is not shown as a number.
    pub fn text(&self, unit: &str) -> String {
        let words = self.significance.words();
        match (self.significance, self.half_width) {
            (Significance::Equal | Significance::NotDetermined, _) => words.to_owned(),
            (_, Some(half)) => format!("{}: {words}", with_half_width(self.value, half, unit)),
            (_, None) => format!("{}: {words}", quantity(self.value, unit)),
        }
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
                "0.06000 +- 0.050: they differ",
            ),
            (
                0.44,
                Some(0.04),
                Significance::NotKnownToDiffer,
                "0.04000 +- 0.050: not known to differ",
            ),
            (0.40, Some(0.04), Significance::Equal, "equal"),
            (
                0.46,
                None,
                Significance::NotKnown,
                "0.06000: significance not known: no half-width",
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
    }
}
