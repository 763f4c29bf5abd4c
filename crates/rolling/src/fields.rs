//! Fields of vectors over the cells of a patch, row by row.

/// Components along x and y.
pub type Vector = [f64; 2];

/// A vector for each cell.
pub type Field = Vec<Vector>;

/// Returns the sum of the products of two fields.
pub fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| a[0] * b[0] + a[1] * b[1])
        .sum()
}

/// Adds a multiple of a field to another one.
pub fn add(to: &mut [Vector], factor: f64, other: &[Vector]) {
    for (to, other) in to.iter_mut().zip(other) {
        to[0] += factor * other[0];
        to[1] += factor * other[1];
    }
}

/// Returns the length of a vector.
pub fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}
