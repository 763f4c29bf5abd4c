//! Scatter of a quantity within one run: Student's 95 % confidence interval of its mean over the
//! later half of the cycles, or of a ratio of sums over blocks of equal time if there are no
//! cycles.
//!
//! Cycles are used as batches (A. M. Law, Simulation Modeling and Analysis, section 9.5.3). If they
//! show a trend by the Mann-Kendall test, the quantity is not steady and no interval is given.

use super::cycle::Cycle;
use super::steady::{self, MeanFlow};

/// Smallest number of cycles for an interval.
const FEWEST: usize = 3;
/// Range of values over their mean within which a trend does not matter: it is counted as error.
const NEGLIGIBLE: f64 = 1e-3;
/// Number of cycles from which their correlation is tested.
const CORRELATED: usize = 8;

/// A mean over cycles or blocks, with its interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// Mean, half-width of its interval, trend.
    pub flow: MeanFlow,
    /// Number of values.
    pub count: usize,
    /// Description of the values: `cycles 6 to 10`.
    pub over: String,
    /// What the values are: `cycles`.
    pub of: &'static str,
}

impl Scatter {
    fn new(values: &[f64], over: String, of: &'static str) -> Option<Self> {
        let finite = values.iter().all(|v| v.is_finite());
        let mut flow = steady::of_blocks(values).filter(|_| finite && values.len() >= FEWEST)?;
        // A trend of rounding errors, or far below what friction is known to, is none.
        let ends = values
            .iter()
            .fold([f64::MAX, f64::MIN], |[a, b], v| [a.min(*v), b.max(*v)]);
        let range = ends[1] - ends[0];
        if !flow.steady && range <= NEGLIGIBLE * flow.mean.abs() {
            flow.steady = true;
            flow.half_width = flow.half_width.max(range);
        }
        Some(Self {
            flow,
            count: values.len(),
            over,
            of,
        })
    }

    /// Returns the half-width of the interval; `None` if the values show a trend.
    pub fn half_width(&self) -> Option<f64> {
        self.flow.steady.then_some(self.flow.half_width)
    }

    /// Returns the scope of the interval: it says nothing of other samples.
    pub fn scope(&self) -> String {
        format!("within this sample ({} {})", self.count, self.of)
    }

    /// Describes the method of the interval, or the reason why there is none.
    pub fn method(&self) -> String {
        let n = self.count as f64;
        if !self.flow.steady {
            // Values below 0.01 would print as zeros.
            let p = match self.flow.trend_probability {
                p if p < 0.01 => "p < 0.01".to_owned(),
                p => format!("p = {p:.2}"),
            };
            return format!("none: {} still show a trend (Mann-Kendall, {p})", self.over);
        }
        let related = self.count >= CORRELATED && self.flow.correlation > 2.0 / n.sqrt();
        let related = if related {
            format!(
                "; neighbouring values have a correlation of {:.2}, so the interval is too narrow",
                self.flow.correlation
            )
        } else {
            String::new()
        };
        format!("95 %, Student, {}{related}", self.over)
    }
}

/// Returns the scatter of a value over the later half of the complete cycles, at least three;
/// `None` if there are fewer, or if one of them has no value.
pub fn over_cycles(cycles: &[Cycle], value: impl Fn(&Cycle) -> Option<f64>) -> Option<Scatter> {
    let complete: Vec<&Cycle> = cycles.iter().filter(|c| c.complete).collect();
    let count = complete.len().div_ceil(2).max(FEWEST).min(complete.len());
    let late = &complete[complete.len() - count..];
    let (first, last) = (late.first()?.cycle, late.last()?.cycle);
    let values: Option<Vec<f64>> = late.iter().map(|c| value(c)).collect();
    Scatter::new(&values?, format!("cycles {first} to {last}"), "cycles")
}

