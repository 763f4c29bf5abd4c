//! Outlines of convex parts with rounded edges.

use fretwork_store::results::shapes::ShapedPiece;
use std::f64::consts::{PI, TAU};

/// Angle between two corners of a rounded edge (rad).
const FINE: f64 = PI / 8.0;

/// The outline of a part in the plane, anticlockwise, about its centre.
pub(super) fn flat(piece: &ShapedPiece) -> Vec<[f64; 3]> {
    let corners = &piece.corners;
    let n = corners.len();
    if piece.rounding <= 0.0 || n < 2 {
        return corners.clone();
    }
    let outward = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).atan2(b[1] - a[1]);
    let mut out = Vec::new();
    for k in 0..n {
        let (before, here, after) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
        // Angles of the normals of both sides, from the one before to the one after.
        let (from, to) = (outward(here, before), outward(after, here));
        let (from, to) = (from + PI, to + PI);
        let turn = (to - from).rem_euclid(TAU);
        let steps = (turn / FINE).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let (sin, cos) = (from + turn * step as f64 / steps as f64).sin_cos();
            out.push([
                here[0] + piece.rounding * cos,
                here[1] + piece.rounding * sin,
                0.0,
            ]);
        }
    }
    out
}

/// The faces of a part in space as triangles about its centre, moved outwards by the rounding.
pub(super) fn solid(piece: &ShapedPiece) -> Vec<[f64; 3]> {
    if piece.faces.is_empty() {
        return capsule(piece);
    }
    let mut out = Vec::new();
    for face in &piece.faces {
        let corners: Vec<[f64; 3]> = face
            .iter()
            .filter_map(|k| piece.corners.get(*k as usize).copied())
            .collect();
        let shift = if piece.rounding > 0.0 {
            normal(&corners).map(|x| x * piece.rounding)
        } else {
            [0.0; 3]
        };
        let moved = |c: [f64; 3]| [c[0] + shift[0], c[1] + shift[1], c[2] + shift[2]];
        for k in 2..corners.len() {
            out.extend([corners[0], corners[k - 1], corners[k]].map(moved));
        }
    }
    out
}

/// Unit normal of a face.
fn normal(corners: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        sum[0] += (a[1] - b[1]) * (a[2] + b[2]);
        sum[1] += (a[2] - b[2]) * (a[0] + b[0]);
        sum[2] += (a[0] - b[0]) * (a[1] + b[1]);
    }
    let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    sum.map(|x| if size > 0.0 { x / size } else { 0.0 })
}

/// A capsule between its two corners, or a ball about one.
fn capsule(piece: &ShapedPiece) -> Vec<[f64; 3]> {
    let (Some(a), Some(b)) = (piece.corners.first(), piece.corners.last()) else {
        return Vec::new();
    };
    let axis: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along = if length > 0.0 {
        axis.map(|x| x / length)
    } else {
        [0.0, 0.0, 1.0]
    };
    let thin = (0..3)
        .min_by(|i, j| along[*i].abs().total_cmp(&along[*j].abs()))
        .unwrap_or(0);
    let mut other = [0.0; 3];
    other[thin] = 1.0;
    let across = unit(cross(along, other));
    let third = cross(along, across);
    // Rings from one end to the other: half a circle about each corner.
    let ring = |i: usize| {
        let angle = -PI / 2.0 + PI * (if i < 5 { i } else { i - 1 }) as f64 / 8.0;
        let centre = if i < 5 { a } else { b };
        let (sin, cos) = angle.sin_cos();
        (0..=12).map(move |j| {
            let (s, c) = (TAU * f64::from(j) / 12.0).sin_cos();
            std::array::from_fn::<f64, 3, _>(|k| {
                centre[k] + piece.rounding * (sin * along[k] + cos * (c * across[k] + s * third[k]))
            })
        })
    };
    let rings: Vec<Vec<[f64; 3]>> = (0..10).map(|i| ring(i).collect()).collect();
    let mut out = Vec::new();
    for pair in rings.windows(2) {
        for j in 0..12 {
            let [p, q, r, s] = [pair[0][j], pair[0][j + 1], pair[1][j], pair[1][j + 1]];
            out.extend([p, q, s, p, s, r]);
        }
    }
    out
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(corners: Vec<[f64; 3]>, faces: Vec<Vec<u32>>, rounding: f64) -> ShapedPiece {
        ShapedPiece {
            body: 0,
            rounding,
            size: 1.0,
            offset: [0.0; 3],
            corners,
            faces,
        }
    }

    #[test]
    fn a_rounded_square_has_the_area_of_its_offset() {
        let square = vec![
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ];
        let area = |points: &[[f64; 3]]| {
            let pairs = points.iter().zip(points.iter().cycle().skip(1));
            pairs
                .map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0]))
                .sum::<f64>()
        };
        assert_eq!(area(&flat(&piece(square.clone(), vec![], 0.0))), 4.0);
        let rounded = area(&flat(&piece(square, vec![], 0.5)));
        let exact = 4.0 + 4.0 * 2.0 * 0.5 + PI * 0.25;
        assert!((rounded - exact).abs() < 0.03 * exact, "{rounded} {exact}");
        // A capsule in the plane is the same from two corners.
        let rod = vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let (rod, exact) = (area(&flat(&piece(rod, vec![], 0.5))), 2.0 + PI * 0.25);
        assert!((rod - exact).abs() < 0.03 * exact, "{rod} {exact}");
    }

    #[test]
    fn the_surface_of_a_capsule_is_at_its_radius() {
        let rod = piece(vec![[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], vec![], 0.5);
        let corners = solid(&rod);
        assert!(corners.len() > 300);
        for c in corners {
            let beyond = (c[2].abs() - 1.0).max(0.0);
            let distance = (c[0] * c[0] + c[1] * c[1] + beyond * beyond).sqrt();
            assert!((distance - 0.5).abs() < 1e-9, "{c:?}");
        }
    }
}
