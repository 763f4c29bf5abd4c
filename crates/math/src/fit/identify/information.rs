//! The minimum of the polynomial model, and the information of the data on the parameters there.

use super::surrogate::Surrogate;
use crate::statistics::eigen;
use nalgebra::{DMatrix, DVector};

/// Largest number of iterations of the minimisation; it converges in a few.
const MAX_ITERATIONS: usize = 200;

/// Half-width of an interval in unit coordinates above which a direction counts as undetermined:
/// the interval is as wide as the range.
const UNDETERMINED: f64 = 0.5;

/// Share of an eigenvalue that must remain after subtracting the part of noise.
const ABOVE_NOISE: f64 = 0.5;

/// Quantile of 97.5 % of the normal distribution.
const NORMAL: f64 = 1.959_964;

/// The polynomial model with the data.
pub(super) struct Model<'a> {
    pub surrogate: &'a Surrogate,
    pub measured: &'a [f64],
    pub sigma: &'a [f64],
    /// Weights of the squares: of the fit, over sigma^2.
    pub weights: Vec<f64>,
    pub sigma_known: bool,
    pub specimen_scatters: bool,
}

/// The minimum within the region.
pub(super) struct Minimum {
    pub point: Vec<f64>,
    pub chi_squared: f64,
    /// -1 or 1 for a parameter at its smallest or largest value with a sum of squares that
    /// decreases outwards, otherwise 0.
    pub held: Vec<i8>,
    /// Whether the minimum is at the edge of the neighbourhood of the runs.
    pub at_edge: bool,
}

/// An eigenvector of the information.
pub(super) struct Axis {
    pub vector: Vec<f64>,
    pub eigenvalue: f64,
    /// Half-width of the interval of 95 % in unit coordinates; infinite if the eigenvalue is noise.
    pub half_width: f64,
    pub determined: bool,
}

/// Information of the data on some of the parameters, with the others fixed.
pub(super) struct Information {
    pub axes: Vec<Axis>,
    /// Covariance due to the errors of the measurement.
    pub by_measurement: DMatrix<f64>,
    /// Covariance due to the errors of the simulated values.
    pub by_simulation: DMatrix<f64>,
    /// Change of each parameter with each simulated value, one row per parameter.
    pub by_value: DMatrix<f64>,
}

