//! Ordinary least squares by singular values.

use nalgebra::{DMatrix, DVector};

/// Ratio of a singular value to the largest below which columns are dependent, with all columns of
/// unit length.
const DEPENDENT: f64 = 1e-10;

/// Coefficients that minimise |X b - y|, with the data for their errors.
pub(crate) struct LeastSquares {
    /// One coefficient per column of X.
    pub coefficients: DVector<f64>,
    /// (X^T X)^-1, which times the variance of y is the covariance of the coefficients.
    pub covariance: DMatrix<f64>,
    /// Sum of the squared residuals.
    pub residual: f64,
    /// Degrees of freedom: number of rows less number of columns.
    pub degrees: usize,
}

/// Fits the coefficients; `None` if there are fewer rows than columns, or the columns are linearly
/// dependent.
pub(crate) fn least_squares(x: &DMatrix<f64>, y: &DVector<f64>) -> Option<LeastSquares> {
    let inverse = pseudo_inverse(x)?;
    let coefficients = &inverse * y;
    let residual = (x * &coefficients - y).norm_squared();
    Some(LeastSquares {
        coefficients,
        covariance: &inverse * inverse.transpose(),
        residual,
        degrees: x.nrows() - x.ncols(),
    })
}

/// Returns (X^T X)^-1 X^T, which gives the coefficients from y; its product with its transpose is
/// (X^T X)^-1. `None` if there are fewer rows than columns, or the columns are linearly dependent.
pub(crate) fn pseudo_inverse(x: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (rows, columns) = x.shape();
    if rows < columns || columns == 0 {
        return None;
    }
    // Columns have unit length, so that the test of dependence does not depend on units.
    let lengths: Vec<f64> = x.column_iter().map(|c| c.norm()).collect();
    if lengths.iter().any(|l| *l == 0.0 || !l.is_finite()) {
        return None;
    }
    let scaled = DMatrix::from_fn(rows, columns, |i, j| x[(i, j)] / lengths[j]);
    let svd = scaled.svd(true, true);
    let (u, vt) = (svd.u?, svd.v_t?);
    let values = svd.singular_values;
    if values.min() < DEPENDENT * values.max() {
        return None;
    }
    // This is V S^-1, in the units of the coefficients.
    let root = DMatrix::from_fn(columns, columns, |i, j| vt[(j, i)] / values[j] / lengths[i]);
    Some(root * u.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For the line through (0,1), (1,3), (2,4), (3,4) the slope is 1, the intercept 1.5, the
    /// residual sum of squares 1, and (X^T X)^-1 = [[14, -6], [-6, 4]] / 20.
    #[test]
    fn a_line_by_hand() {
        let x = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0]);
        let y = DVector::from_row_slice(&[1.0, 3.0, 4.0, 4.0]);
        let fit = least_squares(&x, &y).unwrap();
        assert!((fit.coefficients - DVector::from_row_slice(&[1.5, 1.0])).norm() < 1e-13);
        assert!((fit.residual - 1.0).abs() < 1e-13);
        let expected = DMatrix::from_row_slice(2, 2, &[0.7, -0.3, -0.3, 0.2]);
        assert!((fit.covariance - expected).norm() < 1e-13);
        assert_eq!(fit.degrees, 2);
    }

    #[test]
    fn dependent_columns_have_no_solution() {
        let x = DMatrix::from_row_slice(3, 2, &[1.0, 2e8, 1.0, 2e8, 1.0, 2e8]);
        assert!(least_squares(&x, &DVector::zeros(3)).is_none());
        assert!(least_squares(&DMatrix::zeros(1, 2), &DVector::zeros(1)).is_none());
    }
}
