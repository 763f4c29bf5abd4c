//! Maps the unit interval to the values of a factor.

use super::DesignError;

/// Values of a factor, spread over the unit interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Equal steps change the value by equal differences.
    Linear {
        /// Value at 0.
        from: f64,
        /// Value at 1.
        to: f64,
    },
    /// Equal steps change the value by equal ratios; both ends are positive.
    Logarithmic {
        /// Value at 0.
        from: f64,
        /// Value at 1.
        to: f64,
    },
    /// Whole numbers, each with the same share of the interval, both ends included.
    Integer {
        /// Smallest value.
        from: i64,
        /// Largest value.
        to: i64,
    },
}

impl Scale {
    /// Whether the ends are finite and in order.
    ///
    /// # Errors
    ///
    /// Returns a sentence on the invalid end.
    pub fn check(&self) -> Result<(), DesignError> {
        let reason = match *self {
            Self::Linear { from, to } | Self::Logarithmic { from, to }
                if !(from.is_finite() && to.is_finite() && from < to) =>
            {
                format!("the range {from} to {to} must have finite ends, the smaller first")
            }
            Self::Logarithmic { from, to } if from <= 0.0 => {
                format!("the logarithmic range {from} to {to} must have positive ends")
            }
            Self::Integer { from, to } if from > to => {
                format!("the range {from} to {to} must have the smaller number first")
            }
            _ => return Ok(()),
        };
        Err(DesignError::Scale(reason))
    }

    /// The value at the place `unit` in [0, 1]; places outside have the value of the nearer end.
    pub fn at(&self, unit: f64) -> f64 {
        let unit = unit.clamp(0.0, 1.0);
        match *self {
            Self::Linear { from, to } => (from + unit * (to - from)).clamp(from, to),
            Self::Logarithmic { from, to } => {
                // Computing from the nearer end makes both ends exact.
                let span = libm::log(to / from);
                let value = if unit < 0.5 {
                    from * libm::exp(unit * span)
                } else {
                    to * libm::exp((unit - 1.0) * span)
                };
                value.clamp(from, to)
            }
            Self::Integer { from, to } => {
                let count = (to - from + 1) as f64;
                (from as f64 + (unit * count).floor()).min(to as f64)
            }
        }
    }

    /// Returns the position of a value, in [0, 1]; whole numbers are in the middle of their part.
    /// Values outside have the position of the nearer end.
    pub fn place(&self, value: f64) -> f64 {
        let place = match *self {
            Self::Linear { from, to } => (value - from) / (to - from),
            Self::Logarithmic { from, to } => {
                libm::log((value / from).max(f64::MIN_POSITIVE)) / libm::log(to / from)
            }
            Self::Integer { from, to } => {
                (value.round() - from as f64 + 0.5) / ((to - from + 1) as f64)
            }
        };
        place.clamp(0.0, 1.0)
    }

    /// Returns `count` values at equal steps, from one end to the other; a single value is the
    /// middle, whole numbers may be fewer.
    pub fn levels(&self, count: usize) -> Vec<f64> {
        let place = |i: usize| match count {
            1 => 0.5,
            _ => i as f64 / (count - 1) as f64,
        };
        let mut values: Vec<f64> = match *self {
            Self::Integer { from, to } => {
                let value = |i| (from as f64 + place(i) * (to - from) as f64).round();
                (0..count).map(value).collect()
            }
            _ => (0..count).map(|i| self.at(place(i))).collect(),
        };
        values.dedup();
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_middle_and_back() {
        let linear = Scale::Linear {
            from: -1.0,
            to: 3.0,
        };
        let logarithmic = Scale::Logarithmic {
            from: 1e-3,
            to: 1e3,
        };
        assert_eq!([0.0, 0.5, 1.0].map(|u| linear.at(u)), [-1.0, 1.0, 3.0]);
        assert_eq!(logarithmic.at(0.0), 1e-3);
        assert_eq!(logarithmic.at(1.0), 1e3);
        assert!((logarithmic.at(0.5) - 1.0).abs() < 1e-15);
        for scale in [linear, logarithmic] {
            for unit in [0.0, 0.1, 0.5, 0.99, 1.0] {
                assert!((scale.place(scale.at(unit)) - unit).abs() < 1e-15);
            }
            assert_eq!(scale.place(1e9), 1.0);
            assert_eq!(scale.place(-1e9), 0.0);
        }
    }

    #[test]
    fn whole_numbers_have_equal_shares() {
        let scale = Scale::Integer { from: -1, to: 2 };
        let values: Vec<f64> = (0..400).map(|i| scale.at(f64::from(i) / 400.0)).collect();
        for whole in -1..=2 {
            let count = values.iter().filter(|v| **v == f64::from(whole)).count();
            assert_eq!(count, 100);
            assert_eq!(scale.at(scale.place(f64::from(whole))), f64::from(whole));
        }
        assert_eq!(scale.at(1.0), 2.0);
        assert_eq!(scale.levels(4), [-1.0, 0.0, 1.0, 2.0]);
        assert_eq!(scale.levels(9), [-1.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn levels_have_equal_steps_of_the_scale() {
        let scale = Scale::Logarithmic {
            from: 1.0,
            to: 100.0,
        };
        let levels = scale.levels(3);
        assert!((levels[1] - 10.0).abs() < 1e-13);
        assert_eq!((levels[0], levels[2]), (1.0, 100.0));
        assert_eq!(Scale::Linear { from: 0.0, to: 1.0 }.levels(1), [0.5]);
    }

    #[test]
    fn errors_say_what_to_change() {
        let zero = Scale::Logarithmic { from: 0.0, to: 1.0 };
        let error = zero.check().unwrap_err().to_string();
        assert!(error.contains("positive"), "{error}");
        assert!(Scale::Linear { from: 1.0, to: 1.0 }.check().is_err());
        assert!(Scale::Integer { from: 3, to: 2 }.check().is_err());
        assert!(Scale::Integer { from: 2, to: 2 }.check().is_ok());
    }
}