/// Returns the ratio of the sums over blocks of dividends and divisors, with its scatter; `None` if
/// a divisor is zero.
///
/// The interval is that of the mean of a + (x - a y)/Y, where a is the ratio of the sums and Y the
/// mean divisor: the ratio to first order in its deviations (A. M. Law, Simulation Modeling and
/// Analysis, section 9.5.3). The trend is that of these values.
pub fn over_blocks(blocks: &[(f64, f64)]) -> Option<Scatter> {
    let count = blocks.len() as f64;
    let positive = blocks.iter().all(|b| b.1 > 0.0);
    let (dividend, divisor) = blocks
        .iter()
        .fold((0.0, 0.0), |(x, y), b| (x + b.0, y + b.1));
    let ratio = dividend / divisor;
    let value = |b: &(f64, f64)| ratio + (b.0 - ratio * b.1) / (divisor / count);
    let values: Vec<f64> = blocks.iter().map(value).collect();
    let over = format!("{} blocks of equal time", blocks.len());
    let mut scatter = Scatter::new(&values, over, "blocks").filter(|_| positive)?;
    scatter.flow.mean = ratio;
    Some(scatter)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycles(values: &[f64]) -> Vec<Cycle> {
        let cycle = |(k, v): (usize, &f64)| Cycle {
            cycle: k as u32 + 1,
            complete: true,
            friction_coefficient: Some(*v),
            ..Cycle::default()
        };
        values.iter().enumerate().map(cycle).collect()
    }

    #[test]
    fn the_interval_is_student_s_over_the_later_half() {
        // For 0.39, 0.41, 0.40: mean 0.40, standard deviation 0.01, t(2, 0.975) = 4.302653,
        // half-width 0.0248414.
        let list = cycles(&[0.9, 0.8, 0.7, 0.39, 0.41, 0.40]);
        let scatter = over_cycles(&list, |c| c.friction_coefficient).unwrap();
        assert_eq!(scatter.over, "cycles 4 to 6");
        assert_eq!(scatter.scope(), "within this sample (3 cycles)");
        assert!((scatter.flow.mean - 0.40).abs() < 1e-12);
        let half = scatter.half_width().unwrap();
        assert!(
            (half - 4.302_653 * 0.01 / 3f64.sqrt()).abs() < 1e-8,
            "{half}"
        );
    }

    #[test]
    fn three_cycles_are_taken_where_the_half_is_fewer_and_two_are_too_few() {
        let mu = |c: &Cycle| c.friction_coefficient;
        let scatter = over_cycles(&cycles(&[0.5, 0.4, 0.4, 0.41]), mu).unwrap();
        assert_eq!(scatter.over, "cycles 2 to 4");
        assert!(over_cycles(&cycles(&[0.4, 0.41]), mu).is_none());
        let mut unfinished = cycles(&[0.4, 0.41, 0.42]);
        unfinished[2].complete = false;
        assert!(over_cycles(&unfinished, mu).is_none());
        assert!(over_cycles(&[], mu).is_none());
    }

    #[test]
    fn what_still_changes_has_no_interval() {
        let rising: Vec<f64> = (0..20).map(|k| 0.1 + 0.01 * f64::from(k)).collect();
        let scatter = over_cycles(&cycles(&rising), |c| c.friction_coefficient).unwrap();
        assert_eq!(scatter.half_width(), None);
        assert!(
            scatter
                .method()
                .contains("cycles 11 to 20 still show a trend")
        );
    }

    #[test]
    fn a_trend_of_rounding_errors_is_none() {
        let rising: Vec<f64> = (0..20).map(|k| 0.4 + 1e-15 * f64::from(k)).collect();
        let scatter = over_cycles(&cycles(&rising), |c| c.friction_coefficient).unwrap();
        assert!(scatter.half_width().unwrap() < 1e-12);
    }

    #[test]
    fn blocks_count_by_their_divisors() {
        // 1 of 1, 1 of 2, 1 of 5: the ratio of the sums is 3/8, the mean of the ratios 0.567.
        let blocks = [(1.0, 1.0), (1.0, 2.0), (1.0, 5.0)];
        let scatter = over_blocks(&blocks).unwrap();
        assert!((scatter.flow.mean - 0.375).abs() < 1e-15);
        assert_eq!(scatter.scope(), "within this sample (3 blocks)");
        // (x - 3/8 y) 3/8 is 0.234375, 0.09375 and -0.328125.
        let deviations = [0.234_375, 0.093_75, -0.328_125_f64];
        let square: f64 = deviations.iter().map(|d| d * d).sum();
        let half = 4.302_653 * (square / 2.0 / 3.0).sqrt();
        assert!((scatter.half_width().unwrap() / half - 1.0).abs() < 1e-6);
    }

    #[test]
    fn blocks_without_a_load_have_no_interval() {
        assert!(over_blocks(&[(1.0, 2.0), (1.0, 0.0), (1.0, 2.0)]).is_none());
        let scatter = over_blocks(&[(1.0, 2.0), (1.2, 2.0), (1.1, 2.0)]).unwrap();
        assert!((scatter.flow.mean - 0.55).abs() < 1e-12);
    }
}
