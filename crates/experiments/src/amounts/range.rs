//! Numbers with an interval: `0.4`, `0.40+-0.03`, `1e-4..1e-3`.

use fretwork_scene::quantity::quantity;
use serde::Serialize;

/// A number with the interval in which it lies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Lower end.
    pub low: f64,
    /// The number.
    pub value: f64,
    /// Upper end.
    pub high: f64,
}

impl Range {
    /// A number without an interval.
    pub fn certain(value: f64) -> Self {
        Self {
            low: value,
            value,
            high: value,
        }
    }

    /// Parses a pure number as written: `A`, `A+-B`, or `A..B`, whose value is the geometric mean.
    ///
    /// # Errors
    /// Returns a sentence, if it is not a positive range.
    pub fn parse(text: &str) -> Result<Self, String> {
        let pure = |part: &str| quantity(part, "").map_err(|e| e.message);
        let out = if let Some((low, high)) = text.split_once("..") {
            let (low, high) = (pure(low)?, pure(high)?);
            Self {
                low,
                value: (low * high).sqrt(),
                high,
            }
        } else if let Some((value, half)) = text.split_once("+-").or_else(|| text.split_once('±'))
        {
            let (value, half) = (pure(value)?, pure(half)?);
            Self {
                low: value - half,
                value,
                high: value + half,
            }
        } else {
            Self::certain(pure(text)?)
        };
        if !(out.low > 0.0 && out.low <= out.high && out.high.is_finite()) {
            return Err(format!(
                "`{text}` is no range of positive numbers; write 0.4, 0.40+-0.03 or 0.3..0.5"
            ));
        }
        Ok(out)
    }

    /// Returns whether the range has an interval.
    pub fn is_wide(&self) -> bool {
        self.low < self.high
    }

    /// Returns the range of a function that is monotonic in each of two ranges.
    pub fn of(a: &Self, b: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let ends = [
            f(a.low, b.low),
            f(a.low, b.high),
            f(a.high, b.low),
            f(a.high, b.high),
        ];
        Self {
            low: ends.into_iter().fold(f64::INFINITY, f64::min),
            value: f(a.value, b.value),
            high: ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The range of a monotone function.
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Self::of(self, self, |a, _| f(a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_as_one_writes_them() {
        let three = |text| Range::parse(text).map(|r| [r.low, r.value, r.high]);
        assert_eq!(three("0.4"), Ok([0.4; 3]));
        assert_eq!(three("0.5 +- 0.25"), Ok([0.25, 0.5, 0.75]));
        assert_eq!(three("1..4"), Ok([1.0, 2.0, 4.0]));
        for text in ["", "x", "0", "-0.1", "0.1+-0.2", "2..1", "1 m"] {
            assert!(Range::parse(text).is_err(), "{text}");
        }
        let falling = Range::parse("1..4").unwrap().map(|x| 1.0 / x);
        assert_eq!([falling.low, falling.value, falling.high], [0.25, 0.5, 1.0]);
    }
}
