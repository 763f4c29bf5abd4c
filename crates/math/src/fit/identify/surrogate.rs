//! A polynomial in the parameters for each simulated value, from the runs near a point.
//!
//! With d = (u - c) / rho, the distance of a run from the centre in units of the radius of the
//! neighbourhood, each value is fitted as f(d) = b_0 + sum_i b_i d_i, with the terms d_i d_j too
//! where there are twice as many runs as terms. A small neighbourhood has few runs and large errors
//! by noise, a large one errors of the polynomial. The variance s^2 of the residuals, of nu degrees
//! of freedom, shows both. The smallest upper limit of noise s_0^2 = s^2 nu / chi^2 (of 99.9 %) of
//! all neighbourhoods is taken as the noise, what is above it as an error of the polynomial; the
//! neighbourhood taken has the smallest
//!
//! ```text
//! h s_0^2 + max(0, s^2 - s_0^2),
//! ```
//!
//! where h s_0^2 is the variance of the polynomial at the centre. Neighbourhoods whose error is
//! small compared with that of the measurement count as equal, and the largest of these is used.

use super::Run;
use crate::statistics::distribution::chi_squared_quantile;
use crate::statistics::least_squares::pseudo_inverse;
use nalgebra::{DMatrix, DVector};

/// Ratio of successive radii.
const SHRINK: f64 = 0.8;

/// Error of the polynomial, in standard errors of the estimate, that is negligible compared with
/// the measurement.
const NEGLIGIBLE_ERROR: f64 = 0.1;

/// Probability that the upper limit of the noise is below the noise.
const LUCK: f64 = 0.001;

/// The polynomials of all values.
pub(super) struct Surrogate {
    pub centre: Vec<f64>,
    pub radius: f64,
    quadratic: bool,
    /// A row per term, a column per value.
    coefficients: DMatrix<f64>,
    /// Covariance of the coefficients of a value whose residuals have the variance 1.
    covariance: DMatrix<f64>,
    /// Residuals, one row per run.
    pub residuals: DMatrix<f64>,
    /// Degrees of freedom: number of runs less number of terms.
    pub degrees: usize,
    /// Variance of the residuals relative to that of the measurement, as a mean over the values.
    spread: f64,
}

impl Surrogate {
    /// Number of terms.
    fn terms(parameters: usize, quadratic: bool) -> usize {
        let second = if quadratic {
            parameters * (parameters + 1) / 2
        } else {
            0
        };
        1 + parameters + second
    }

    /// Returns the smallest number of runs from which a linear polynomial is fitted.
    pub(super) fn fewest_runs(parameters: usize) -> usize {
        2 * Self::terms(parameters, false)
    }

    /// Fits the polynomials in the best neighbourhood of `centre`; `sigma` is the error of each
    /// measured value. `None` if there are too few runs, or they span fewer directions than there
    /// are parameters.
    pub(super) fn fit(runs: &[Run], centre: &[f64], sigma: &[f64]) -> Option<Self> {
        let n = centre.len();
        let mut near: Vec<(f64, &Run)> = runs
            .iter()
            .map(|r| (distance(&r.point, centre), r))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut found: Vec<Self> = Vec::new();
        let mut radius = near.last()?.0;
        loop {
            let inside = near.partition_point(|r| r.0 <= radius);
            if inside < Self::fewest_runs(n) {
                break;
            }
            let chosen: Vec<&Run> = near[..inside].iter().map(|r| r.1).collect();
            for quadratic in [false, true] {
                if inside >= 2 * Self::terms(n, quadratic) {
                    found.extend(Self::of(&chosen, centre, radius, quadratic, sigma));
                }
            }
            radius = (radius * SHRINK).min(near[inside - 1].0 * (1.0 - 1e-12));
            if radius <= 0.0 {
                break;
            }
        }
        // Linear polynomials are used only where no neighbourhood has enough runs for others.
        if found.iter().any(|s| s.quadratic) {
            found.retain(|s| s.quadratic);
        }
        // Values of a run may be correlated, so that only the runs count as degrees of freedom.
        let limit = |s: &Self| {
            let degrees = s.degrees as f64;
            Some(s.spread * degrees / chi_squared_quantile(LUCK, degrees)?)
        };
        let noise = found.iter().filter_map(limit).fold(f64::MAX, f64::min);
        // This is the deviation for an error of the estimate of one standard error, as a mean over
        // the values.
        let enough = NEGLIGIBLE_ERROR * NEGLIGIBLE_ERROR * n as f64 / sigma.len() as f64;
        let error = |s: &Self| {
            let excess = (s.spread - noise).max(0.0);
            (s.covariance[(0, 0)] * noise + excess).max(enough)
        };
        let best = found.iter().map(error).fold(f64::MAX, f64::min);
        // Radii decrease, so that the first is the largest, and of equal radii the one with fewer
        // terms.
        found.into_iter().find(|s| error(s) <= best)
    }

