//! Differences between simulated and measured curves, and their weighted sum of squares.
//!
//! For the measured values y_j +- sigma_j at x_j of all tests, and the simulated curves f
//! interpolated there,
//!
//! ```text
//! chi^2 = sum_j g_j (f(x_j) - y_j)^2 / sigma_j^2
//! ```
//!
//! with the weight g_j of the test, 1 unless set otherwise. If the model describes the measurement
//! and the weights are 1, chi^2 is about the number of values less that of parameters. The variance
//! of simulated values is not included: it depends on the parameters, so that noisy ones would
//! appear to fit well.

use thiserror::Error;

/// A measured curve, or single values (of one point each).
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Name of the test, for messages.
    pub name: String,
    /// Abscissae, in any order.
    pub x: Vec<f64>,
    /// Values.
    pub y: Vec<f64>,
    /// Standard deviation of each value: of the measurement, and of effects that the model does not
    /// describe.
    pub sigma: Vec<f64>,
    /// Factor of the squares of this test.
    pub weight: f64,
}

/// A simulated curve: abscissae that increase, and values.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Abscissae.
    pub x: &'a [f64],
    /// Values.
    pub y: &'a [f64],
}

/// Reason why curves cannot be compared.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ResidualError {
    /// The measurement is wrong.
    #[error("measurement {name}: {reason}")]
    Measurement {
        /// Name of the test.
        name: String,
        /// Reason.
        reason: String,
    },
    /// The simulated curve is wrong.
    #[error("simulated curve of {name}: {reason}")]
    Simulated {
        /// Name of the test.
        name: String,
        /// Reason.
        reason: String,
    },
    /// The number of curves is not that of the tests, or the number of values not that of the
    /// measured ones.
    #[error("{found} where {expected} are measured")]
    Count {
        /// Expected number.
        expected: usize,
        /// Number given.
        found: usize,
    },
}

/// Fraction of the range of abscissae by which a measured point may lie outside the simulated
/// curve.
const OVERHANG: f64 = 1e-9;

/// All measurements of a fit. Vectors of values begin with those of the first test.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    tests: Vec<Measurement>,
}

impl Target {
    /// Checks the measurements and creates the target.
    ///
    /// # Errors
    ///
    /// Lists have different lengths, there are no values, values are not finite, or a sigma or
    /// weight is not positive.
    pub fn new(tests: Vec<Measurement>) -> Result<Self, ResidualError> {
        for test in &tests {
            let lengths = [test.x.len(), test.y.len(), test.sigma.len()];
            let finite = test.x.iter().chain(&test.y).all(|v| v.is_finite());
            let positive = |v: &f64| v.is_finite() && *v > 0.0;
            let reason = if lengths.iter().any(|l| *l != lengths[0]) {
                format!(
                    "{} abscissae, {} values and {} standard deviations: give as many of each",
                    lengths[0], lengths[1], lengths[2]
                )
            } else if lengths[0] == 0 {
                "it has no values".into()
            } else if !finite {
                "all abscissae and values must be finite".into()
            } else if !test.sigma.iter().all(positive) {
                "each standard deviation must be positive: it says how closely the fit should follow the value".into()
            } else if !positive(&test.weight) {
                format!("the weight must be positive, not {}", test.weight)
            } else {
                continue;
            };
            return Err(ResidualError::Measurement {
                name: test.name.clone(),
                reason,
            });
        }
        Ok(Self { tests })
    }

    /// Weights the residuals so that each test has the weight of a single value, for any number of
    /// values.
    pub fn balanced(mut self) -> Self {
        for test in &mut self.tests {
            test.weight = 1.0 / test.y.len() as f64;
        }
        self
    }

    /// The tests.
    pub fn tests(&self) -> &[Measurement] {
        &self.tests
    }

    /// Returns the measured values of all tests.
    pub fn measured(&self) -> Vec<f64> {
        self.tests
            .iter()
            .flat_map(|t| t.y.iter().copied())
            .collect()
    }

    /// Returns the standard deviations of all values.
    pub fn sigma(&self) -> Vec<f64> {
        self.tests
            .iter()
            .flat_map(|t| t.sigma.iter().copied())
            .collect()
    }