impl Model<'_> {
    pub(super) fn residuals(&self, point: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(self.measured) - self.surrogate.values(point)
    }

    fn chi_squared(&self, point: &[f64]) -> f64 {
        let residuals = self.residuals(point);
        residuals
            .iter()
            .zip(&self.weights)
            .map(|(r, w)| w * r * r)
            .sum()
    }

    /// Returns J^T W: one row per parameter.
    fn weighted(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(jacobian.ncols(), jacobian.nrows(), |i, j| {
            jacobian[(j, i)] * self.weights[j]
        })
    }

    /// Minimises by the method of Levenberg and Marquardt within the part of the region that the
    /// runs cover; a parameter at its limit that would go beyond is fixed.
    pub(super) fn minimise(&self) -> Minimum {
        let (centre, radius) = (&self.surrogate.centre, self.surrogate.radius);
        let n = centre.len();
        let low: Vec<f64> = centre.iter().map(|c| (c - radius).max(0.0)).collect();
        let high: Vec<f64> = centre.iter().map(|c| (c + radius).min(1.0)).collect();
        let mut point: Vec<f64> = (0..n).map(|i| centre[i].clamp(low[i], high[i])).collect();
        let mut chi_squared = self.chi_squared(&point);
        let mut damping = 1e-9;
        let mut held = vec![0i8; n];
        for _ in 0..MAX_ITERATIONS {
            let jacobian = self.surrogate.jacobian(&point);
            let weighted = self.weighted(&jacobian);
            let downhill = &weighted * self.residuals(&point);
            let information = &weighted * &jacobian;
            held = (0..n)
                .map(|i| match downhill[i] {
                    g if g < 0.0 && point[i] <= low[i] => -1,
                    g if g > 0.0 && point[i] >= high[i] => 1,
                    _ => 0,
                })
                .collect();
            let free: Vec<usize> = (0..n).filter(|i| held[*i] == 0).collect();
            let widest = free
                .iter()
                .map(|i| information[(*i, *i)])
                .fold(0.0, f64::max);
            let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| {
                let extra = if i == j {
                    damping * (widest + information[(free[i], free[i])])
                } else {
                    0.0
                };
                information[(free[i], free[j])] + extra
            });
            let right = DVector::from_fn(free.len(), |i, _| downhill[free[i]]);
            let Some(step) = matrix.cholesky().map(|c| c.solve(&right)) else {
                damping = (damping * 10.0).max(1e-12);
                if damping > 1e12 {
                    break;
                }
                continue;
            };
            let mut next = point.clone();
            for (i, s) in free.iter().zip(step.iter()) {
                next[*i] = (point[*i] + s).clamp(low[*i], high[*i]);
            }
            let value = self.chi_squared(&next);
            let moved = next
                .iter()
                .zip(&point)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            if value <= chi_squared {
                (point, chi_squared) = (next, value);
                damping = (damping * 0.2).max(1e-12);
            } else {
                damping *= 10.0;
            }
            if moved < 1e-11 || damping > 1e12 {
                break;
            }
        }
        // The parameter is fixed by the region, not by the neighbourhood.
        let at_limit = |i: usize| match held[i] {
            -1 => low[i] == 0.0,
            1 => high[i] == 1.0,
            _ => true,
        };
        let at_edge = (0..n).any(|i| !at_limit(i));
        let held = (0..n)
            .map(|i| if at_limit(i) { held[i] } else { 0 })
            .collect();
        Minimum {
            point,
            chi_squared,
            held,
            at_edge,
        }
    }

    /// Returns the share of the noise of a run in the difference of measured and simulated values.
    pub(super) fn noise_share(&self, point: &[f64]) -> f64 {
        self.surrogate.errors(point).0 + if self.specimen_scatters { 1.0 } else { 0.0 }
    }

    /// Returns the variance of the residuals of each value.
    pub(super) fn noise(&self) -> Vec<f64> {
        let degrees = self.surrogate.degrees.max(1) as f64;
        self.surrogate
            .residuals
            .column_iter()
            .map(|c| c.norm_squared() / degrees)
            .collect()
    }

    /// Returns the information on the parameters `free` at a point; covariances are those of the
    /// errors times `scale`.
    pub(super) fn information(&self, point: &[f64], free: &[usize], scale: f64) -> Information {
        let n = free.len();
        let jacobian = self.surrogate.jacobian(point).select_columns(free);
        let weighted = self.weighted(&jacobian);
        let plain = &weighted * &jacobian;
        let (_, slopes) = self.surrogate.errors(point);
        let noise: f64 = self
            .noise()
            .iter()
            .zip(&self.weights)
            .map(|(s, w)| s * w)
            .sum();
        let corrected = DMatrix::from_fn(n, n, |i, j| {
            plain[(i, j)] - noise * slopes[(free[i], free[j])]
        });
        // This is J^T W times the errors of both kinds.
        let measured =
            DMatrix::from_fn(n, self.sigma.len(), |i, j| weighted[(i, j)] * self.sigma[j]);
        let measured = &measured * measured.transpose() * scale;
        let simulated = &weighted * self.surrogate.residuals.transpose();
        let share = self.noise_share(point) / self.surrogate.degrees.max(1) as f64;
        let simulated = &simulated * simulated.transpose() * (share * scale);

        let (eigenvalues, vectors) = eigen::eigen(&corrected);
        let quadratic = |m: &DMatrix<f64>, v: &DVector<f64>| (v.transpose() * m * v)[0];
        let mut inverse = DMatrix::zeros(n, n);
        let mut axes: Vec<Axis> = (0..n)
            .map(|k| {
                let vector = vectors.column(k).into_owned();
                let eigenvalue = eigenvalues[k];
                let error = (quadratic(&measured, &vector) + quadratic(&simulated, &vector)).sqrt();
                let clear =
                    eigenvalue > ABOVE_NOISE * quadratic(&plain, &vector) && eigenvalue > 0.0;
                let half_width = if clear {
                    NORMAL * error / eigenvalue
                } else {
                    f64::INFINITY
                };
                let determined = half_width < UNDETERMINED;
                if determined {
                    inverse += &vector * vector.transpose() / eigenvalue;
                }
                Axis {
                    vector: vector.iter().copied().collect(),
                    eigenvalue,
                    half_width,
                    determined,
                }
            })
            .collect();
        axes.sort_by(|a, b| b.eigenvalue.total_cmp(&a.eigenvalue));
        Information {
            axes,
            by_measurement: &inverse * measured * &inverse,
            by_simulation: &inverse * simulated * &inverse,
            by_value: -&inverse * weighted,
        }
    }
}
