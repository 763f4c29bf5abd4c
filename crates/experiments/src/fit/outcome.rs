//! Estimates of the parameters with intervals, from runs around the best point.

use super::search::{Evaluation, Search, SearchResult, Stage};
use crate::Error;
use fretwork_math::fit::identify::{self as mathematics, Data, Identification, Run};
use fretwork_math::fit::residuals::over_seeds;
use serde::Serialize;

/// Half-width of the first neighbourhood, relative to the range of each parameter.
const FIRST: f64 = 0.1;

/// Smallest and largest half-width of a neighbourhood.
const NARROWEST: f64 = 2e-3;
const WIDEST: f64 = 0.25;

/// Factor by which intervals may be wider or narrower than a neighbourhood that fits them.
const ALIKE: f64 = 3.0;

/// Largest number of neighbourhoods that are tried.
const ROUNDS: u64 = 4;

/// A fit.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Estimates, intervals, correlations, directions.
    pub identification: Identification,
    /// Number of the evaluation at the estimate; of the best point if the estimate fits worse or
    /// its runs fail.
    pub best: usize,
    /// Whether the runs at the estimate fit as well as the best point, and the neighbourhood fits
    /// the intervals.
    pub settled: bool,
    /// Effect of half the step on the estimates, if the fit requests it.
    pub half_step: Option<HalfStep>,
}

/// Effect of half the step of the runs on the estimates.
#[derive(Clone, Debug, PartialEq)]
pub enum HalfStep {
    /// The estimates move.
    Moves {
        /// Parameters with half the step; `None` for a parameter at an end of its range, and for
        /// one that is not determined.
        parameters: Vec<Option<Moved>>,
        /// Parameters that move by more than an eighth of the half-width of their intervals, and
        /// more than runs scatter.
        beyond: Vec<usize>,
    },
    /// A run with half the step failed, for this reason.
    Failed(String),
}

/// A parameter with half the step, with its interval of 95 % over the seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Moved {
    /// Value of the parameter.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Outcome {
    /// Returns the values of the parameters.
    pub fn values(&self) -> Vec<f64> {
        self.identification
            .estimates
            .iter()
            .map(|e| e.value)
            .collect()
    }
}

/// Runs points around the best one, in a neighbourhood as wide as the resulting intervals, and
/// determines the estimates; `None` if no point gave all curves, or if it was interrupted.
///
/// # Errors
/// A run cannot be started, or too few of the runs around the best point succeed.
pub fn identify(search: &Search<'_>, found: &mut SearchResult) -> Result<Option<Outcome>, Error> {
    if found.best.is_none() {
        return Ok(None);
    }
    let count = search.tests.bounds.len();
    let mut widths = vec![FIRST; count];
    let mut identification = None;
    let mut settled = false;
    for round in 1..=ROUNDS {
        let centre = found.best;
        let local = search.around(found, &widths, round)?;
        if search.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Ok(None);
        }
        let runs = runs(&found.evaluations[local]);
        let place = match centre {
            Some(best) => found.evaluations[best].place.clone(),
            None => return Ok(None),
        };
        let known = from_runs(search, &runs, &place)?;
        let estimate: Vec<f64> = known.estimates.iter().map(|e| e.value).collect();
        let first = found.evaluations.len();
        search.candidate(found, &estimate)?;
        if search.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Ok(None);
        }
        // The estimate is the minimum according to the surrounding runs; it may be wrong if these
        // are too far away.
        let better = found.least(first..found.evaluations.len());
        let squares = |k: usize| found.evaluations[k].chi_squared.unwrap_or(f64::INFINITY);
        let mut accepted = false;
        if let (Some(new), Some(old)) = (better, found.best)
            && squares(new) <= squares(old) + 1.0
        {
            found.best = Some(new);
            accepted = true;
        }
        let wanted: Vec<f64> = half_widths(search, &known)
            .iter()
            .map(|w| w.clamp(NARROWEST, WIDEST))
            .collect();
        let alike = |(w, now): (&f64, &f64)| *w <= ALIKE * now && *now <= ALIKE * w;
        settled = accepted && !known.at_edge && wanted.iter().zip(&widths).all(alike);
        identification = Some(known);
        if settled {
            break;
        }
        widths = wanted;
    }
    Ok(identification
        .zip(found.best)
        .map(|(identification, best)| Outcome {
            identification,
            best,
            settled,
            half_step: None,
        }))
}

/// Returns one run for each seed of each point that gave all curves.
fn runs(evaluations: &[Evaluation]) -> Vec<Run> {
    let of = |e: &Evaluation| -> Vec<Run> {
        let values = e.samples.iter().filter_map(|s| s.as_ref().ok());
        values
            .map(|v| Run {
                point: e.place.clone(),
                simulated: v.clone(),
            })
            .collect()
    };
    evaluations
        .iter()
        .filter(|e| e.stage == Stage::Local)
        .flat_map(of)
        .collect()
}

fn from_runs(search: &Search<'_>, runs: &[Run], minimum: &[f64]) -> Result<Identification, Error> {
    let target = &search.tests.target;
    let (measured, sigma, weights) = (target.measured(), target.sigma(), target.weights());
    let data = Data {
        measured: &measured,
        sigma: Some(&sigma),
        weights: Some(&weights),
        specimen_scatters: search.tests.specimen_scatters,
    };
    mathematics::identify(&search.tests.bounds, runs, minimum, &data)
        .map_err(|e| Error::Failed(e.to_string()))
}

/// Returns the half-widths of the intervals in the unit cube.
pub fn half_widths(search: &Search<'_>, known: &Identification) -> Vec<f64> {
    let low: Vec<f64> = known.estimates.iter().map(|e| e.interval.low).collect();
    let high: Vec<f64> = known.estimates.iter().map(|e| e.interval.high).collect();
    let places = (
        search.tests.bounds.point(&low),
        search.tests.bounds.point(&high),
    );
    places
        .0
        .iter()
        .zip(&places.1)
        .map(|(a, b)| 0.5 * (b - a))
        .collect()
}

/// Returns the mean over the seeds of an evaluation, and the standard deviation of one run where
/// there are several.
pub fn mean_of(evaluation: &Evaluation) -> Option<(Vec<f64>, Option<Vec<f64>>)> {
    let rows: Vec<Vec<f64>> = evaluation
        .samples
        .iter()
        .filter_map(|s| s.as_ref().ok().cloned())
        .collect();
    let over = over_seeds(&rows)?;
    let deviation = over
        .variance
        .map(|v| v.into_iter().map(f64::sqrt).collect());
    Some((over.mean, deviation))
}
