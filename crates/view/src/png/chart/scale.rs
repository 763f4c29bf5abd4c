//! Axis scales: round tick values within a range.

use crate::png::canvas::DrawError;
use fretwork_observe::chart::{Axis, AxisRange, number, superscript};

/// Range of an axis with tick values and labels.
#[derive(Clone, Debug)]
pub(crate) struct AxisScale {
    /// Exponent of ten by which values are divided.
    pub exponent: i32,
    log: bool,
    /// Range in displayed values (divided by the power of ten, or its logarithm).
    pub range: (f64, f64),
    /// Tick positions in displayed values, with their labels.
    pub ticks: Vec<(f64, String)>,
    /// Positions of the minor ticks of a logarithmic axis.
    pub minor: Vec<f64>,
    /// Name with the displayed unit.
    pub label: String,
}

/// Checks the range that is requested for an axis.
///
/// # Errors
/// The axis cannot have the range.
pub(crate) fn check_range(axis: &Axis, asked: Option<(f64, f64)>) -> Result<(), DrawError> {
    match asked {
        Some((from, to)) if !axis.reaches((from, to)) => Err(DrawError::Range {
            axis: axis.name.clone(),
            from,
            to,
            log: axis.log,
        }),
        _ => Ok(()),
    }
}

impl AxisScale {
    /// Returns the scale of a range, with about a number of ticks.
    pub fn new(axis: &Axis, range: AxisRange, ticks: usize) -> Self {
        let mut scale = Self {
            exponent: range.exponent,
            log: axis.log,
            range: (0.0, 1.0),
            ticks: Vec::new(),
            minor: Vec::new(),
            label: range.label,
        };
        let (a, b) = (scale.shown(range.ends.0), scale.shown(range.ends.1));
        scale.range = (a, b);
        scale.ticks = if axis.log {
            decades(a, b, ticks)
        } else if axis.whole && b - a < ticks as f64 {
            round_ticks(a, b, (b - a).ceil() as usize)
        } else {
            round_ticks(a, b, ticks)
        };
        if axis.whole && scale.exponent == 0 {
            scale.ticks.retain(|t| (t.0 - t.0.round()).abs() < 1e-9);
            for (at, label) in &mut scale.ticks {
                *label = number(at.round(), 0);
            }
        }
        if axis.log && b - a < 8.0 {
            let decades = a.floor() as i32..=b.floor() as i32;
            let all =
                decades.flat_map(|e| (2..10).map(move |k| f64::from(e) + f64::from(k).log10()));
            scale.minor = all.filter(|v| (a..=b).contains(v)).collect();
        }
        scale
    }

    /// Share of the range at which a displayed value lies.
    pub fn share(&self, shown: f64) -> f64 {
        (shown - self.range.0) / (self.range.1 - self.range.0)
    }

    /// Displayed value for a value in the axis unit; NaN if it cannot be shown.
    pub fn shown(&self, value: f64) -> f64 {
        if self.log {
            if value > 0.0 { value.log10() } else { f64::NAN }
        } else {
            value / 10f64.powi(self.exponent)
        }
    }
}

/// Ticks at 1, 2 or 5 times a power of ten, about `count` of them.
fn round_ticks(low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
    let rough = (high - low) / count.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = power
        * match rough / power {
            r if r < 1.5 => 1.0,
            r if r < 3.5 => 2.0,
            r if r < 7.5 => 5.0,
            _ => 10.0,
        };
    let decimals = (-(step * 1.0001).log10().floor()).clamp(0.0, 9.0) as usize;
    let slack = 1e-6 * step;
    let (first, last) = (
        ((low - slack) / step).ceil() as i64,
        ((high + slack) / step).floor() as i64,
    );
    (first..=last)
        .take(4 * count + 4)
        .map(|i| (i as f64 * step, number(i as f64 * step, decimals)))
        .collect()
}

/// Ticks at powers of ten, or at round values when there is less than a decade.
fn decades(low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
    let (first, last) = (low.ceil() as i32, high.floor() as i32);
    let stride = ((last - first) / (count as i32 + 1) + 1).max(1);
    if last - first >= 1 {
        return (first..=last)
            .filter(|e| e.rem_euclid(stride) == 0)
            .map(|e| (f64::from(e), format!("10{}", superscript(e))))
            .collect();
    }
    round_ticks(10f64.powf(low), 10f64.powf(high), count)
        .into_iter()
        .filter(|(v, _)| *v > 0.0)
        .map(|(v, label)| (v.log10(), label))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(axis: &Axis, values: &[f64], ticks: usize) -> AxisScale {
        AxisScale::new(axis, axis.range(values.iter().copied(), None), ticks)
    }

    #[test]
    fn ticks_are_round_and_signed() {
        let labels: Vec<_> = round_ticks(-1.1, 1.1, 5).into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(round_ticks(0.0, 100.0, 5)[1].1, "20");
        let log = Axis::new("t", "s").log();
        let scale = scale(&log, &[1e-3, -1.0, 10.0], 6);
        assert_eq!(scale.ticks[0].1, "10⁻³");
    }

    #[test]
    fn whole_numbers_have_no_ticks_between_them() {
        let axis = Axis::new("cycle number N", "").whole();
        for (first, last) in [(1.0, 3.0), (1.0, 1.0), (1.0, 12.0), (1.0, 1000.0)] {
            let scale = scale(&axis, &[first, last], 8);
            assert!(!scale.ticks.is_empty() && scale.ticks.len() < 14);
            assert!(
                scale.ticks.iter().all(|t| !t.1.contains('.')),
                "{:?}",
                scale.ticks
            );
        }
    }

    #[test]
    fn constants_and_nothing_have_a_range() {
        let axis = Axis::new("φ", "");
        for values in [vec![], vec![0.0], vec![-3.0, -3.0], vec![f64::NAN]] {
            let scale = scale(&axis, &values, 5);
            assert!(scale.range.0 < scale.range.1);
            assert!(scale.ticks.len() > 1);
        }
        let error = check_range(&axis, Some((2.0, 1.0))).unwrap_err();
        assert!(error.to_string().contains("2 to 1 of axis 'φ'"), "{error}");
    }
}
