//! Standardised regression coefficients: effects of continuous factors by a linear model.
//!
//! y = b_0 + sum_i b_i x_i is fitted to the mean outputs of the points by least squares. The
//! standardised coefficient b_i s(x_i) / s(y) is the change of the output, in its standard
//! deviations, for a change of the factor by one of its own; where factors are uncorrelated its
//! square is the share of the variance that the factor explains. R^2 is the share that the linear
//! model explains at all: if it is small, the coefficients say little, and ranks or Sobol's indices
//! say more. Saltelli et al., Global Sensitivity Analysis: The Primer, 2008, section 1.2.
//!
//! Seeds of one point share the point's deviation from the linear model, so that they count as one
//! in the intervals.

use super::SensitivityError;
use super::points::{Points, squares};
use crate::statistics::distribution::{student_quantile, student_two_sided};
use crate::statistics::interval::{CONFIDENCE, Interval};
use crate::statistics::least_squares::{LeastSquares, least_squares};
use nalgebra::{DMatrix, DVector};

/// The coefficient of one factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// Change of the output per unit of the factor.
    pub slope: f64,
    /// Standardised coefficient.
    pub standardised: f64,
    /// Interval of 95 % of the standardised coefficient; `None` if there are only as many points as
    /// coefficients.
    pub interval: Option<Interval>,
    /// Probability of such a coefficient if the factor has no effect.
    pub p: Option<f64>,
}

/// The linear model of an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// One per factor.
    pub coefficients: Vec<Coefficient>,
    /// The output where all factors are 0.
    pub constant: f64,
    /// Share of the variance of the points' means that the model explains.
    pub r_squared: f64,
}

/// Fits the linear model to runs, given by one row of factor values each. Equal rows are seeds of a
/// point; `None` is a failed run.
///
/// # Errors
///
/// Rows have different lengths, the number of outputs is wrong, there are fewer points than
/// factors + 1, factors do not vary or vary together, or all outputs are equal.
pub fn regression(
    rows: &[Vec<f64>],
    outputs: &[Option<f64>],
) -> Result<Regression, SensitivityError> {
    let points = Points::gather(rows, outputs)?;
    let factors = rows.first().map_or(0, Vec::len);
    let count = points.rows.len();
    if count < factors + 1 || count < 2 {
        return Err(SensitivityError::Few {
            what: "points",
            complete: count,
            needed: (factors + 1).max(2),
        });
    }
    let means = points.means();
    let total = squares(&means);
    if total <= 0.0 {
        return Err(SensitivityError::Constant);
    }
    // The mean is subtracted from factors, since columns of a factor far from 0 would appear to be
    // dependent.
    let centres: Vec<f64> = (0..factors)
        .map(|f| points.rows.iter().map(|r| r[f]).sum::<f64>() / count as f64)
        .collect();
    let x = DMatrix::from_fn(count, factors + 1, |i, j| match j {
        0 => 1.0,
        _ => points.rows[i][j - 1] - centres[j - 1],
    });
    let fit = least_squares(&x, &DVector::from_column_slice(&means))
        .ok_or(SensitivityError::Dependent)?;
    let slopes = fit.coefficients.as_slice()[1..].to_vec();
    let coefficients = (0..factors)
        .map(|f| {
            let column: Vec<f64> = points.rows.iter().map(|r| r[f]).collect();
            coefficient(&fit, f + 1, (squares(&column) / total).sqrt())
        })
        .collect();
    let drop: f64 = slopes.iter().zip(&centres).map(|(b, c)| b * c).sum();
    Ok(Regression {
        coefficients,
        constant: fit.coefficients[0] - drop,
        r_squared: 1.0 - fit.residual / total,
    })
}

/// Returns the coefficient in a column, with the ratio of the standard deviations of factor and
/// output.
fn coefficient(fit: &LeastSquares, column: usize, ratio: f64) -> Coefficient {
    let slope = fit.coefficients[column];
    let degrees = fit.degrees as f64;
    let error = (fit.degrees > 0)
        .then(|| (fit.residual / degrees * fit.covariance[(column, column)]).sqrt());
    let half_width =
        error.and_then(|e| Some(student_quantile(0.5 + 0.5 * CONFIDENCE, degrees)? * e));
    Coefficient {
        slope,
        standardised: slope * ratio,
        interval: half_width.map(|h| Interval::around(slope * ratio, h * ratio)),
        p: error.and_then(|e| student_two_sided(slope / e, degrees)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::latin_hypercube::latin_hypercube;
    use crate::statistics::random::normal;
    use rand::SeedableRng;

    /// y = 100 + 3 a - b with uniform factors on [0, 1) and [0, 4): the variances are 9/12 and
    /// 16/12, so that the standardised coefficients are sqrt(9/25) and -sqrt(16/25).
    #[test]
    fn shares_of_a_linear_model() {
        let rows: Vec<Vec<f64>> = latin_hypercube(400, 2, 5)
            .into_iter()
            .map(|u| vec![u[0], 4.0 * u[1]])
            .collect();
        let outputs: Vec<_> = rows
            .iter()
            .map(|x| Some(100.0 + 3.0 * x[0] - x[1]))
            .collect();
        let found = regression(&rows, &outputs).unwrap();
        assert!((found.constant - 100.0).abs() < 1e-11);
        assert!((found.r_squared - 1.0).abs() < 1e-12);
        for (c, (slope, standardised)) in found.coefficients.iter().zip([(3.0, 0.6), (-1.0, -0.8)])
        {
            assert!((c.slope - slope).abs() < 1e-12, "{c:?}");
            assert!((c.standardised - standardised).abs() < 0.03, "{c:?}");
        }
    }

    /// Over 500 studies intervals of slopes contain the truth in 95 % (standard error 1 %), and the
    /// test of a factor without effect rejects 5 %.
    #[test]
    fn intervals_and_tests_keep_their_level() {
        let once = latin_hypercube(20, 2, 8);
        let rows = [once.clone(), once.clone(), once].concat();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        let (mut held, mut significant) = (0, 0);
        for _ in 0..500 {
            let output = |x: &Vec<f64>| Some(2.0 * x[0] + 0.3 * normal(&mut rng));
            let outputs: Vec<Option<f64>> = rows.iter().map(output).collect();
            let found = regression(&rows, &outputs).unwrap();
            let first = found.coefficients[0];
            let ratio = first.standardised / first.slope;
            held += usize::from(first.interval.unwrap().holds(2.0 * ratio));
            significant += usize::from(found.coefficients[1].p.unwrap() < 0.05);
        }
        assert!((460..=490).contains(&held), "{held}");
        assert!((10..=40).contains(&significant), "{significant}");
    }

    #[test]
    fn factors_that_vary_together_are_refused() {
        let rows: Vec<Vec<f64>> = (0..9)
            .map(|i| vec![f64::from(i), 2.0 * f64::from(i)])
            .collect();
        let outputs: Vec<_> = (0..9).map(|i| Some(f64::from(i))).collect();
        assert_eq!(
            regression(&rows, &outputs),
            Err(SensitivityError::Dependent)
        );
        assert!(regression(&rows[..2], &outputs[..2]).is_err());
    }
}
