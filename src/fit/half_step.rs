//! What the step of the runs does to a fit: the runs at the estimate again, with half the step.
//!
//! If simulated values change by d, the estimate changes to first order by -H^-1 J^T W d (see
//! [`identify`](fretwork_study::fit::identify)). The sum of squares does not show such an error: the parameters follow it. For a
//! method of first order the error of the step is twice the change, for one of second order four thirds of it.

use super::FitError;
use super::outcome::{Outcome, half_widths};
use super::search::{Found, Search};
use std::sync::atomic::Ordering;

/// Share of the half-width of its interval by which a parameter may move.
const SMALL: f64 = 0.5;

/// Standard errors beyond which a change is not the scatter of the runs.
const CLEAR: f64 = 2.0;

/// What half the step does to the estimates.
#[derive(Clone, Debug, PartialEq)]
pub enum HalfStep {
    /// The estimates move.
    Moves {
        /// Values of the parameters with half the step.
        values: Vec<f64>,
        /// Parameters that move by more than half the half-width of their intervals, and more than runs scatter.
        beyond: Vec<usize>,
    },
    /// A run with half the step failed, for this reason.
    Failed(String),
}

/// Repeats the runs at the estimate with half their step; `None` if it was interrupted.
///
/// # Errors
/// A run cannot be started.
pub fn half_step(
    search: &Search<'_>,
    found: &Found,
    outcome: &Outcome,
) -> Result<Option<HalfStep>, FitError> {
    let best = &found.evaluations[outcome.best];
    let halved = search.with_half_step(best)?;
    if search.stop.load(Ordering::Relaxed) {
        return Ok(None);
    }
    let influence = &outcome.identification.influence;
    let mut shifts: Vec<Vec<f64>> = Vec::new();
    for (whole, half) in best.samples.iter().zip(halved) {
        let (whole, half) = match (whole, half) {
            (Ok(whole), Ok(half)) => (whole, half),
            (_, Err(why)) => return Ok(Some(HalfStep::Failed(why))),
            (Err(why), _) => return Ok(Some(HalfStep::Failed(why.clone()))),
        };
        let change: Vec<f64> = half.iter().zip(whole).map(|(h, w)| h - w).collect();
        let moved = |row: &Vec<f64>| row.iter().zip(&change).map(|(a, b)| a * b).sum();
        shifts.push(influence.iter().map(moved).collect());
    }
    let widths = half_widths(search, &outcome.identification);
    let mut place = search.tests.bounds.point(&outcome.values());
    let mut beyond = Vec::new();
    for (i, width) in widths.iter().enumerate() {
        let (mean, error) = mean_and_error(shifts.iter().map(|s| s[i]));
        if mean.abs() > SMALL * width && mean.abs() > CLEAR * error {
            beyond.push(i);
        }
        place[i] = (place[i] + mean).clamp(0.0, 1.0);
    }
    Ok(Some(HalfStep::Moves {
        values: search.tests.bounds.values(&place),
        beyond,
    }))
}

/// Mean, and its standard error; zero for one value.
fn mean_and_error(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|v| (v - mean).powi(2)).sum();
    match count > 1.0 {
        true => (mean, (squares / (count * (count - 1.0))).sqrt()),
        false => (mean, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_mean_is_that_of_independent_values() {
        // s^2 = 5/3 of 1, 2, 3, 4.
        let (mean, error) = mean_and_error([1.0, 2.0, 3.0, 4.0].into_iter());
        assert!((mean - 2.5).abs() < 1e-15 && (error - (5.0f64 / 12.0).sqrt()).abs() < 1e-15);
        assert_eq!(mean_and_error([3.0].into_iter()), (3.0, 0.0));
    }
}
