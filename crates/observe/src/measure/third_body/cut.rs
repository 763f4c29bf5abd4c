//! Volume fraction of a grain below a depth.
//!
//! Exact for disks (circular segments) and balls (spherical segments). A convex polygon is clipped;
//! its area is distributed in proportion to its outline, in which rounded corners are polygonal
//! too. A polyhedron is treated as the ball of the same volume.

use super::gap::Gap;
use crate::measure::Grain;
use crate::measure::ball::volume_below;
use fretwork_core::geometry::space::ball_volume;
use fretwork_core::view::RunView;

/// Distributes a grain's volume over the cells of the gap.
pub(super) fn share(run: &dyn RunView, gap: &Gap, grain: &Grain, take: impl FnMut(usize, f64)) {
    let depth = gap.depth(&grain.at.into());
    match grain.piece.filter(|_| run.dimension() == 2) {
        None => {
            let (r, whole) = (grain.radius, ball_volume(run.dimension(), grain.radius));
            let cut = |d: f64| volume_below(run.dimension(), r, d - depth) / whole;
            gap.share(depth - r, depth + r, cut, take);
        }
        Some((piece, _)) => {
            let corners = run.piece_outline(piece).concat();
            let along = 1 - gap.across;
            let place = |c: &[f64; 3]| [c[along], depth + gap.side * c[gap.across]];
            let corners: Vec<[f64; 2]> = corners.iter().map(place).collect();
            let low = corners.iter().map(|c| c[1]).fold(f64::INFINITY, f64::min);
            let high = corners
                .iter()
                .map(|c| c[1])
                .fold(f64::NEG_INFINITY, f64::max);
            let whole = area_below(&corners, f64::INFINITY);
            gap.share(low, high, |d| area_below(&corners, d) / whole, take);
        }
    }
}

/// Returns the area of the part of a convex polygon below a height.
fn area_below(corners: &[[f64; 2]], height: f64) -> f64 {
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(corners.len() + 2);
    for (k, b) in corners.iter().enumerate() {
        let a = &corners[(k + corners.len() - 1) % corners.len()];
        if (a[1] <= height) != (b[1] <= height) {
            let t = (height - a[1]) / (b[1] - a[1]);
            kept.push([a[0] + t * (b[0] - a[0]), height]);
        }
        if b[1] <= height {
            kept.push(*b);
        }
    }
    let Some(o) = kept.first().copied() else {
        return 0.0;
    };
    let triangles = kept.windows(2).map(|p| {
        let [a, b] = [p[0], p[1]].map(|c| [c[0] - o[0], c[1] - o[1]]);
        0.5 * (a[0] * b[1] - a[1] * b[0])
    });
    triangles.sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_on_its_corner_is_cut_by_triangles() {
        let square = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
        for (height, area) in [
            (-1.5, 0.0),
            (-0.5, 0.25),
            (0.0, 1.0),
            (0.5, 1.75),
            (2.0, 2.0),
        ] {
            assert!(
                (area_below(&square, height) - area).abs() < 1e-15,
                "{height}"
            );
        }
    }
}
