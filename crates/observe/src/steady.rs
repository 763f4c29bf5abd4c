//! Test whether a flow is steady, and the confidence interval of its mean.
//!
//! The cumulative quantity is divided into blocks of equal time. Their means give the flow with
//! Student's interval (batch means: A. M. Law, Simulation Modeling and Analysis, section 9.5.3); a
//! trend is tested with the Mann-Kendall test (M. G. Kendall, Rank Correlation Methods, 1975).

use super::quantity::unit::{MASS_FLOW, ONE, WORD};
use fretwork_math::statistics::interval;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// Number of blocks in a window.
pub const BLOCKS: usize = 10;

crate::described! {
    /// A mean flow over a window.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct MeanFlow {
        /// Mean rate, in units of the table per second.
        pub mean: f64 => MASS_FLOW,
        /// Half-width of its 95 % confidence interval.
        pub half_width: f64 => MASS_FLOW,
        /// Correlation of neighbouring blocks: if it is far above zero, the interval is too narrow.
        pub correlation: f64 => ONE,
        /// p-value of the trend test: probability of a trend at least this strong in a steady flow.
        pub trend_probability: f64 => ONE,
        /// Whether no trend was found: the probability is above 5 %.
        pub steady: bool => WORD,
    }
}

impl MeanFlow {
    /// Whether zero is within the interval.
    pub fn may_be_zero(&self) -> bool {
        self.mean.abs() <= self.half_width
    }
}

/// Returns the mean rate of a cumulative quantity after a time. `points` are (time, cumulative
/// value), with increasing times; `None` if a block has fewer than two points.
pub fn flow(points: &[(f64, f64)], start: f64, end: f64) -> Option<MeanFlow> {
    if start >= end || points.len() < 2 {
        return None;
    }
    let width = (end - start) / BLOCKS as f64;
    let block = |k: usize| start + k as f64 * width..start + (k + 1) as f64 * width;
    let few = |k: &usize| points.iter().filter(|p| block(*k).contains(&p.0)).count() < 2;
    if (0..BLOCKS).any(|k| few(&k)) {
        return None;
    }
    let edges: Option<Vec<f64>> = (0..=BLOCKS)
        .map(|k| at(points, start + k as f64 * width))
        .collect();
    let blocks: Vec<f64> = edges?.windows(2).map(|w| (w[1] - w[0]) / width).collect();
    summary(&blocks)
}

/// Returns the cumulative value at a time, interpolated linearly and constant just beyond the ends.
fn at(points: &[(f64, f64)], time: f64) -> Option<f64> {
    let k = points.partition_point(|p| p.0 < time);
    if k == 0 {
        return points.first().map(|p| p.1);
    }
    let Some((t1, x1)) = points.get(k) else {
        return points.last().map(|p| p.1);
    };
    let (t0, x0) = points[k - 1];
    Some(x0 + (x1 - x0) * (time - t0) / (t1 - t0))
}

/// Returns mean, interval and trend of block means; `None` for fewer than two.
pub(super) fn of_blocks(blocks: &[f64]) -> Option<MeanFlow> {
    if blocks.len() < 2 {
        None
    } else {
        summary(blocks)
    }
}

/// Returns mean, interval and trend of blocks.
fn summary(blocks: &[f64]) -> Option<MeanFlow> {
    let n = blocks.len();
    let count = n as f64;
    let mean = blocks.iter().sum::<f64>() / count;
    let deviations: Vec<f64> = blocks.iter().map(|b| b - mean).collect();
    let square: f64 = deviations.iter().map(|d| d * d).sum();
    let t = interval::quantile(n)?;
    let neighbours: f64 = deviations.windows(2).map(|w| w[0] * w[1]).sum();
    let trend = trend(blocks)?;
    Some(MeanFlow {
        mean,
        half_width: t * (square / (count - 1.0) / count).sqrt(),
        correlation: if square > 0.0 {
            neighbours / square
        } else {
            0.0
        },
        trend_probability: trend,
        steady: trend > 0.05,
    })
}

/// Returns the two-sided p-value of the Mann-Kendall trend test, with ties and the normal
/// approximation.
fn trend(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mut s = 0i64;
    for (k, a) in values.iter().enumerate() {
        for b in &values[k + 1..] {
            s += i64::from(b > a) - i64::from(b < a);
        }
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let ties = |t: f64| t * (t - 1.0) * (2.0 * t + 5.0);
    let equal: f64 = sorted
        .chunk_by(|a, b| a == b)
        .map(|g| ties(g.len() as f64))
        .sum();
    let variance = (ties(n) - equal) / 18.0;
    if variance <= 0.0 {
        return Some(1.0);
    }
    let z = ((s.abs() - 1).max(0) as f64) / variance.sqrt();
    Some(2.0 * (1.0 - Normal::standard().cdf(z)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_student_s() {
        // The mean is 5.5, the standard deviation 3.02765, t(9, 0.975) = 2.262157: half-width
        // 2.16585.
        let values: Vec<f64> = [3, 9, 1, 7, 10, 2, 6, 8, 5, 4].map(f64::from).to_vec();
        let flow = summary(&values).unwrap();
        assert!((flow.mean - 5.5).abs() < 1e-12);
        assert!((flow.half_width - 2.262_157 * 3.027_650_4 / 10f64.sqrt()).abs() < 1e-5);
        assert!(flow.steady);
    }

    #[test]
    fn a_rising_sequence_is_a_trend() {
        // S = 45, variance 10 9 25/18 = 125: z = 44/sqrt(125) = 3.9354, p = 8.3e-5.
        let values: Vec<f64> = (0..10).map(f64::from).collect();
        assert!((trend(&values).unwrap() / 8.3e-5 - 1.0).abs() < 0.01);
        assert_eq!(trend(&[2.0; 10]), Some(1.0));
        // For three values 1, 2, 3: S = 3, variance 3 2 11/18.
        let z = 2.0 / (66.0f64 / 18.0).sqrt();
        let p = 2.0 * (1.0 - Normal::standard().cdf(z));
        assert!((trend(&[1.0, 2.0, 3.0]).unwrap() - p).abs() < 1e-15);
    }

    #[test]
    fn a_constant_rate_is_found_whatever_the_samples() {
        let points: Vec<(f64, f64)> = (0..57)
            .map(|k| (0.1 * f64::from(k), 0.3 * f64::from(k)))
            .collect();
        let flow = flow(&points, 1.23, 5.6).unwrap();
        assert!((flow.mean - 3.0).abs() < 1e-12 && flow.half_width < 1e-12);
        assert!(super::flow(&points, 5.0, 5.0).is_none());
        assert!(super::flow(&points[..20], 1.23, 5.6).is_none());
    }
}
