//! Contact of a convex polygon and a surface of a first body: the polygon's corners on the
//! surface's faces and corners, and the surface's corners on the polygon's sides.

use super::polygon::Polygon;
use super::{ContactPoint, ContactTolerances, MAX_CORNER_DEPTH, STEEPEST};
use crate::geometry::shape::{ClosestPoint, Surface};
use crate::geometry::space::Dim2;
use nalgebra::Vector2;

type V = Vector2<f64>;

/// Tolerance for a normal outside a corner's cone.
const CONE: f64 = 1e-9;
/// Two faces of a profile give one contact point if their points are closer than this fraction of
/// the search distance.
const SEAM: f64 = 1e-9;

/// Finds the contact points of the polygon, centred at `at` in the surface's frame, in the order of
/// their features.
pub fn contact_points(
    polygon: &Polygon,
    surface: &dyn Surface<Dim2>,
    at: &V,
    rounding: f64,
    tolerances: &ContactTolerances,
    out: &mut Vec<ContactPoint<V>>,
) {
    let first = out.len();
    let reach = tolerances.reach + rounding;
    let deep = reach.max(MAX_CORNER_DEPTH * (polygon.farthest() + rounding));
    let n = polygon.points().len();
    let mut closest_points: Vec<ClosestPoint<V>> = Vec::new();
    for (k, point) in polygon.points().iter().enumerate() {
        let p = point + at;
        closest_points.clear();
        surface.closest_points(&p, deep, &mut closest_points);
        keep_nearest(&mut closest_points, reach);
        for (t, closest) in closest_points.iter().enumerate() {
            // At a seam both faces give the same point.
            let same = |other: &ClosestPoint<V>| {
                (other.closest_point - closest.closest_point).norm() <= SEAM * reach
                    && other.normal.dot(&closest.normal) >= 1.0 - SEAM
            };
            if closest_points[..t].iter().any(same) {
                continue;
            }
            // Corners of the opposite side, or a corner that points to the surface.
            let facing = polygon.facing(&closest.normal);
            if k != facing && k != (facing + 1) % n {
                continue;
            }
            let (from, to) = polygon.side(facing);
            out.push(ContactPoint {
                on_candidate: p - closest.normal * rounding,
                on_antagonist: closest.closest_point,
                normal: closest.normal,
                gap: closest.distance - rounding,
                feature: ((u64::from(closest.feature) << 24) | k as u64) << 1,
                share: 0.5 * (to - from).norm(),
                facing: polygon.faces(&closest.normal),
            });
        }
    }
    let extent = V::repeat(polygon.farthest() + reach);
    let mut corners = Vec::new();
    surface.corners(&(at - extent), &(at + extent), &mut corners);
    for corner in &corners {
        let (distance, outward, own) = polygon.distance(&(corner.at - at));
        // Corner on corner was found above.
        if own.is_some() || distance > reach {
            continue;
        }
        let normal = -outward;
        let [before, after] = corner.normals;
        let mean = before + after;
        let faces = if surface.deforms() {
            normal.dot(&mean) > STEEPEST * mean.norm()
        } else {
            let inside = before.perp(&normal) <= CONE && normal.perp(&after) <= CONE;
            inside && normal.dot(&mean) > 0.0
        };
        if !faces {
            continue;
        }
        out.push(ContactPoint {
            on_candidate: corner.at - outward * (distance - rounding),
            on_antagonist: corner.at,
            normal,
            gap: distance - rounding,
            feature: (u64::from(corner.feature) << 1) | 1,
            share: 0.0,
            facing: n == 2,
        });
    }
    out[first..].sort_by_key(|m| m.feature);
}

