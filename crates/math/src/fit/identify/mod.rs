//! How well data determine the parameters of a fit, from the runs that the fit has made.
//!
//! Near the minimum each simulated value is replaced by a polynomial in the unit coordinates u of
//! the parameters, fitted to the runs there (`surrogate.rs`); its noise over seeds averages out.
//! The estimate minimises the weighted squares of this model, within the region. With its
//! derivatives J there, W = diag(g_j / sigma_j^2) and the residuals E of the polynomial,
//!
//! ```text
//! H   = J^T W J - (what noise of J adds to it on average)
//! K   = H^-1 J^T W
//! Cov = K (sigma^2 + h S) K^T,   S = E^T E / degrees of freedom
//! ```
//!
//! The first part is the error of the measurement, the second that of the simulated values at the
//! minimum (h is the leverage of the centre). S has the covariance of values of one run: a seed may
//! shift a whole curve. If the sum of squares exceeds what both explain (probability below 5 %),
//! the model does not describe the data, and Cov is multiplied by the ratio: an honest interval
//! only if the departures are as random as noise. Without a given sigma this is always done.
//! Intervals are Student's, with the degrees of freedom of both parts by Satterthwaite (Biometrics
//! Bulletin 2 (1946) 110). Sources: Bates and Watts, Nonlinear Regression Analysis, 1988; Seber and
//! Wild, Nonlinear Regression, 1989, chapter 5.
//!
//! **Directions** are eigenvectors of H in unit coordinates. One whose interval is wider than the
//! region, or whose eigenvalue cannot be distinguished from noise, is a combination of parameters
//! that the data do not determine; every parameter in it has the whole range as its interval.
//! Orders between parameters are not taken into account.
//!
//! **A parameter at the end of its range** with the squares still falling outwards has a one-sided
//! interval, from the end; the others are then estimated with it fixed.

mod information;
pub mod report;
mod surrogate;

pub use report::{Direction, End, Identification, ParameterEstimate};

use super::bounds::Bounds;
use information::Model;
use surrogate::Surrogate;
use thiserror::Error;

/// A run of a fit: one seed, or the mean over as many seeds as all other runs have.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Parameters in unit coordinates, within [0, 1] (see [`Bounds::folded`]).
    pub point: Vec<f64>,
    /// Simulated values at the measured points (see
    /// [`Target::simulated`](super::residuals::Target::simulated)).
    pub simulated: Vec<f64>,
}

/// The measured values.
#[derive(Clone, Debug, PartialEq)]
pub struct Data<'a> {
    /// Measured values.
    pub measured: &'a [f64],
    /// Standard deviations; `None` to estimate a common one from the deviations of the model.
    pub sigma: Option<&'a [f64]>,
    /// Weights in the fit; `None` for 1.
    pub weights: Option<&'a [f64]>,
    /// Whether the measured specimen scatters as one run does from seed to seed: this scatter is
    /// then added to the error of measurement.
    pub specimen_scatters: bool,
}

