//! Quantiles and tail probabilities of the usual distributions; `None` where there are no degrees
//! of freedom.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, Normal, StudentsT};

/// Degrees of freedom above which Student's distribution is replaced by the normal one.
const LIKE_NORMAL: f64 = 1e5;

/// Returns Student's t below which the fraction `probability` lies.
pub(crate) fn student_quantile(probability: f64, degrees: f64) -> Option<f64> {
    if degrees.is_nan() || degrees < 1.0 {
        return None;
    }
    // The two differ by less than 3e-5 above this value, and the search for the quantile does not
    // end for very many degrees.
    if degrees > LIKE_NORMAL {
        return normal_quantile(probability);
    }
    let t = StudentsT::new(0.0, 1.0, degrees).ok()?;
    Some(t.inverse_cdf(probability))
}

/// Returns the probability of a |t| at least as large by chance.
pub(crate) fn student_two_sided(t: f64, degrees: f64) -> Option<f64> {
    if t.is_nan() || degrees.is_nan() || degrees < 1.0 {
        return None;
    }
    if t.is_infinite() {
        return Some(0.0);
    }
    let distribution = StudentsT::new(0.0, 1.0, degrees).ok()?;
    Some((2.0 * distribution.cdf(-t.abs())).min(1.0))
}

/// Returns the value below which the fraction `probability` of a standard normal variate lies.
pub(crate) fn normal_quantile(probability: f64) -> Option<f64> {
    let normal = Normal::new(0.0, 1.0).ok()?;
    Some(normal.inverse_cdf(probability))
}

/// Returns the probability of a ratio of variances F at least as large by chance.
pub(crate) fn fisher_upper(f: f64, degrees: f64, of_error: f64) -> Option<f64> {
    if f.is_nan() || degrees < 1.0 || of_error < 1.0 {
        return None;
    }
    if f.is_infinite() {
        return Some(0.0);
    }
    let distribution = FisherSnedecor::new(degrees, of_error).ok()?;
    Some(distribution.sf(f.max(0.0)))
}

/// Returns chi-squared below which the fraction `probability` lies.
pub(crate) fn chi_squared_quantile(probability: f64, degrees: f64) -> Option<f64> {
    let distribution = ChiSquared::new(degrees).ok()?;
    Some(distribution.inverse_cdf(probability))
}

/// Returns the probability of a chi-squared at least as large by chance.
pub(crate) fn chi_squared_upper(chi_squared: f64, degrees: f64) -> Option<f64> {
    if chi_squared.is_nan() || degrees < 1.0 {
        return None;
    }
    let distribution = ChiSquared::new(degrees).ok()?;
    Some(distribution.sf(chi_squared.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values are those of common tables: t(0.975, 10) = 2.228, t(0.975, infinity) = 1.960,
    /// F(0.95; 3, 10) = 3.708.
    #[test]
    fn tables() {
        assert!((student_quantile(0.975, 10.0).unwrap() - 2.228).abs() < 1e-3);
        assert!((student_quantile(0.975, f64::INFINITY).unwrap() - 1.960).abs() < 1e-3);
        for degrees in [9e4, 1.1e5, 1e60] {
            assert!((student_quantile(0.975, degrees).unwrap() - 1.959_964).abs() < 3e-5);
        }
        assert!((student_two_sided(2.228, 10.0).unwrap() - 0.05).abs() < 1e-4);
        assert!((student_two_sided(-2.228, 10.0).unwrap() - 0.05).abs() < 1e-4);
        assert!((fisher_upper(3.708, 3.0, 10.0).unwrap() - 0.05).abs() < 1e-4);
        // The quantile of 95 % of chi-squared with 10 degrees of freedom is 18.307.
        assert!((chi_squared_upper(18.307, 10.0).unwrap() - 0.05).abs() < 1e-4);
        assert!((chi_squared_quantile(0.95, 10.0).unwrap() - 18.307).abs() < 1e-3);
        assert_eq!(student_quantile(0.975, 0.0), None);
        assert_eq!(fisher_upper(f64::INFINITY, 1.0, 3.0), Some(0.0));
    }
}
