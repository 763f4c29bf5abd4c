//! Outlines of convex parts with rounded edges.

use fretwork_core::geometry::convex::Boundary;
use fretwork_store::results::shapes::ShapedPiece;

/// Returns the outline of a part in 2D, counter-clockwise, about its centre.
pub(super) fn flat(piece: &ShapedPiece) -> Vec<[f64; 3]> {
    outline(piece, 2).concat()
}

/// Returns the faces of a part in 3D as triangles about its centre.
pub(super) fn solid(piece: &ShapedPiece) -> Vec<[f64; 3]> {
    let faces = outline(piece, 3).into_iter();
    let triangles = |face: Vec<[f64; 3]>| {
        let corners = (2..face.len()).flat_map(|k| [face[0], face[k - 1], face[k]]);
        corners.collect::<Vec<_>>()
    };
    faces.flat_map(triangles).collect()
}

/// Returns closed lines around a part or each of its faces; none if the shape of the part is
/// invalid.
fn outline(piece: &ShapedPiece, dimension: usize) -> Vec<Vec<[f64; 3]>> {
    let boundary = Boundary {
        corners: piece.corners.clone(),
        faces: piece.faces.clone(),
    };
    boundary.outline(dimension, piece.rounding)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rounded_square_is_drawn_with_its_rounding() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let square = ShapedPiece {
            body: 0,
            rounding: 0.5,
            size: 1.0,
            offset: [0.0; 3],
            corners: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
            faces: vec![],
        };
        let points = flat(&square);
        let pairs = points.iter().zip(points.iter().cycle().skip(1));
        let area: f64 = pairs.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum();
        let exact = 4.0 + 4.0 * 2.0 * 0.5 + std::f64::consts::PI * 0.25;
        assert!((area - exact).abs() < 0.01 * exact, "{area} {exact}");
    }
}