/// Reason why the parameters cannot be estimated.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentifyError {
    /// Lists have the wrong length.
    #[error("{what}: {found} where {expected} are expected")]
    Length {
        /// Name of the list.
        what: &'static str,
        /// Expected number.
        expected: usize,
        /// Number given.
        found: usize,
    },
    /// There are too few runs.
    #[error(
        "{runs} runs near the minimum are too few for {parameters} parameters, or vary only some of them: make at least {needed} runs in all directions around it"
    )]
    Few {
        /// Number of given runs.
        runs: usize,
        /// Number of parameters.
        parameters: usize,
        /// Smallest number of runs.
        needed: usize,
    },
    /// There are no degrees of freedom to estimate the error.
    #[error(
        "{values} values without standard deviations for {parameters} parameters: give the standard deviations, or measure more"
    )]
    NoError {
        /// Number of measured values.
        values: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// A number is not finite, or a standard deviation is not positive.
    #[error("{0} must be finite, and standard deviations and weights positive")]
    Number(&'static str),
}

/// Estimates the parameters with intervals, correlations and directions, from the runs near
/// `minimum` (unit coordinates, the mean of the search). Failed runs are not given.
///
/// # Errors
///
/// Lists have the wrong length, numbers are not finite, there are too few runs, or no values to
/// estimate the error.
pub fn identify(
    bounds: &Bounds,
    runs: &[Run],
    minimum: &[f64],
    data: &Data<'_>,
) -> Result<Identification, IdentifyError> {
    check(bounds, runs, minimum, data)?;
    let (n, values) = (bounds.len(), data.measured.len());
    if data.sigma.is_none() && values <= n {
        return Err(IdentifyError::NoError {
            values,
            parameters: n,
        });
    }
    let few = IdentifyError::Few {
        runs: runs.len(),
        parameters: n,
        needed: Surrogate::fewest_runs(n),
    };
    let sigma = match data.sigma {
        Some(sigma) => sigma.to_vec(),
        None => vec![misfit_of_nearest(runs, minimum, data.measured).ok_or(few.clone())?; values],
    };
    let surrogate = Surrogate::fit(runs, minimum, &sigma).ok_or(few)?;
    let weights = data.weights.map_or(vec![1.0; values], <[f64]>::to_vec);
    let model = Model {
        surrogate: &surrogate,
        measured: data.measured,
        sigma: &sigma,
        weights: weights
            .iter()
            .zip(&sigma)
            .map(|(g, s)| g / (s * s))
            .collect(),
        sigma_known: data.sigma.is_some(),
        specimen_scatters: data.specimen_scatters,
    };
    Ok(report::report(bounds, &model))
}

/// Returns the root mean square of the differences of the run nearest to the minimum; a positive
/// number.
fn misfit_of_nearest(runs: &[Run], minimum: &[f64], measured: &[f64]) -> Option<f64> {
    let distance = |r: &&Run| -> f64 {
        r.point
            .iter()
            .zip(minimum)
            .map(|(a, b)| (a - b).powi(2))
            .sum()
    };
    let nearest = runs
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let squares: f64 = nearest
        .simulated
        .iter()
        .zip(measured)
        .map(|(s, m)| (s - m).powi(2))
        .sum();
    Some(
        (squares / measured.len() as f64)
            .sqrt()
            .max(f64::MIN_POSITIVE.sqrt()),
    )
}

fn check(
    bounds: &Bounds,
    runs: &[Run],
    minimum: &[f64],
    data: &Data<'_>,
) -> Result<(), IdentifyError> {
    let (n, values) = (bounds.len(), data.measured.len());
    let mut lengths = vec![
        ("coordinates of the minimum", n, minimum.len()),
        (
            "standard deviations",
            values,
            data.sigma.map_or(values, <[f64]>::len),
        ),
        ("weights", values, data.weights.map_or(values, <[f64]>::len)),
    ];
    for run in runs {
        lengths.push(("coordinates of a run", n, run.point.len()));
        lengths.push(("values of a run", values, run.simulated.len()));
    }
    if let Some((what, expected, found)) = lengths.into_iter().find(|l| l.1 != l.2) {
        return Err(IdentifyError::Length {
            what,
            expected,
            found,
        });
    }
    let finite = |list: &[f64]| list.iter().all(|v| v.is_finite());
    let positive = |list: &[f64]| list.iter().all(|v| v.is_finite() && *v > 0.0);
    if !finite(data.measured) || !finite(minimum) {
        return Err(IdentifyError::Number("measured values"));
    }
    if !data.sigma.is_none_or(positive) || !data.weights.is_none_or(positive) {
        return Err(IdentifyError::Number("standard deviations and weights"));
    }
    if !runs
        .iter()
        .all(|r| finite(&r.point) && finite(&r.simulated))
    {
        return Err(IdentifyError::Number("values of runs"));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
