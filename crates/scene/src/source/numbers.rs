//! Number types that validate their range while they are deserialized.
//!
//! RON reads `NaN`, `inf` and `1e400` (as infinity) as valid floats; these types reject them during
//! parsing, so that the error has a line and column.

use serde::{Deserialize, Serialize};

/// Reason for rejecting a number; continues a sentence that begins with the field's name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NumberError {
    /// The value is not a number.
    #[error("is not a number (NaN)")]
    NotANumber,
    /// The value is infinite, or was too large for a double.
    #[error("must be finite, got {0:?}")]
    Infinite(f64),
    /// The value violates the rule given first.
    #[error("must be {0}, got {1:?}")]
    Outside(&'static str, f64),
}

fn finite(value: f64) -> Result<f64, NumberError> {
    if value.is_nan() {
        Err(NumberError::NotANumber)
    } else if value.is_infinite() {
        Err(NumberError::Infinite(value))
    } else {
        // Turns -0.0 into 0.0: a negative zero is never intended.
        Ok(value + 0.0)
    }
}

macro_rules! number {
    ($(#[$doc:meta])* $name:ident, $rule:expr, $holds:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
        #[serde(try_from = "f64", into = "f64")]
        pub struct $name(f64);

        impl $name {
            /// Validates `value` and wraps it.
            pub fn new(value: f64) -> Result<Self, NumberError> {
                let value = finite(value)?;
                let holds: fn(f64) -> bool = $holds;
                if holds(value) {
                    Ok(Self(value))
                } else {
                    Err(NumberError::Outside($rule, value))
                }
            }

            /// The value.
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = NumberError;

            fn try_from(value: f64) -> Result<Self, NumberError> {
                Self::new(value)
            }
        }

        impl From<$name> for f64 {
            fn from(number: $name) -> f64 {
                number.0
            }
        }

        impl std::ops::Deref for $name {
            type Target = f64;

            fn deref(&self) -> &f64 {
                &self.0
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

number!(
    /// Any number except NaN and the infinities.
    Finite, "finite", |_| true
);
number!(
    /// A finite number above zero.
    Positive, "positive", |value| value > 0.0
);
number!(
    /// A finite number, zero or above.
    NonNegative, "zero or positive", |value| value >= 0.0
);
number!(
    /// A number from 0 to 1, both included.
    Fraction, "between 0 and 1", |value| (0.0..=1.0).contains(&value)
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_name_the_rule_and_the_value() {
        let message = |error: Option<NumberError>| error.map(|e| e.to_string()).unwrap_or_default();
        assert_eq!(
            message(Positive::new(-1e-6).err()),
            "must be positive, got -1e-6"
        );
        assert_eq!(
            message(Positive::new(0.0).err()),
            "must be positive, got 0.0"
        );
        assert_eq!(
            message(Finite::new(f64::NAN).err()),
            "is not a number (NaN)"
        );
        assert_eq!(
            message(Fraction::new(f64::INFINITY).err()),
            "must be finite, got inf"
        );
        assert_eq!(
            message(Fraction::new(1.5).err()),
            "must be between 0 and 1, got 1.5"
        );
        assert_eq!(
            message(NonNegative::new(-2.0).err()),
            "must be zero or positive, got -2.0"
        );
    }

    #[test]
    fn negative_zero_is_zero() {
        let zero = NonNegative::new(-0.0).unwrap();
        assert!(zero.get().is_sign_positive());
        assert!(Positive::new(-0.0).is_err());
        assert_eq!(*Fraction::new(1.0).unwrap(), 1.0);
        assert_eq!(f64::from(Finite::new(-3.0).unwrap()), -3.0);
    }
}
