//! Relative change of a result between two series of stretches, with its confidence interval.
//!
//! The change is that of the ratio of the sums over all stretches, which is steadier than the mean
//! of their ratios: a stretch in which little happens has little weight. Its interval is from the
//! jackknife over the stretches (B. Efron and C. Stein, The jackknife estimate of variance, Annals
//! of Statistics 9, 1981).

use crate::quantity::unit::ONE;
use fretwork_math::statistics::interval;
use serde::{Deserialize, Serialize};

/// Smallest number of stretches for an interval.
pub const FEWEST: usize = 3;

/// Numerator and denominator of a result over one stretch: from the run, and from the finer
/// repetition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioPair {
    /// Values from the run.
    pub coarse: [f64; 2],
    /// Values from the repetition.
    pub fine: [f64; 2],
}

crate::described! {
    /// A relative change.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Change {
        /// Fine over coarse, less 1, extrapolated to the limit of fine settings.
        pub change: f64 => ONE,
        /// Half-width of its 95 % confidence interval; infinite where all of the result grew in one
        /// stretch (null in JSON).
        pub half_width: f64 => ONE,
    }
}

impl Change {
    /// Returns the change over all stretches times a factor of extrapolation; `None` for fewer than
    /// three stretches, or where the run gives no reference value.
    pub fn over(pairs: &[RatioPair], extrapolation: f64) -> Option<Self> {
        let n = pairs.len();
        if n < FEWEST {
            return None;
        }
        let change = ratio(pairs, None)?;
        let without: Option<Vec<f64>> = (0..n).map(|k| ratio(pairs, Some(k))).collect();
        let Some(without) = without else {
            return Some(Self {
                change: extrapolation * change,
                half_width: f64::INFINITY,
            });
        };
        let mean = without.iter().sum::<f64>() / n as f64;
        let square: f64 = without.iter().map(|x| (x - mean).powi(2)).sum();
        let t = interval::quantile(n)?;
        let error = ((n - 1) as f64 / n as f64 * square).sqrt();
        Some(Self {
            change: extrapolation * change,
            half_width: extrapolation * t * error,
        })
    }

    /// Returns the largest relative error of the result: the change, for which the run is not
    /// corrected, plus its uncertainty.
    pub fn bound(&self) -> f64 {
        self.change.abs() + self.half_width
    }
}

/// Returns the change of the ratio of the sums, without one of the stretches.
fn ratio(pairs: &[RatioPair], without: Option<usize>) -> Option<f64> {
    let all = || {
        let numbered = pairs.iter().enumerate();
        numbered
            .filter(move |(k, _)| Some(*k) != without)
            .map(|(_, p)| p)
    };
    let sum = |part: fn(&RatioPair) -> f64| all().map(part).sum::<f64>();
    let coarse = sum(|p| p.coarse[0]) / sum(|p| p.coarse[1]);
    let fine = sum(|p| p.fine[0]) / sum(|p| p.fine[1]);
    let change = fine / coarse - 1.0;
    change.is_finite().then_some(change)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(coarse: f64, fine: f64) -> RatioPair {
        RatioPair {
            coarse: [coarse, 1.0],
            fine: [fine, 1.0],
        }
    }

    #[test]
    fn the_same_change_everywhere_is_known_exactly() {
        let pairs = [1.0, 5.0, 0.2, 3.0].map(|x| pair(x, 1.03 * x));
        let change = Change::over(&pairs, 4.0 / 3.0).unwrap();
        assert!((change.change - 0.04).abs() < 1e-12, "{change:?}");
        assert!(change.half_width < 1e-12, "{change:?}");
    }

    /// For equal stretches the jackknife is Student's interval of the mean: changes of 0.01, 0.02,
    /// 0.03 have the mean 0.02, the standard deviation 0.01, and t(2, 0.975) = 4.302653.
    #[test]
    fn equal_stretches_give_the_interval_of_the_mean() {
        let pairs = [0.01, 0.02, 0.03].map(|x| pair(2.0, 2.0 * (1.0 + x)));
        let change = Change::over(&pairs, 1.0).unwrap();
        assert!((change.change - 0.02).abs() < 1e-12);
        let half = 4.302_653 * 0.01 / 3f64.sqrt();
        assert!((change.half_width / half - 1.0).abs() < 1e-6, "{change:?}");
        assert!((change.bound() - 0.02 - half).abs() < 1e-6);
    }

    #[test]
    fn nothing_is_said_of_too_few_or_of_nothing() {
        assert_eq!(Change::over(&[pair(1.0, 1.1); 2], 1.0), None);
        assert_eq!(Change::over(&[pair(0.0, 0.1); 4], 1.0), None);
        assert_eq!(Change::over(&[pair(0.0, 0.0); 4], 1.0), None);
        // All of the result is in one stretch.
        let mut pairs = [pair(0.0, 0.0); 4];
        pairs[2] = pair(1.0, 1.1);
        let change = Change::over(&pairs, 1.0).unwrap();
        assert!((change.change - 0.1).abs() < 1e-12 && change.half_width.is_infinite());
    }
}
