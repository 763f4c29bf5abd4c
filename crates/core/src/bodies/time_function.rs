//! Functions of time.

use super::table;
use serde::{Deserialize, Serialize};

/// A function of time (s). [`super::path`] describes the motion of an imposed degree of freedom
/// over a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum TimeFunction {
    /// A constant value.
    Constant(f64),
    /// Linear between two times, constant outside.
    Ramp {
        /// Value before `start`.
        from: f64,
        /// Value after `end`.
        to: f64,
        /// Start of the ramp (s).
        start: f64,
        /// End of the ramp (s).
        end: f64,
    },
    /// offset + amplitude sin(2 pi frequency (t - start) + phase) from `start` on; constant before,
    /// at the value for `start`.
    Sine {
        /// Amplitude.
        amplitude: f64,
        /// Frequency (Hz).
        frequency: f64,
        /// Phase (rad).
        #[serde(default)]
        phase: f64,
        /// Mean value.
        #[serde(default)]
        offset: f64,
        /// Start of the oscillation (s).
        #[serde(default)]
        start: f64,
    },
    /// Points (time, value), linear between them, constant outside; times must increase.
    Table(Vec<(f64, f64)>),
}

impl TimeFunction {
    /// Returns the value at a time.
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Self::Constant(x) => *x,
            Self::Ramp {
                from,
                to,
                start,
                end,
            } => from + (to - from) * ((t - start) / (end - start)).clamp(0.0, 1.0),
            Self::Sine {
                amplitude, offset, ..
            } => offset + amplitude * self.angle(t).sin(),
            Self::Table(points) => table::value(points, t),
        }
    }

    /// Returns the derivative at a time, from the left at a kink of a ramp or a table, from the
    /// right at the start of a sine.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Self::Sine { start, .. } if t < *start => 0.0,
            Self::Sine { .. } => self.slope_of_sine(t),
            pieces => pieces.with_points(|p| table::slope(p, t)),
        }
    }

    /// Returns the period of a sine (s).
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Sine { frequency, .. } if *frequency > 0.0 => Some(1.0 / frequency),
            _ => None,
        }
    }

    /// Returns the error in the numbers, if any.
    pub fn error(&self) -> Option<String> {
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let error = |is: bool, message: String| is.then_some(message);
        match self {
            Self::Constant(x) => {
                let message = format!("a constant must be finite, got {x}");
                error(!x.is_finite(), message)
            }
            Self::Ramp {
                from,
                to,
                start,
                end,
            } => {
                let numbers = "the numbers of a ramp must be finite".into();
                let order =
                    format!("a ramp must end after it starts, got start {start} and end {end}");
                error(!finite(&[*from, *to, *start, *end]), numbers)
                    .or_else(|| error(end <= start, order))
            }
            Self::Sine {
                amplitude,
                frequency,
                phase,
                offset,
                start,
            } => {
                let numbers = "the numbers of a sine must be finite".into();
                let sign = format!("a frequency must not be negative, got {frequency}");
                error(
                    !finite(&[*amplitude, *frequency, *phase, *offset, *start]),
                    numbers,
                )
                .or_else(|| error(*frequency < 0.0, sign))
            }
            Self::Table(points) => {
                let empty = "a table needs at least one (time, value)".into();
                let numbers = "the numbers of a table must be finite".into();
                let order =
                    "the times of a table must rise; for a jump give two times that are close";
                let falls = points.windows(2).any(|w| w[1].0 <= w[0].0);
                error(points.is_empty(), empty)
                    .or_else(|| error(!points.iter().all(|p| finite(&[p.0, p.1])), numbers))
                    .or_else(|| error(falls, order.into()))
            }
        }
    }

    /// Returns the same function with a delay of `by` seconds.
    pub fn delayed(&self, by: f64) -> Self {
        let mut later = self.clone();
        match &mut later {
            Self::Constant(_) => {}
            Self::Ramp { start, end, .. } => (*start, *end) = (*start + by, *end + by),
            Self::Sine { start, .. } => *start += by,
            Self::Table(points) => points.iter_mut().for_each(|p| p.0 += by),
        }
        later
    }
}

#[cfg(test)]
impl TimeFunction {
    /// Returns one function of each kind.
    pub(super) fn samples() -> [Self; 4] {
        let ramp = Self::Ramp {
            from: 1.0,
            to: 3.0,
            start: 0.5,
            end: 1.5,
        };
        let sine = Self::Sine {
            amplitude: 2.0,
            frequency: 0.3,
            phase: 0.2,
            offset: 1.0,
            start: 0.1,
        };
        let table = Self::Table(vec![(0.0, 0.0), (0.7, 2.0), (1.4, -1.0)]);
        [Self::Constant(2.0), ramp, sine, table]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn rates_are_the_derivatives() {
        for f in TimeFunction::samples() {
            for t in [0.6, 0.95, 1.2] {
                let e = 1e-6;
                let difference = (f.value(t + e) - f.value(t - e)) / (2.0 * e);
                assert!((difference - f.rate(t)).abs() < 1e-6, "{f:?} at {t}");
            }
            assert!(f.error().is_none());
        }
    }

    /// A ramp equals a table of two points, also at these points; at its start a sine has the slope
    /// after it.
    #[test]
    fn rates_at_kinks_are_those_of_the_documented_side() {
        let [_, ramp, ..] = TimeFunction::samples();
        let table = TimeFunction::Table(vec![(0.5, 1.0), (1.5, 3.0)]);
        for f in [ramp, table] {
            let rates = [0.4, 0.5, 0.6, 1.5, 1.6].map(|t| f.rate(t));
            assert_eq!(rates, [0.0, 0.0, 2.0, 2.0, 0.0], "{f:?}");
        }
        let sine = TimeFunction::Sine {
            amplitude: 2.0,
            frequency: 1.0 / TAU,
            phase: 0.0,
            offset: 1.0,
            start: 0.5,
        };
        assert_eq!([0.4, 0.5].map(|t| sine.rate(t)), [0.0, 2.0]);
        assert_eq!([0.4, 0.5].map(|t| sine.value(t)), [1.0, 1.0]);
    }

    #[test]
    fn invalid_functions_are_refused() {
        let no_length = TimeFunction::Ramp {
            from: 0.0,
            to: 1.0,
            start: 1.0,
            end: 1.0,
        };
        let two_values = TimeFunction::Table(vec![(0.0, 1.0), (0.0, 2.0)]);
        for f in [no_length, two_values, TimeFunction::Constant(f64::NAN)] {
            assert!(f.error().is_some(), "{f:?}");
        }
    }
}
