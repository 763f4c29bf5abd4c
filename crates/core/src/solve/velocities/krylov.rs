//! Generalised minimal residuals with a preconditioner from the right.
//!
//! Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869.

/// Limits of a solve.
pub(super) struct Limits {
    /// Residual to reach, relative to the right side.
    pub tolerance: f64,
    /// Largest number of products.
    pub products: usize,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(x, y)| *x += factor * y);
}

/// Returns x with A x = b, for A given by products and a preconditioner that is solved in place,
/// and the residual relative to b. Residuals are measured with a weight for each row.
pub(super) fn solve(
    product: impl Fn(&[f64]) -> Vec<f64>,
    precondition: impl Fn(&mut [f64]),
    b: &[f64],
    weights: &[f64],
    limits: &Limits,
) -> (Vec<f64>, f64) {
    let weighted = |x: &[f64]| {
        x.iter()
            .zip(weights)
            .map(|(x, w)| x * w)
            .collect::<Vec<_>>()
    };
    let mut x = vec![0.0; b.len()];
    let b = weighted(b);
    let size = dot(&b, &b).sqrt();
    if size == 0.0 || !size.is_finite() {
        return (x, size);
    }
    let mut basis = vec![b.iter().map(|x| x / size).collect::<Vec<f64>>()];
    let mut directions: Vec<Vec<f64>> = Vec::new();
    // Columns of the triangular factor, rotations, and the rotated right side.
    let (mut columns, mut rotations) = (Vec::<Vec<f64>>::new(), Vec::<[f64; 2]>::new());
    let mut right = vec![size];
    while directions.len() < limits.products {
        let k = directions.len();
        if right[k].abs() <= limits.tolerance * size {
            break;
        }
        let over = basis[k].iter().zip(weights).map(|(x, w)| x / w);
        let mut direction: Vec<f64> = over.collect();
        precondition(&mut direction);
        let mut next = weighted(&product(&direction));
        directions.push(direction);
        let mut column: Vec<f64> = Vec::with_capacity(k + 2);
        for q in &basis {
            let along = dot(q, &next);
            add(&mut next, -along, q);
            column.push(along);
        }
        let left = dot(&next, &next).sqrt();
        for (i, [c, s]) in rotations.iter().enumerate() {
            let (above, below) = (column[i], column[i + 1]);
            column[i] = c * above + s * below;
            column[i + 1] = c * below - s * above;
        }
        let pivot = column[k].hypot(left);
        if pivot == 0.0 || !pivot.is_finite() {
            directions.pop();
            break;
        }
        let rotation = [column[k] / pivot, left / pivot];
        column[k] = pivot;
        let above = right[k];
        right[k] = rotation[0] * above;
        right.push(-rotation[1] * above);
        rotations.push(rotation);
        columns.push(column);
        if left == 0.0 {
            break;
        }
        basis.push(next.iter().map(|x| x / left).collect());
    }
    let count = directions.len();
    let mut weights = vec![0.0; count];
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| columns[j][i] * weights[j]).sum();
        weights[i] = (right[i] - known) / columns[i][i];
    }
    for (direction, weight) in directions.iter().zip(weights) {
        add(&mut x, weight, direction);
    }
    (x, right[count].abs() / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An unsymmetric matrix of 4 rows, solved with its diagonal as preconditioner in as many
    /// products.
    #[test]
    fn solves_an_unsymmetric_matrix_in_as_many_products_as_rows() {
        let a = [
            [4.0, 1.0, 0.0, 0.5],
            [-2.0, 5.0, 1.0, 0.0],
            [0.0, 3.0, 6.0, -1.0],
            [1.0, 0.0, 2.0, 3.0],
        ];
        let product = |x: &[f64]| a.iter().map(|row| dot(row, x)).collect::<Vec<f64>>();
        let precondition = |x: &mut [f64]| (0..4).for_each(|k| x[k] /= a[k][k]);
        let wanted = [1.0, -2.0, 3.0, 0.5];
        let limits = Limits {
            tolerance: 1e-14,
            products: 4,
        };
        let weights = [1.0, 10.0, 0.1, 2.0];
        let (x, residual) = solve(product, precondition, &product(&wanted), &weights, &limits);
        assert!(residual < 1e-13, "{residual}");
        for (x, wanted) in x.iter().zip(wanted) {
            assert!((x - wanted).abs() < 1e-13, "{x}");
        }
    }
}
