//! Effect of the time step on a fit: the runs at the estimate are repeated with half the step.
//!
//! If simulated values change by d, the estimate changes to first order by -H^-1 J^T W d (see
//! [`identify`](fretwork_math::fit::identify)). The sum of squares does not show such an error: the
//! parameters follow it. For a method of first order the error of the step is twice the change, for
//! one of second order four thirds of it.

use super::outcome::{HalfStep, Moved, Outcome, half_widths};
use super::search::{Search, SearchResult};
use crate::Error;
use fretwork_math::statistics::interval::Mean;
use std::sync::atomic::Ordering;

/// Share of the half-width of its interval by which a parameter may move: with a method of first
/// order its error is then a quarter of the half-width, and an interval of 95 % contains the true
/// value in 92 %.
const MAX_SHIFT: f64 = 0.125;

/// Repeats the runs at the estimate with half their step; `None` if it was interrupted.
///
/// # Errors
/// A run cannot be started.
pub fn half_step(
    search: &Search<'_>,
    found: &SearchResult,
    outcome: &Outcome,
) -> Result<Option<HalfStep>, Error> {
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
    let bounds = &search.tests.bounds;
    let widths = half_widths(search, &outcome.identification);
    let place = bounds.point(&outcome.values());
    let (mut parameters, mut beyond) = (Vec::new(), Vec::new());
    for (i, estimate) in outcome.identification.estimates.iter().enumerate() {
        let of_seeds: Vec<f64> = shifts.iter().map(|s| s[i]).collect();
        let shift = match search.tests.random {
            true => Mean::of(&of_seeds),
            false => of_seeds.first().copied().map(Mean::certain),
        };
        let Some(shift) = shift.filter(|_| estimate.determined && estimate.at.is_none()) else {
            parameters.push(None);
            continue;
        };
        if shift.mean.abs() > MAX_SHIFT * widths[i] && !shift.may_be_zero() {
            beyond.push(i);
        }
        let half_width = shift.half_width.unwrap_or(f64::INFINITY);
        let value = |by: f64| {
            let mut moved = place.clone();
            moved[i] = (place[i] + by).clamp(0.0, 1.0);
            bounds.values(&moved)[i]
        };
        parameters.push(Some(Moved {
            value: value(shift.mean),
            low: value(shift.mean - half_width),
            high: value(shift.mean + half_width),
        }));
    }
    Ok(Some(HalfStep::Moves { parameters, beyond }))
}
