//! Two convex polygons along the line through a side of one of them.

use super::polygon_pair::{name, points_on_side};
use super::{ContactPoint, CorePair, PairFace};
use crate::geometry::space::Dim2;
use nalgebra::Vector2;

type V = Vector2<f64>;

/// Finds the points of a pair that touch the line of a side of one of the two: the opposite side
/// clipped to it, and its lowest corner where that is beside the side and lower.
pub fn points_on_line(pair: &CorePair<Dim2>, face: PairFace, out: &mut Vec<ContactPoint<V>>) {
    let first = out.len();
    points_on_side(pair, face, out);
    let of_candidate = face.of_candidate;
    let ([a, b], apart) = (pair.cores, pair.apart);
    let (own, other, sign) = if of_candidate {
        (a, b, -1.0)
    } else {
        (b, a, 1.0)
    };
    let normal = own.normals()[face.face];
    // Positions are relative to the centre of the side's polygon.
    let along = |p: &V| (p + apart * sign - own.points()[face.face]).dot(&normal);
    let heights = other.points().iter().map(along).enumerate();
    let Some((corner, height)) = heights.min_by(|x, y| x.1.total_cmp(&y.1)) else {
        return;
    };
    let (roundings, tolerances) = (pair.roundings, &pair.tolerances);
    let gap = height - roundings[0] - roundings[1];
    let lower = out[first..].iter().all(|m| m.gap > gap + tolerances.slack);
    if !lower || gap > tolerances.reach {
        return;
    }
    let [own_rounding, other_rounding] = if of_candidate {
        roundings
    } else {
        [roundings[1], roundings[0]]
    };
    let origin = if of_candidate { V::zeros() } else { apart };
    let at = other.points()[corner] + origin;
    let on_other = at - normal * other_rounding;
    let on_own = at - normal * (height - own_rounding);
    let [on_candidate, on_antagonist] = if of_candidate {
        [on_own, on_other]
    } else {
        [on_other, on_own]
    };
    out.push(ContactPoint {
        on_candidate,
        on_antagonist,
        normal: normal * sign,
        gap,
        feature: name(corner, !of_candidate),
        share: 0.0,
        facing: false,
    });
    out[first..].sort_by_key(|m| m.feature);
}