/// Keeps the points of a corner within the search distance. If there are none, the corner may have
/// penetrated deeper within a step: then keeps the nearest point if the corner is behind it. A
/// corner near a thin part is far behind its other side.
fn keep_nearest(closest_points: &mut Vec<ClosestPoint<V>>, reach: f64) {
    let depth = |t: &ClosestPoint<V>| t.distance.abs();
    let nearest = closest_points
        .iter()
        .map(depth)
        .fold(f64::INFINITY, f64::min);
    if nearest < reach {
        closest_points.retain(|t| depth(t) < reach);
    } else {
        closest_points.retain(|t| t.distance < 0.0 && depth(t) == nearest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polyline::Polyline;
    use crate::geometry::shape::HalfSpace;

    const GAUGE: ContactTolerances = ContactTolerances {
        reach: 0.2,
        slack: 1e-4,
        held: false,
    };

    fn square() -> Polygon {
        Polygon::new(vec![
            V::new(-1.0, -1.0),
            V::new(1.0, -1.0),
            V::new(1.0, 1.0),
            V::new(-1.0, 1.0),
        ])
        .unwrap()
    }

    fn met(surface: &dyn Surface<Dim2>, polygon: &Polygon, at: V, r: f64) -> Vec<ContactPoint<V>> {
        let mut out = Vec::new();
        contact_points(polygon, surface, &at, r, &GAUGE, &mut out);
        out
    }

    #[test]
    fn a_box_lies_on_two_corners_of_a_floor() {
        let floor = HalfSpace::<Dim2> {
            normal: V::new(0.0, 1.0),
            shown: 1.0,
        };
        let points = met(&floor, &square(), V::new(7.0, 1.15), 0.1);
        assert_eq!(points.len(), 2);
        assert!(points.iter().all(|m| (m.gap - 0.05).abs() < 1e-15));
        assert!((points[0].on_candidate.y - 0.05).abs() < 1e-15);
        assert_eq!(points.iter().map(|m| m.feature).collect::<Vec<_>>(), [0, 2]);
    }

    #[test]
    fn a_box_slides_over_the_seams_of_a_flat_profile() {
        let points = (0..20).map(|k| V::new(f64::from(k), 0.0)).collect();
        let flat = Polyline::new(points, None).unwrap();
        for k in 0..200 {
            let at = V::new(3.0 + 0.0501 * f64::from(k), 0.99);
            let points = met(&flat, &square(), at, 0.0);
            assert_eq!(points.len(), 2, "{at:?} {points:?}");
            assert!(points.iter().all(|m| m.normal == V::new(0.0, 1.0)));
        }
    }

    #[test]
    fn a_box_on_a_ridge_touches_its_corner() {
        let ridge = Polyline::new(
            vec![V::new(-5.0, -2.0), V::new(0.0, 0.0), V::new(5.0, -2.0)],
            None,
        )
        .unwrap();
        let points = met(&ridge, &square(), V::new(0.4, 1.01), 0.0);
        assert_eq!(points.len(), 1, "{points:?}");
        assert_eq!(points[0].normal, V::new(0.0, 1.0));
        assert!((points[0].gap - 0.01).abs() < 1e-15);
        assert_eq!(points[0].on_antagonist, V::zeros());
    }

    #[test]
    fn corners_that_sank_in_within_a_step_are_found_and_those_before_a_thin_part_are_not() {
        let floor = Polyline::new(vec![V::new(-5.0, 0.0), V::new(5.0, 0.0)], None).unwrap();
        // Deeper than the search distance of 0.2, and than a quarter of the size, 0.25 sqrt(2).
        let sunk = met(&floor, &square(), V::new(0.4, 0.7), 0.0);
        assert_eq!(sunk.len(), 2, "{sunk:?}");
        assert!(sunk.iter().all(|m| (m.gap + 0.3).abs() < 1e-15));
        assert!(met(&floor, &square(), V::new(0.4, 0.6), 0.0).is_empty());
        // A fin 0.05 wide on the floor; the square is 0.25 to its left, 0.3 behind its right side.
        let fin = [
            (-5.0, -9.0),
            (2.0, -9.0),
            (2.0, 9.0),
            (2.05, 9.0),
            (2.05, -9.0),
            (5.0, -9.0),
        ];
        let fin = Polyline::new(fin.map(|(x, y)| V::new(x, y)).to_vec(), None).unwrap();
        assert!(met(&fin, &square(), V::new(0.75, 0.0), 0.0).is_empty());
        let near = met(&fin, &square(), V::new(0.85, 0.0), 0.0);
        assert_eq!(near.len(), 2, "{near:?}");
        assert!(near.iter().all(|m| m.normal == V::new(-1.0, 0.0)));
    }

    #[test]
    fn a_corner_below_a_valley_comes_out() {
        let turned = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let corner = |p: &V| V::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
            Polygon::new(square().points().iter().map(corner).collect()).unwrap()
        };
        for slope in [0.02, 0.1, 0.5, 0.9] {
            let points = vec![
                V::new(-9.0, 9.0 * slope),
                V::zeros(),
                V::new(9.0, 9.0 * slope),
            ];
            let valley = Polyline::new(points, None).unwrap();
            let quarter = std::f64::consts::FRAC_PI_4;
            for angle in [quarter, quarter + 0.03, quarter - 0.1] {
                let polygon = turned(angle);
                let low = polygon.points().iter().map(|p| p.y).fold(0.0, f64::min);
                let aside = polygon.points().iter().find(|p| p.y == low).unwrap().x;
                for k in 1..=34 {
                    let depth = 0.01 * f64::from(k);
                    let at = V::new(-aside, -low - depth);
                    let found = met(&valley, &polygon, at, 0.0);
                    let deepest = found.iter().map(|m| m.gap).fold(0.0, f64::min);
                    assert!(deepest < -0.7 * depth, "{slope} {angle} {depth}: {found:?}");
                    assert!(found.iter().all(|m| m.normal.y > 0.7), "{found:?}");
                }
            }
        }
    }
}
