//! Means over seeds with Student confidence intervals.
//!
//! The mean m of n independent normal values with the standard deviation s has the interval m +- t
//! s / sqrt(n), where t is the quantile of Student's distribution with n - 1 degrees of freedom
//! (Student, Biometrika 6 (1908) 1).

use crate::statistics::distribution::student_quantile;
use serde::Serialize;

/// Confidence level of the intervals, for independent normal values.
pub const CONFIDENCE: f64 = 0.95;

/// An interval that holds the true value with a stated confidence; infinite ends where nothing
/// bounds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Returns the interval from `centre - half_width` to `centre + half_width`.
    pub fn around(centre: f64, half_width: f64) -> Self {
        Self {
            low: centre - half_width,
            high: centre + half_width,
        }
    }

    /// Whether the value lies within, ends included.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// The mean of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// Number of values.
    pub count: usize,
    /// Mean of the values.
    pub mean: f64,
    /// Standard deviation; `None` for a single value.
    pub scatter: Option<f64>,
    /// Half-width of the interval of the mean; `None` for a single value of a random quantity.
    pub half_width: Option<f64>,
}

impl Mean {
    /// Returns the mean of values that vary randomly from seed to seed; `None` for no values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let count = values.len();
        let n = count as f64;
        if count == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n;
        let scatter = (count > 1).then(|| {
            let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
            (squares / (n - 1.0)).sqrt()
        });
        let half_width = scatter.and_then(|s| Some(quantile(count)? * s / n.sqrt()));
        Some(Self {
            count,
            mean,
            scatter,
            half_width,
        })
    }

    /// The value of a deterministic quantity.
    pub fn certain(value: f64) -> Self {
        Self {
            count: 1,
            mean: value,
            scatter: None,
            half_width: Some(0.0),
        }
    }

    /// Returns the largest magnitude within the interval; infinite if the interval is unknown.
    pub fn at_most(&self) -> f64 {
        self.mean.abs() + self.half_width.unwrap_or(f64::INFINITY)
    }

    /// Whether zero lies within the interval.
    pub fn may_be_zero(&self) -> bool {
        self.half_width.is_none_or(|h| self.mean.abs() <= h)
    }

    /// Returns mean, scatter and half-width in other units, multiplied by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        let size = factor.abs();
        Self {
            mean: self.mean * factor,
            scatter: self.scatter.map(|s| s * size),
            half_width: self.half_width.map(|h| h * size),
            ..self
        }
    }
}

/// Returns Student's t for the mean of `count` values, two-sided at [`CONFIDENCE`]; `None` below
/// two.
pub fn quantile(count: usize) -> Option<f64> {
    student_quantile(0.5 + 0.5 * CONFIDENCE, count.checked_sub(1)? as f64)
}

/// Returns the number of seeds that would reduce the half-width below `wanted`, estimated from the
/// scatter so far: the smallest n with t(n) s / sqrt(n) <= wanted.
pub fn seeds_for(scatter: f64, wanted: f64) -> Option<usize> {
    let enough = |n: usize| quantile(n).is_some_and(|t| t * scatter / (n as f64).sqrt() <= wanted);
    if wanted.is_nan() || wanted <= 0.0 {
        return None;
    }
    (2..200)
        .chain((200..100_000).step_by(100))
        .find(|n| enough(*n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::normal;
    use rand::SeedableRng;

    /// The interval contains the true mean in 95 of 100 trials: over 20,000 trials the fraction has
    /// a standard error of 0.15 %.
    #[test]
    fn intervals_hold_the_true_mean_as_often_as_they_say() {
        for count in [2, 3, 8] {
            let mut rng = rand_pcg::Pcg64::seed_from_u64(count as u64);
            let trials = 20_000;
            let held = (0..trials)
                .filter(|_| {
                    let values: Vec<f64> =
                        (0..count).map(|_| 3.0 + 0.4 * normal(&mut rng)).collect();
                    let mean = Mean::of(&values).unwrap();
                    (mean.mean - 3.0).abs() <= mean.half_width.unwrap()
                })
                .count();
            let share = held as f64 / f64::from(trials);
            assert!((share - CONFIDENCE).abs() < 0.006, "{count}: {share}");
        }
    }

    /// Student's t at 95 % is 12.706 for one degree of freedom, 4.303 for two (common tables).
    #[test]
    fn follows_students_table() {
        assert!((quantile(2).unwrap() - 12.706).abs() < 1e-3);
        assert!((quantile(3).unwrap() - 4.303).abs() < 1e-3);
        assert_eq!(quantile(1), None);
        let mean = Mean::of(&[1.0, 2.0, 3.0]).unwrap();
        assert!((mean.half_width.unwrap() - 4.303 / 3f64.sqrt()).abs() < 1e-3);
        assert!(!mean.may_be_zero() || mean.half_width.unwrap() >= 2.0);
    }

    #[test]
    fn one_value_says_nothing_of_chance() {
        let one = Mean::of(&[0.2]).unwrap();
        assert!(one.half_width.is_none() && one.may_be_zero());
        assert_eq!(one.at_most(), f64::INFINITY);
        assert_eq!(Mean::certain(0.2).at_most(), 0.2);
        assert!(!Mean::certain(0.2).may_be_zero());
        assert!(Mean::of(&[]).is_none());
    }

    #[test]
    fn more_seeds_where_the_scatter_is_large() {
        // 1.96 s / sqrt(n) <= w for many: n near (1.96 * 10)^2 = 384
        let many = seeds_for(1.0, 0.1).unwrap();
        assert!((380..=500).contains(&many), "{many}");
        assert_eq!(seeds_for(0.01, 1.0), Some(2));
        assert_eq!(seeds_for(1.0, 0.0), None);
    }
}