    /// Returns the weight of each value's test.
    pub fn weights(&self) -> Vec<f64> {
        self.tests
            .iter()
            .flat_map(|t| vec![t.weight; t.y.len()])
            .collect()
    }

    /// Returns the simulated values at the measured abscissae, from one curve per test.
    ///
    /// # Errors
    ///
    /// The number of curves is wrong, or [`resample`] cannot use a curve.
    pub fn simulated(&self, curves: &[Curve<'_>]) -> Result<Vec<f64>, ResidualError> {
        if curves.len() != self.tests.len() {
            return Err(ResidualError::Count {
                expected: self.tests.len(),
                found: curves.len(),
            });
        }
        let mut values = Vec::new();
        for (test, curve) in self.tests.iter().zip(curves) {
            let found = resample(*curve, &test.x).map_err(|reason| ResidualError::Simulated {
                name: test.name.clone(),
                reason,
            })?;
            values.extend(found);
        }
        Ok(values)
    }

    /// Returns simulated less measured values, in standard deviations, each times the root of its
    /// test's weight: chi^2 is the sum of their squares.
    ///
    /// # Errors
    ///
    /// The number of values is not that of the measured ones.
    fn residuals(&self, simulated: &[f64]) -> Result<Vec<f64>, ResidualError> {
        let (measured, sigma, weights) = (self.measured(), self.sigma(), self.weights());
        if simulated.len() != measured.len() {
            return Err(ResidualError::Count {
                expected: measured.len(),
                found: simulated.len(),
            });
        }
        let residual =
            |j: usize| (simulated[j] - measured[j]) * (weights[j] / (sigma[j] * sigma[j])).sqrt();
        Ok((0..measured.len()).map(residual).collect())
    }

    /// The weighted sum of squares.
    ///
    /// # Errors
    ///
    /// The number of values is not that of the measured ones.
    pub fn chi_squared(&self, simulated: &[f64]) -> Result<f64, ResidualError> {
        Ok(self.residuals(simulated)?.iter().map(|r| r * r).sum())
    }
}

/// Returns the values of a curve at other abscissae, by linear interpolation.
///
/// # Errors
///
/// Returns a sentence: abscissae do not increase, values are not finite, or abscissae are outside
/// the curve.
pub fn resample(curve: Curve<'_>, at: &[f64]) -> Result<Vec<f64>, String> {
    let (x, y) = (curve.x, curve.y);
    if x.len() != y.len() {
        return Err(format!(
            "it has {} abscissae and {} values",
            x.len(),
            y.len()
        ));
    }
    let (Some(first), Some(last)) = (x.first(), x.last()) else {
        return Err("it is empty".into());
    };
    if let Some(i) = (0..x.len()).find(|i| !(x[*i].is_finite() && y[*i].is_finite())) {
        return Err(format!("point {i} is not finite"));
    }
    if let Some(i) = (1..x.len()).find(|i| x[*i] <= x[*i - 1]) {
        return Err(format!(
            "its abscissae must increase, but go from {} to {} at point {i}: compare a curve that turns back over time or path",
            x[i - 1],
            x[i]
        ));
    }
    let overhang = OVERHANG * (last - first);
    at.iter()
        .map(|x_at| {
            if *x_at < first - overhang || *x_at > last + overhang {
                return Err(format!(
                    "it runs from {first} to {last}, but a value is measured at {x_at}: run it farther, or leave the value out"
                ));
            }
            let above = x.partition_point(|v| v < x_at).clamp(1, x.len().max(2) - 1);
            if x.len() == 1 {
                return Ok(y[0]);
            }
            let (from, to) = (x[above - 1], x[above]);
            let share = ((x_at - from) / (to - from)).clamp(0.0, 1.0);
            Ok(y[above - 1] + share * (y[above] - y[above - 1]))
        })
        .collect()
}

/// Values of one point over its seeds.
#[derive(Clone, Debug, PartialEq)]
pub struct OverSeeds {
    /// Mean of each value.
    pub mean: Vec<f64>,
    /// Variance of each value of one run; `None` for one seed. The mean has this divided by the
    /// number of seeds.
    pub variance: Option<Vec<f64>>,
    /// Number of seeds.
    pub seeds: usize,
}

/// Returns means and variances over seeds, given one row of values per seed; `None` for no rows or
/// rows of different lengths.
pub fn over_seeds(rows: &[Vec<f64>]) -> Option<OverSeeds> {
    let width = rows.first()?.len();
    if rows.iter().any(|r| r.len() != width) {
        return None;
    }
    let count = rows.len() as f64;
    let mean: Vec<f64> = (0..width)
        .map(|j| rows.iter().map(|r| r[j]).sum::<f64>() / count)
        .collect();
    let variance = (rows.len() > 1).then(|| {
        (0..width)
            .map(|j| rows.iter().map(|r| (r[j] - mean[j]).powi(2)).sum::<f64>() / (count - 1.0))
            .collect()
    });
    Some(OverSeeds {
        mean,
        variance,
        seeds: rows.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn test(name: &str, x: &[f64], y: &[f64], sigma: f64) -> Measurement {
        Measurement {
            name: name.into(),
            x: x.to_vec(),
            y: y.to_vec(),
            sigma: vec![sigma; y.len()],
            weight: 1.0,
        }
    }

    /// For f = 2 x on [0, 2], measured 1 at 0.25 and 3 at 1.5 with sigma 0.5, and one value 7 +- 1
    /// simulated as 9, the residuals are -1, 0, 2.
    #[test]
    fn sums_over_all_tests() {
        let target = Target::new(vec![
            test("curve", &[0.25, 1.5], &[1.0, 3.0], 0.5),
            test("value", &[0.0], &[7.0], 1.0),
        ])
        .unwrap();
        let curve = Curve {
            x: &[0.0, 1.0, 2.0],
            y: &[0.0, 2.0, 4.0],
        };
        let value = Curve {
            x: &[0.0],
            y: &[9.0],
        };
        let simulated = target.simulated(&[curve, value]).unwrap();
        assert_eq!(simulated, [0.5, 3.0, 9.0]);
        assert_eq!(target.residuals(&simulated).unwrap(), [-1.0, 0.0, 2.0]);
        assert_eq!(target.chi_squared(&simulated).unwrap(), 5.0);
        let balanced = target.balanced();
        assert_eq!(balanced.chi_squared(&simulated).unwrap(), 4.5);
    }

    #[test]
    fn errors_name_the_test_and_say_what_to_change() {
        let error_of = |t: Measurement| Target::new(vec![t]).unwrap_err().to_string();
        assert!(
            error_of(test("a", &[0.0], &[1.0, 2.0], 1.0)).contains("measurement a: 1 abscissae")
        );
        assert!(error_of(test("a", &[0.0], &[1.0], 0.0)).contains("must be positive"));
        let target = Target::new(vec![test("a", &[0.0, 3.0], &[1.0, 2.0], 1.0)]).unwrap();
        let error_of =
            |x: &[f64], y: &[f64]| target.simulated(&[Curve { x, y }]).unwrap_err().to_string();
        assert!(error_of(&[0.0, 2.0], &[0.0, 1.0]).contains("run it farther"));
        assert!(error_of(&[0.0, 2.0, 1.0], &[0.0; 3]).contains("must increase"));
        assert!(error_of(&[0.0, 3.0], &[0.0, f64::NAN]).contains("point 1"));
        assert!(error_of(&[], &[]).contains("empty"));
        assert!(target.simulated(&[]).is_err() && target.chi_squared(&[1.0]).is_err());
    }

    #[test]
    fn interpolates_at_ends_and_between() {
        let curve = Curve {
            x: &[0.0, 1.0, 3.0],
            y: &[1.0, 3.0, -1.0],
        };
        let found = resample(curve, &[3.0 + 1e-12, 0.0, 0.5, 1.0, 2.0]).unwrap();
        assert_eq!(found, [-1.0, 1.0, 2.0, 3.0, 1.0]);
    }

    #[test]
    fn means_over_seeds() {
        let over = over_seeds(&[vec![1.0, 5.0], vec![3.0, 5.0]]).unwrap();
        assert_eq!(
            (over.mean, over.variance),
            (vec![2.0, 5.0], Some(vec![2.0, 0.0]))
        );
        assert_eq!(over_seeds(&[vec![1.0]]).unwrap().variance, None);
        assert!(over_seeds(&[]).is_none() && over_seeds(&[vec![1.0], vec![]]).is_none());
    }
}
