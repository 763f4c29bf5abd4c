//! Contact of two convex polygons: the side with the greatest separation, and the opposite side
//! clipped to it.
//!
//! The distance of two disjoint polygons is the greatest separation over all directions (separating
//! axes). It occurs either along the normal of a side, and then the opposite side clipped to that
//! side gives one or two points, or between two corners, and then there is one point. Points are
//! named after their corners, so that the names do not change when the two sides exchange roles.

use super::polygon::Polygon;
use super::{ContactPoint, CorePair, PairFace};
use crate::geometry::space::Dim2;
use nalgebra::Vector2;

type V = Vector2<f64>;

/// Finds the contact points of two polygons, in the order of their features.
pub fn contact_points(pair: &CorePair<Dim2>, out: &mut Vec<ContactPoint<V>>) {
    let ([a, b], apart) = (pair.cores, &pair.apart);
    let (roundings, tolerances) = (pair.roundings, &pair.tolerances);
    let reach = tolerances.reach + roundings[0] + roundings[1];
    let (from_a, side_a) = separation(a, b, &-apart);
    if from_a > reach {
        return;
    }
    let (from_b, side_b) = separation(b, a, apart);
    if from_b > reach {
        return;
    }
    // If two sides are equally good, that of the candidate is used, independent of rounding.
    let a_leads = from_a + tolerances.slack * 1e-3 >= from_b;
    let best = if a_leads { from_a } else { from_b };
    let on_side = |slack: f64| {
        if a_leads {
            lies_on_side(a, b, side_a, &-apart, best, slack)
        } else {
            lies_on_side(b, a, side_b, apart, best, slack)
        }
    };
    if best > 0.0 && !tolerances.held && !on_side(tolerances.slack) {
        let rounding = a.rounding(b, apart);
        let (i, j, d) = nearest_corners(a, b, apart, side_b, rounding);
        let (distance, slack) = (d.norm(), tolerances.slack);
        let corner = distance * distance - best * best > slack * slack;
        let nearer = |of, to, apart: &V, side| is_nearer(of, to, apart, side, distance, rounding);
        if corner && !nearer(a, b, &-apart, side_a) && !nearer(b, a, apart, side_b) {
            if distance <= reach {
                let normal = d / distance;
                let (pa, pb) = (a.points()[i] + apart, b.points()[j]);
                out.push(ContactPoint {
                    on_candidate: pa - normal * roundings[0],
                    on_antagonist: pb + normal * roundings[1],
                    normal,
                    gap: distance - roundings[0] - roundings[1],
                    feature: name(i, true),
                    share: 0.0,
                    facing: a.points().len() == 2 || b.points().len() == 2,
                });
            }
            return;
        }
    }
    let face = PairFace {
        of_candidate: a_leads,
        face: if a_leads { side_a } else { side_b },
    };
    points_on_side(pair, face, out);
}

/// Finds the points of a pair that touch the line of a side of one of the two: the opposite side
/// clipped to it.
pub fn points_on_side(pair: &CorePair<Dim2>, face: PairFace, out: &mut Vec<ContactPoint<V>>) {
    let (a_leads, side) = (face.of_candidate, face.face);
    let ([a, b], [one, two], apart) = (pair.cores, pair.roundings, pair.apart);
    let first = out.len();
    let (lead, other, at_lead, at_other) = if a_leads {
        (a, b, apart, V::zeros())
    } else {
        (b, a, V::zeros(), apart)
    };
    let (lead_rounding, other_rounding) = if a_leads { (one, two) } else { (two, one) };
    let tolerances = &pair.tolerances;
    let normal = lead.normals()[side];
    let ends = clip(lead, other, side, &(at_other - at_lead), tolerances.slack);
    let along = ends.as_slice().len() == 2 && other.faces(&normal);
    let facing = along || lead.points().len() == 2 || other.points().len() == 2;
    for point in ends.as_slice() {
        let gap = point.height - lead_rounding - other_rounding;
        if gap > tolerances.reach {
            continue;
        }
        let on_other = at_lead + point.at - normal * other_rounding;
        let on_lead = at_lead + point.at - normal * (point.height - lead_rounding);
        let feature = name(point.corner, point.of_lead == a_leads);
        let (on_candidate, on_antagonist, normal) = if a_leads {
            (on_lead, on_other, -normal)
        } else {
            (on_other, on_lead, normal)
        };
        out.push(ContactPoint {
            on_candidate,
            on_antagonist,
            normal,
            gap,
            feature,
            share: point.share,
            facing,
        });
    }
    out[first..].sort_by_key(|m| m.feature);
}

