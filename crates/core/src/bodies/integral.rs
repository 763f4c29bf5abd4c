//! Changes, integrals and means of functions of time over intervals, in closed form.

use super::table::{TimePoints, inside, integral, rounding, slope, slope_after, value};
use super::time_function::TimeFunction;
use std::f64::consts::TAU;

impl TimeFunction {
    /// Returns f(to) - f(from).
    pub fn change(&self, from: f64, to: f64) -> f64 {
        match self {
            // Subtracting values with the mean included would lose digits.
            Self::Sine { amplitude, .. } => {
                amplitude * (self.angle(to).sin() - self.angle(from).sin())
            }
            other => other.value(to) - other.value(from),
        }
    }

    /// Integrates f from one time to a later one.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Constant(x) => x * (to - from),
            Self::Sine { start, .. } => {
                let begun = start.clamp(from, to);
                let still = begun - from;
                let part = if still > 0.0 {
                    self.value(from) * still
                } else {
                    0.0
                };
                part + self.mean_of_sine(begun, to - begun) * (to - begun)
            }
            pieces => pieces.with_points(|p| integral(p, from, to)),
        }
    }

    /// Returns the mean of f over [t, t + h].
    pub fn mean(&self, t: f64, h: f64) -> f64 {
        match self {
            Self::Constant(x) => *x,
            Self::Sine { start, .. } if t + h <= *start => self.value(t),
            Self::Sine { .. } if self.corner(t, h).is_none() => self.mean_of_sine(t, h),
            Self::Sine { .. } => self.integral(t, t + h) / h,
            pieces => pieces.with_points(|p| {
                if inside(p, t, h).is_empty() {
                    value(p, t + 0.5 * h)
                } else {
                    integral(p, t, t + h) / h
                }
            }),
        }
    }

    /// Returns (f(t + h) - f(t))/h, without the cancellation error of the difference of two large
    /// values.
    pub fn mean_rate(&self, t: f64, h: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Sine { start, .. } => {
                let part = self.corner(t, h).map_or(h, |corner| t + h - corner);
                if t + h <= *start + rounding(t + h) {
                    return 0.0;
                }
                self.rise_of_sine(t + h - part, part) / h
            }
            pieces => pieces.with_points(|p| {
                let corners = inside(p, t, h);
                let (Some(first), Some(last)) = (corners.first(), corners.last()) else {
                    return slope(p, t + 0.5 * h);
                };
                let before = slope(p, first.0) * (first.0 - t);
                let after = slope_after(p, last.0) * (t + h - last.0);
                (before + (last.1 - first.1) + after) / h
            }),
        }
    }

    /// Returns the derivative at a time from the right; times that differ by rounding count as
    /// equal.
    pub fn rate_after(&self, t: f64) -> f64 {
        self.rate_beside(t, t + rounding(t), false)
    }

    /// Returns the derivative at a time from the left; times that differ by rounding count as
    /// equal.
    pub fn rate_before(&self, t: f64) -> f64 {
        self.rate_beside(t, t - rounding(t), true)
    }

    /// Returns the derivative at a time from the left or from the right. `beside` is the time
    /// shifted to that side by rounding.
    fn rate_beside(&self, t: f64, beside: f64, from_left: bool) -> f64 {
        match self {
            Self::Sine { start, .. } if beside < *start || (from_left && beside == *start) => 0.0,
            Self::Sine { .. } => self.slope_of_sine(t),
            pieces if from_left => pieces.with_points(|p| slope(p, beside)),
            pieces => pieces.with_points(|p| slope_after(p, beside)),
        }
    }

    /// Returns the smallest and largest derivative next to the kinks within (t, t + h); `None`
    /// without kinks.
    pub fn rates_at_corners(&self, t: f64, h: f64) -> Option<(f64, f64)> {
        match self {
            Self::Constant(_) => None,
            Self::Sine { .. } => {
                let rate = self.rate_after(self.corner(t, h)?);
                Some((rate.min(0.0), rate.max(0.0)))
            }
            pieces => pieces.with_points(|p| {
                let corners = inside(p, t, h);
                let rates = corners
                    .iter()
                    .flat_map(|c| [slope(p, c.0), slope_after(p, c.0)]);
                bounds(rates)
            }),
        }
    }

    /// Returns the smallest and largest value at the kinks within (t, t + h); `None` without kinks.
    pub fn values_at_corners(&self, t: f64, h: f64) -> Option<(f64, f64)> {
        match self {
            Self::Constant(_) => None,
            Self::Sine { .. } => {
                let value = self.value(self.corner(t, h)?);
                Some((value, value))
            }
            pieces => pieces.with_points(|p| bounds(inside(p, t, h).iter().map(|corner| corner.1))),
        }
    }

    /// Returns the last point of a table in (from, to]: the part before it need not be integrated
    /// again.
    pub fn last_point(&self, from: f64, to: f64) -> Option<f64> {
        let Self::Table(points) = self else {
            return None;
        };
        let last = points.partition_point(|p| p.0 <= to).checked_sub(1)?;
        (points[last].0 > from).then_some(points[last].0)
    }

    /// Returns the start of a sine, if it is within (t, t + h).
    fn corner(&self, t: f64, h: f64) -> Option<f64> {
        let Self::Sine { start, .. } = self else {
            return None;
        };
        let eps = rounding(t + h);
        (t + eps < *start && *start < t + h - eps).then_some(*start)
    }

    /// Returns amplitude, angular frequency (rad/s) and mean value of a sine.
    fn sine(&self) -> Option<[f64; 3]> {
        match self {
            Self::Sine {
                amplitude,
                frequency,
                offset,
                ..
            } => Some([*amplitude, TAU * frequency, *offset]),
            _ => None,
        }
    }

    /// Returns the angle of a sine (rad).
    pub(super) fn angle(&self, t: f64) -> f64 {
        match (self, self.sine()) {
            (Self::Sine { phase, start, .. }, Some([_, omega, _])) => {
                omega * (t - start).max(0.0) + phase
            }
            _ => 0.0,
        }
    }

    /// Returns the derivative of a sine after its start.
    pub(super) fn slope_of_sine(&self, t: f64) -> f64 {
        self.sine().map_or(0.0, |[amplitude, omega, _]| {
            omega * amplitude * self.angle(t).cos()
        })
    }

    /// Returns the mean of a sine over [t, t + h].
    fn mean_of_sine(&self, t: f64, h: f64) -> f64 {
        let Some([amplitude, omega, offset]) = self.sine() else {
            return self.value(t);
        };
        let half = 0.5 * omega * h;
        let share = if half == 0.0 { 1.0 } else { half.sin() / half };
        offset + amplitude * self.angle(t + 0.5 * h).sin() * share
    }

    /// Returns the increase of a sine over [t, t + h].
    fn rise_of_sine(&self, t: f64, h: f64) -> f64 {
        self.sine().map_or(0.0, |[amplitude, omega, _]| {
            2.0 * amplitude * self.angle(t + 0.5 * h).cos() * (0.5 * omega * h).sin()
        })
    }

    /// Calls `f` with the points between which the function is linear: those of a ramp or a table.
    pub(super) fn with_points<T>(&self, f: impl FnOnce(&TimePoints) -> T) -> T {
        match self {
            Self::Ramp {
                from,
                to,
                start,
                end,
            } => f(&[(*start, *from), (*end, *to)]),
            Self::Table(points) => f(points),
            other => f(&[(0.0, other.value(0.0))]),
        }
    }
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |all, x| {
        let (low, high) = all.unwrap_or((x, x));
        Some((low.min(x), high.max(x)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn functions() -> Vec<TimeFunction> {
        let sine = |start| TimeFunction::Sine {
            amplitude: 2.0,
            frequency: 0.3,
            phase: 0.2,
            offset: 1.0,
            start,
        };
        vec![
            TimeFunction::Constant(3.0),
            TimeFunction::Ramp {
                from: 1.0,
                to: 3.0,
                start: 0.5,
                end: 1.5,
            },
            sine(0.1),
            sine(1.23),
            TimeFunction::Table(vec![(0.0, 0.5), (0.7, 2.0), (0.7001, 3.0), (1.4, -1.0)]),
        ]
    }

    /// Simpson's rule between the kinks of the functions.
    fn simpson(f: &dyn Fn(f64) -> f64, from: f64, to: f64) -> f64 {
        let corners = [from, 0.1, 0.5, 0.7, 0.7001, 1.23, 1.4, 1.5, to];
        let corners: Vec<f64> = corners
            .into_iter()
            .filter(|c| (from..=to).contains(c))
            .collect();
        let part = |a: f64, b: f64| {
            let n = 400;
            let d = (b - a) / f64::from(n);
            let at = |k: i32| a + f64::from(k) * d;
            (0..n)
                .map(|k| d / 6.0 * (f(at(k)) + 4.0 * f(at(k) + 0.5 * d) + f(at(k + 1))))
                .sum::<f64>()
        };
        corners.windows(2).map(|w| part(w[0], w[1])).sum()
    }

    #[test]
    fn integrals_and_means_are_those_of_a_quadrature() {
        for f in functions() {
            for (from, to) in [(0.0, 0.2), (0.0, 2.0), (0.6, 0.9), (0.7, 1.4), (1.0, 3.0)] {
                let expected = simpson(&|t| f.value(t), from, to);
                assert!((f.integral(from, to) - expected).abs() < 1e-10, "{f:?}");
                let mean = f.mean(from, to - from) * (to - from);
                assert!((mean - expected).abs() < 1e-10, "{f:?}");
                let change = f.value(to) - f.value(from);
                assert!((f.change(from, to) - change).abs() < 1e-14, "{f:?}");
                let rise = f.mean_rate(from, to - from) * (to - from);
                assert!((rise - change).abs() < 1e-13, "{f:?} {rise} {change}");
            }
        }
    }

    #[test]
    fn corners_have_two_derivatives() {
        let f = TimeFunction::Table(vec![(0.0, 0.0), (0.3, 3.0), (0.5, 1.0)]);
        // The time 0.3 as summed in a run, and a time slightly below 0.3.
        for t in [0.1 + 0.1 + 0.1, 0.3 - 5e-17] {
            assert!((f.rate_before(t) - 10.0).abs() < 1e-13);
            assert!((f.rate_after(t) + 10.0).abs() < 1e-13);
        }
        assert_eq!(f.rates_at_corners(0.1, 0.2), None);
        let (low, high) = f.rates_at_corners(0.1, 0.3).unwrap_or_default();
        assert!((low + 10.0).abs() < 1e-13 && (high - 10.0).abs() < 1e-13);
        let sine = &functions()[2];
        assert_eq!(sine.rate_before(0.1), 0.0);
        assert!(sine.rate_after(0.1) > 1.0);
    }

    /// A ramp is constant outside and linear between its ends; this holds at both ends, also at
    /// time zero, which is exact.
    #[test]
    fn a_function_is_at_rest_before_its_start_and_after_its_end() {
        for start in [-1.0, 0.0, 0.3] {
            let end = start + 0.5;
            let ramp = TimeFunction::Ramp {
                from: 1.0,
                to: 3.0,
                start,
                end,
            };
            let table = TimeFunction::Table(vec![(start, 1.0), (end, 3.0)]);
            for f in [ramp, table] {
                assert_eq!(f.rate_before(start), 0.0, "{f:?}");
                assert!((f.rate_after(start) - 4.0).abs() < 1e-13, "{f:?}");
                assert!((f.rate_before(end) - 4.0).abs() < 1e-13, "{f:?}");
                assert_eq!(f.rate_after(end), 0.0, "{f:?}");
            }
            let sine = TimeFunction::Sine {
                amplitude: 2.0,
                frequency: 1.0 / TAU,
                phase: 0.0,
                offset: 0.0,
                start,
            };
            assert_eq!(sine.rate_before(start), 0.0);
            assert_eq!(sine.rate_after(start), 2.0);
        }
    }
}
