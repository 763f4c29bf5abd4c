//! Generalised minimal residuals, with a preconditioner on the right (Y. Saad, M. H. Schultz, SIAM
//! Journal on Scientific and Statistical Computing 7, 1986).

use crate::fields::{Field, Vector, add, dot};

/// Solves `map x = right` from x = 0 until the residual has decreased by `tolerance`, or in `most`
/// iterations. Also returns the number of iterations.
pub fn solve(
    map: impl Fn(&[Vector]) -> Field,
    about_inverse: impl Fn(&[Vector]) -> Field,
    right: &[Vector],
    tolerance: f64,
    most: usize,
) -> (Field, usize) {
    let size = dot(right, right).sqrt();
    let mut x = vec![[0.0; 2]; right.len()];
    if size == 0.0 {
        return (x, 0);
    }
    let scaled =
        |v: &[Vector], by: f64| -> Field { v.iter().map(|v| [v[0] / by, v[1] / by]).collect() };
    let mut basis = vec![scaled(right, size)];
    let mut searched: Vec<Field> = Vec::new();
    // Columns of the triangular factor, the rotations that made it, and the rotated right-hand
    // side.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut turns: Vec<[f64; 2]> = Vec::new();
    let mut rest = vec![size];
    for k in 0..most {
        searched.push(about_inverse(&basis[k]));
        let mut next = map(&searched[k]);
        let mut column = Vec::with_capacity(k + 2);
        for v in &basis {
            let part = dot(&next, v);
            add(&mut next, -part, v);
            column.push(part);
        }
        let left = dot(&next, &next).sqrt();
        column.push(left);
        for (i, [c, s]) in turns.iter().enumerate() {
            let [a, b] = [column[i], column[i + 1]];
            (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
        }
        let radius = column[k].hypot(column[k + 1]);
        if radius == 0.0 {
            break;
        }
        let [c, s] = [column[k] / radius, column[k + 1] / radius];
        (column[k], column[k + 1]) = (radius, 0.0);
        turns.push([c, s]);
        let last = rest[k];
        rest[k] = c * last;
        rest.push(-s * last);
        columns.push(column);
        if rest[k + 1].abs() <= tolerance * size || left <= 1e-14 * size {
            break;
        }
        basis.push(scaled(&next, left));
    }
    let n = columns.len();
    let mut factors = vec![0.0; n];
    for i in (0..n).rev() {
        let later: f64 = (i + 1..n).map(|j| columns[j][i] * factors[j]).sum();
        factors[i] = (rest[i] - later) / columns[i][i];
        add(&mut x, factors[i], &searched[i]);
    }
    (x, n)
}