/// Returns the name of a corner of the candidate or the antagonist.
pub(super) fn name(corner: usize, of_candidate: bool) -> u64 {
    2 * corner as u64 + u64::from(!of_candidate)
}

/// Returns the greatest separation along a side of `of`, and that side; `to` is at `apart` relative
/// to it.
///
/// A side is at most as far from `to` as from its centre, less the radius of a circle within it:
/// only those that may be the best are compared with all corners, first the one that faces the
/// centre.
fn separation(of: &Polygon, to: &Polygon, apart: &V) -> (f64, usize) {
    let (points, normals) = (of.points(), of.normals());
    let heights = |k: usize| (apart - points[k]).dot(&normals[k]);
    let full = |k: usize, height: f64| {
        let n = normals[k];
        let along = to.points().iter().map(|p| p.dot(&n));
        along.fold(f64::INFINITY, |low, x| if x < low { x } else { low }) + height
    };
    let (mut first, mut highest, mut second) = (0, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for k in 0..normals.len() {
        let height = heights(k);
        if height > highest {
            (first, highest, second) = (k, height, highest);
        } else if height > second {
            second = height;
        }
    }
    let (mut best, inner) = ((full(first, highest), first), to.inner());
    if second - inner < best.0 {
        return best;
    }
    for k in 0..normals.len() {
        let height = heights(k);
        if k == first || height - inner < best.0 {
            continue;
        }
        let s = full(k, height);
        // The first of equal ones is taken.
        if s > best.0 || (s == best.0 && k < best.1) {
            best = (s, k);
        }
    }
    best
}

/// Returns whether a corner of `to` lies before the inside of a side of `of` and not farther than
/// two corners can be from each other where they define no direction: then none are nearer.
fn lies_on_side(of: &Polygon, to: &Polygon, k: usize, apart: &V, best: f64, slack: f64) -> bool {
    let (from, end) = of.side(k);
    let (along, normal) = (end - from, of.normals()[k]);
    to.points().iter().any(|p| {
        let d = p + apart - from;
        let (s, height) = (d.dot(&along), d.dot(&normal).abs());
        let near = height * height - best * best <= slack * slack;
        near && s > 0.0 && s < along.norm_squared()
    })
}

/// Returns the two nearest corners and the vector from that of `b` to that of `a`. A corner is at
/// least as far from `b` as from the line through a side of it.
fn nearest_corners(
    a: &Polygon,
    b: &Polygon,
    apart: &V,
    side: usize,
    rounding: f64,
) -> (usize, usize, V) {
    let (from, normal) = (b.points()[side], b.normals()[side]);
    let height = |p: &V| (p + apart - from).dot(&normal);
    let (mut lowest, mut least) = (a.points()[0], f64::INFINITY);
    for p in a.points() {
        let height = height(p);
        if height < least {
            (lowest, least) = (*p, height);
        }
    }
    let squared = b
        .points()
        .iter()
        .map(|q| (lowest + apart - q).norm_squared());
    let limit = squared.fold(f64::INFINITY, f64::min).sqrt() + rounding;
    let mut best = (0, 0, V::repeat(f64::INFINITY));
    let mut nearest = f64::INFINITY;
    for (i, p) in a.points().iter().enumerate() {
        if height(p) > limit {
            continue;
        }
        for (j, q) in b.points().iter().enumerate() {
            let d = p + apart - q;
            let squared = d.norm_squared();
            if squared < nearest {
                (best, nearest) = ((i, j, d), squared);
            }
        }
    }
    best
}

/// Returns whether the inside of a side of `of` is as near to a corner of `to` as `distance` (m). A
/// corner is at least as far from `of` as from the line through one of its sides.
fn is_nearer(
    of: &Polygon,
    to: &Polygon,
    apart: &V,
    side: usize,
    distance: f64,
    rounding: f64,
) -> bool {
    let (origin, normal) = (of.points()[side], of.normals()[side]);
    let limit = distance + rounding;
    let near = |p: &&V| (*p + apart - origin).dot(&normal) <= limit;
    to.points().iter().filter(near).any(|p| {
        (0..of.points().len()).any(|k| {
            let (from, end) = of.side(k);
            let along = end - from;
            let d = p + apart - from;
            let s = d.dot(&along);
            s > 0.0 && s < along.norm_squared() && d.dot(&of.normals()[k]).abs() <= distance
        })
    })
}

/// An end of the overlap of two sides.
struct OverlapEnd {
    /// Position on the other side, relative to the reference polygon's centre (m).
    at: V,
    /// Height above the reference side (m).
    height: f64,
    /// The corner at the end.
    corner: usize,
    /// Whether the corner belongs to the reference polygon.
    of_lead: bool,
    share: f64,
}

/// One or two ends of an overlap.
enum OverlapEnds {
    One(OverlapEnd),
    Two([OverlapEnd; 2]),
}

impl OverlapEnds {
    fn as_slice(&self) -> &[OverlapEnd] {
        match self {
            Self::One(end) => std::slice::from_ref(end),
            Self::Two(ends) => ends,
        }
    }
}

/// Clips the side of `other` opposite a side of `lead` to that side; returns its ends.
fn clip(lead: &Polygon, other: &Polygon, side: usize, apart: &V, slack: f64) -> OverlapEnds {
    let normal = lead.normals()[side];
    let (from, to) = lead.side(side);
    let length = (to - from).norm();
    let along = (to - from) / length;
    let n = other.points().len();
    let facing = other.facing(&normal);
    // Opposed to the direction of the reference side: the second end comes first.
    let place = |corner: usize| {
        let p = other.points()[corner] + apart;
        ((p - from).dot(&along), p, corner)
    };
    let next = if facing + 1 == n { 0 } else { facing + 1 };
    let (low, high) = (place(next), place(facing));
    let (low, high) = if low.0 <= high.0 {
        (low, high)
    } else {
        (high, low)
    };
    let height = |p: &V| (p - from).dot(&normal);
    let of_other = |end: (f64, V, usize)| OverlapEnd {
        at: end.1,
        height: height(&end.1),
        corner: end.2,
        of_lead: false,
        share: 0.0,
    };
    // Returns the point of the opposite side above a corner of the reference side.
    let over = |t: f64, corner: usize| {
        let s = ((t - low.0) / (high.0 - low.0)).clamp(0.0, 1.0);
        let at = low.1 + (high.1 - low.1) * s;
        OverlapEnd {
            at,
            height: height(&at),
            corner,
            of_lead: true,
            share: 0.0,
        }
    };
    let (left, right) = (low.0.max(0.0), high.0.min(length));
    if right - left <= slack {
        // Corner on corner, or a side seen end-on: the lower one.
        let lower = if height(&low.1) <= height(&high.1) {
            low
        } else {
            high
        };
        let inside = lower.0 >= -slack && lower.0 <= length + slack;
        return if inside || high.0 <= low.0 {
            OverlapEnds::One(of_other(lower))
        } else if lower.0 < 0.0 {
            OverlapEnds::One(over(0.0, side))
        } else {
            OverlapEnds::One(over(length, (side + 1) % lead.points().len()))
        };
    }
    let mut ends = [
        if low.0 >= 0.0 {
            of_other(low)
        } else {
            over(0.0, side)
        },
        if high.0 <= length {
            of_other(high)
        } else {
            over(length, (side + 1) % lead.points().len())
        },
    ];
    for end in &mut ends {
        end.share = 0.5 * (right - left);
    }
    OverlapEnds::Two(ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::convex::{ContactTolerances, Core};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    const EXACT: ContactTolerances = ContactTolerances {
        reach: 1e9,
        slack: 0.0,
        held: false,
    };

    fn met(a: &Polygon, b: &Polygon, apart: V, roundings: [f64; 2]) -> Vec<ContactPoint<V>> {
        found(a, b, apart, roundings, EXACT)
    }

    fn found(
        a: &Polygon,
        b: &Polygon,
        apart: V,
        roundings: [f64; 2],
        tolerances: ContactTolerances,
    ) -> Vec<ContactPoint<V>> {
        let mut out = Vec::new();
        let pair = CorePair {
            cores: [a, b],
            apart,
            roundings,
            tolerances,
        };
        contact_points(&pair, &mut out);
        out
    }

    /// Returns a random convex polygon with corners on an ellipse.
    fn random(rng: &mut Pcg64) -> Polygon {
        loop {
            let n = rng.random_range(3..9);
            let mut angles: Vec<f64> = (0..n)
                .map(|_| rng.random_range(0.0..std::f64::consts::TAU))
                .collect();
            angles.sort_by(f64::total_cmp);
            let flat = rng.random_range(0.2..1.0);
            let points = angles
                .iter()
                .map(|a| V::new(a.cos(), flat * a.sin()))
                .collect();
            if let Ok(polygon) = Polygon::new(points) {
                return polygon.turned(&rng.random_range(0.0..6.0));
            }
        }
    }

    /// Returns the distance of two disjoint polygons from every pair of sides.
    fn brute(a: &Polygon, b: &Polygon, apart: V) -> f64 {
        let mut best = f64::INFINITY;
        let mut one = |p: V, (from, to): (V, V)| {
            let along = to - from;
            let s = ((p - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            best = best.min((p - from - along * s).norm());
        };
        for i in 0..a.points().len() {
            for j in 0..b.points().len() {
                one(a.points()[i] + apart, b.side(j));
                one(b.points()[j] - apart, a.side(i));
            }
        }
        best
    }

    #[test]
    fn gaps_and_normals_are_those_of_the_nearest_points() {
        let mut rng = Pcg64::seed_from_u64(5);
        let (mut corners, mut sides) = (0, 0);
        for _ in 0..20_000 {
            let (a, b) = (random(&mut rng), random(&mut rng));
            let direction = rng.random_range(0.0..std::f64::consts::TAU);
            let apart =
                V::new(f64::cos(direction), f64::sin(direction)) * rng.random_range(1.0..3.0);
            let (one, two) = (separation(&a, &b, &-apart).0, separation(&b, &a, &apart).0);
            let r = [0.1, 0.05];
            let points = met(&a, &b, apart, r);
            let gap = points.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
            if one.max(two) <= 1e-9 {
                // For penetration: the smallest depth along any side's normal.
                assert!(
                    (gap + 0.15 - one.max(two)).abs() < 1e-12,
                    "{gap} {one} {two}"
                );
                continue;
            }
            let distance = brute(&a, &b, apart);
            assert!((gap + 0.15 - distance).abs() < 1e-12, "{gap} {distance}");
            let nearest = points
                .iter()
                .min_by(|x, y| x.gap.total_cmp(&y.gap))
                .unwrap();
            // The distance of the two contact points is the gap, along the normal.
            let way = nearest.on_candidate - nearest.on_antagonist;
            assert!((way - nearest.normal * gap).norm() < 1e-12);
            assert!((nearest.normal.norm() - 1.0).abs() < 1e-12);
            if points.len() == 1 && nearest.share == 0.0 {
                corners += 1;
            } else {
                sides += 1;
            }
        }
        assert!(corners > 1000 && sides > 1000, "{corners} {sides}");
    }

    #[test]
    fn a_pair_is_the_same_seen_from_the_other_side() {
        let mut rng = Pcg64::seed_from_u64(6);
        for _ in 0..5000 {
            let (a, b) = (random(&mut rng), random(&mut rng));
            let apart = V::new(rng.random_range(-2.0..2.0), rng.random_range(-2.0..2.0));
            let (one, two) = (met(&a, &b, apart, [0.0; 2]), met(&b, &a, -apart, [0.0; 2]));
            assert_eq!(one.len(), two.len());
            for m in &one {
                let other = two.iter().find(|o| o.feature == m.feature ^ 1);
                let Some(other) = other.or((one.len() == 1).then(|| &two[0])) else {
                    panic!("{one:?} {two:?}");
                };
                assert!((other.normal + m.normal).norm() < 1e-9);
                assert!((other.gap - m.gap).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn stacked_boxes_touch_at_two_points_with_half_the_face_each() {
        let of = |w: f64, h: f64| {
            Polygon::new(vec![
                V::new(-w, -h),
                V::new(w, -h),
                V::new(w, h),
                V::new(-w, h),
            ])
            .unwrap()
        };
        let (top, low) = (of(1.0, 1.0), of(3.0, 1.0));
        let points = met(&top, &low, V::new(0.5, 2.25), [0.1, 0.1]);
        assert_eq!(points.len(), 2);
        for p in &points {
            assert_eq!(p.normal, V::new(0.0, 1.0));
            assert!((p.gap - 0.05).abs() < 1e-14 && (p.share - 1.0).abs() < 1e-14);
        }
        // Sides of equal width: no corner is outside the other side by more than the slack.
        let tolerances = ContactTolerances {
            reach: 0.1,
            slack: 1e-6,
            held: false,
        };
        for shift in [0.0, 1e-12, -1e-9, 5e-7] {
            for gap in [-1e-9, 0.0, 1e-13, 1e-9, 0.05] {
                let out = found(&top, &top, V::new(shift, 2.0 + gap), [0.0; 2], tolerances);
                assert_eq!(out.len(), 2, "{shift:e} {gap:e}");
                assert!(out.iter().all(|m| (m.normal.y - 1.0).abs() < 1e-15));
                assert!(out.iter().all(|m| (m.gap - gap).abs() < 1e-15));
            }
        }
        // Next to each other's corners: one point, along the line between the corners.
        let out = found(&top, &top, V::new(2.03, 2.04), [0.0; 2], tolerances);
        assert_eq!(out.len(), 1);
        assert!((out[0].gap - 0.05).abs() < 1e-14);
        assert!((out[0].normal - V::new(0.6, 0.8)).norm() < 1e-12);
    }

    /// Opened obliquely about a corner that has slid past the other's end, two corners are nearest;
    /// a bond over the face still needs its two points.
    #[test]
    fn what_a_bond_holds_keeps_its_face() {
        let square = |turn: f64| {
            let of = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let polygon = Polygon::new(of.map(|c| V::new(c.0, c.1)).to_vec()).unwrap();
            polygon.turned(&turn)
        };
        let (low, top) = (square(0.0), square(-0.05));
        // The lower right corner of the upper square is 0.02 above and 5e-4 beyond that of the
        // lower one.
        let right = top.points()[1];
        let apart = V::new(1.0 + 5e-4, 1.0 + 0.02) - right;
        for held in [false, true] {
            let tolerances = ContactTolerances {
                reach: 0.5,
                slack: 1e-6,
                held,
            };
            let out = found(&top, &low, apart, [0.0; 2], tolerances);
            assert_eq!(out.len(), 1 + usize::from(held), "{out:?}");
            let share: f64 = out.iter().map(|m| m.share).sum();
            assert!(!held || (share - 2.0).abs() < 0.01, "{share}");
            assert!(out.iter().all(|m| m.facing == held));
        }
    }

    #[test]
    fn capsules_side_by_side_and_crossed() {
        let lying = Polygon::segment(V::new(-1.0, 0.0), V::new(1.0, 0.0));
        let points = met(&lying, &lying, V::new(0.5, 0.25), [0.1, 0.1]);
        assert_eq!(points.len(), 2);
        assert!(points.iter().all(|m| (m.gap - 0.05).abs() < 1e-15));
        let standing = lying.turned(&std::f64::consts::FRAC_PI_2);
        let points = met(&standing, &lying, V::new(0.2, 1.3), [0.1, 0.1]);
        let least = points.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
        assert!((least - 0.1).abs() < 1e-15);
        // End to end.
        let points = met(&lying, &lying, V::new(2.3, 0.4), [0.1, 0.1]);
        assert!(points.len() == 1 && (points[0].gap - 0.3).abs() < 1e-15);
    }
}