    fn of(
        runs: &[&Run],
        centre: &[f64],
        radius: f64,
        quadratic: bool,
        sigma: &[f64],
    ) -> Option<Self> {
        let rows: Vec<Vec<f64>> = runs
            .iter()
            .map(|r| {
                let d: Vec<f64> = r
                    .point
                    .iter()
                    .zip(centre)
                    .map(|(u, c)| (u - c) / radius)
                    .collect();
                terms(&d, quadratic)
            })
            .collect();
        let x = DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]);
        let y = DMatrix::from_fn(runs.len(), sigma.len(), |i, j| runs[i].simulated[j]);
        let inverse = pseudo_inverse(&x)?;
        let coefficients = &inverse * &y;
        let residuals = y - &x * &coefficients;
        let degrees = rows.len() - rows[0].len();
        let spread = (0..sigma.len())
            .map(|j| residuals.column(j).norm_squared() / (sigma[j] * sigma[j]))
            .sum::<f64>()
            / (sigma.len() * degrees) as f64;
        Some(Self {
            centre: centre.to_vec(),
            radius,
            quadratic,
            coefficients,
            covariance: &inverse * inverse.transpose(),
            residuals,
            degrees,
            spread,
        })
    }

    /// The values at a point of the unit cube.
    pub(super) fn values(&self, point: &[f64]) -> DVector<f64> {
        let row = DVector::from_vec(terms(&self.distance(point), self.quadratic));
        self.coefficients.tr_mul(&row)
    }

    /// Returns the derivatives by the coordinates: one row per value, one column per parameter.
    pub(super) fn jacobian(&self, point: &[f64]) -> DMatrix<f64> {
        self.coefficients.tr_mul(&self.slopes(point))
    }

    /// Returns the variance of a value at a point, and the covariance of its derivatives there, for
    /// residuals with the variance 1.
    pub(super) fn errors(&self, point: &[f64]) -> (f64, DMatrix<f64>) {
        let row = DVector::from_vec(terms(&self.distance(point), self.quadratic));
        let slopes = self.slopes(point);
        (
            (row.transpose() * &self.covariance * &row)[0],
            slopes.transpose() * &self.covariance * &slopes,
        )
    }

    /// Returns the derivatives of the terms by the coordinates, one row per term.
    fn slopes(&self, point: &[f64]) -> DMatrix<f64> {
        let d = self.distance(point);
        let n = d.len();
        let mut slopes = DMatrix::zeros(self.coefficients.nrows(), n);
        for i in 0..n {
            slopes[(1 + i, i)] = 1.0;
        }
        let mut term = 1 + n;
        if self.quadratic {
            for i in 0..n {
                for j in i..n {
                    slopes[(term, i)] += d[j];
                    slopes[(term, j)] += d[i];
                    term += 1;
                }
            }
        }
        slopes / self.radius
    }

    fn distance(&self, point: &[f64]) -> Vec<f64> {
        let relative = |(u, c): (&f64, &f64)| (u - c) / self.radius;
        point.iter().zip(&self.centre).map(relative).collect()
    }
}

/// Returns 1, the coordinates, and their products.
fn terms(d: &[f64], quadratic: bool) -> Vec<f64> {
    let mut row = vec![1.0];
    row.extend(d);
    if quadratic {
        for i in 0..d.len() {
            row.extend(d[i..].iter().map(|other| d[i] * other));
        }
    }
    row
}

/// Returns the largest difference of a coordinate.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::latin_hypercube::latin_hypercube;

    fn runs(f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Run> {
        let made = |point: Vec<f64>| Run {
            simulated: f(&point),
            point,
        };
        latin_hypercube(80, 2, 4).into_iter().map(made).collect()
    }

    /// A quadratic function is reproduced everywhere, with its derivatives (2 u + v, u - 3).
    #[test]
    fn quadratic_functions_are_exact() {
        let f = |u: &[f64]| u[0] * u[0] + u[0] * u[1] - 3.0 * u[1];
        let found = Surrogate::fit(&runs(|u| vec![f(u), 1.0]), &[0.4, 0.6], &[1e-3; 2]).unwrap();
        assert!(found.quadratic && found.residuals.nrows() == 80);
        let at = [0.3, 0.8];
        assert!((found.values(&at)[0] - f(&at)).abs() < 1e-12);
        let slopes = found.jacobian(&at);
        assert!((slopes[(0, 0)] - 1.4).abs() < 1e-11 && (slopes[(0, 1)] + 2.7).abs() < 1e-11);
        assert!(slopes.row(1).norm() < 1e-11);
    }

    /// exp(6 u) is not a quadratic function over the whole cube: a small neighbourhood is used
    /// where the measurement is accurate, a larger one where it is not.
    #[test]
    fn the_neighbourhood_follows_the_accuracy() {
        let made = runs(|u| vec![(6.0 * u[0]).exp() / 20.0 + u[1]]);
        let radius = |sigma: f64| Surrogate::fit(&made, &[0.5, 0.5], &[sigma]).unwrap().radius;
        assert!(
            radius(1e-3) < 0.35 && radius(30.0) > 0.49,
            "{} {}",
            radius(1e-3),
            radius(30.0)
        );
        assert!(Surrogate::fit(&made[..5], &[0.5, 0.5], &[1.0]).is_none());
    }
}
