//! Contact of two convex polyhedra: a face with the opposite face clipped to it, or the two nearest
//! points of edges and corners.
//!
//! The reference face is the one with the greatest separation. If the other polyhedron's lowest
//! point is above it, that separation is the distance, and the opposite face, clipped to the sides
//! of the reference face, gives the points. Otherwise two edges (including their corners) are
//! nearest, and there is one point. For penetrating polyhedra the normal is the axis of least depth
//! among face normals and edge products (separating axes); an edge pair counts if the normal cones
//! of both contain the axis (D. Gregorius, GDC 2013). Points are named after their corners and
//! edges, so that the names do not change when the two faces exchange roles.

use super::polyhedron::{Polyhedron, across};
use super::polyhedron_clip::{self, Lead, name};
use super::{ContactPoint, CorePair, PairFace};
use crate::geometry::space::Dim3;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Fraction of the slack within which two axes count as equally good.
const ALIKE: f64 = 1e-3;
/// Fraction of the distance of the centres that is added to the slack for rounding.
const ROUNDING: f64 = 1e-13;

/// Finds the contact points of two polyhedra, in the order of their features.
pub fn contact_points(pair: &CorePair<Dim3>, out: &mut Vec<ContactPoint<V>>) {
    let tolerances = &pair.tolerances;
    let reach = tolerances.reach + pair.roundings[0] + pair.roundings[1];
    let alike = ALIKE * tolerances.slack + ROUNDING * pair.apart.norm();
    let Some(reference) = pair.reference_face(reach, alike) else {
        return;
    };
    let first = out.len();
    match pair.closest(&reference, alike) {
        Closest::Face => {
            pair.face(&reference.points, reference.of_candidate, out);
            out[first..].sort_by_key(|m| m.feature);
        }
        Closest::Edges(near) => {
            if near.difference.norm() <= reach {
                pair.edges(&near, out);
            }
        }
        Closest::Crossing(crossed) => {
            let Crossing { normal, depth, .. } = crossed;
            pair.push(&crossed.points, &normal, depth, crossed.feature, out);
        }
    }
}

/// Finds the points of a pair that touch the plane of a face of one of the two: those of the
/// opposite face above it, and its lowest corner where that is beside the face and lower.
pub fn points_on_face(pair: &CorePair<Dim3>, face: PairFace, out: &mut Vec<ContactPoint<V>>) {
    let slack = pair.tolerances.slack;
    let lead = pair.lead(face);
    let Lead {
        own, other, apart, ..
    } = lead;
    let PairFace { of_candidate, face } = face;
    let mut points = polyhedron_clip::clip(&lead, slack);
    let normal = own.normals()[face];
    let corner = other.lowest(&normal);
    let at = other.points()[corner] + apart;
    let height = (at - own.points()[own.topology().faces[face][0] as usize]).dot(&normal);
    if points.iter().all(|p| p.height > height + slack) {
        points.push(polyhedron_clip::ClipPoint {
            at,
            height,
            normal,
            feature: name::corner(corner, !of_candidate),
            share: 0.0,
            facing: false,
        });
    }
    let first = out.len();
    pair.face(&points, of_candidate, out);
    out[first..].sort_by_key(|m| m.feature);
}

/// The face with the greatest separation, and the opposite face clipped to its sides.
struct ReferenceFace {
    /// Separation along its normal (m); minus infinity between two segments.
    separation: f64,
    /// Whether it is a face of the candidate.
    of_candidate: bool,
    points: Vec<polyhedron_clip::ClipPoint>,
}

/// The features of two polyhedra that are closest, or penetrate least.
enum Closest {
    /// The reference face, and the face opposite to it.
    Face,
    /// Two edges or corners.
    Edges(NearestEdgePoints),
    /// Two edges that penetrate each other.
    Crossing(Crossing),
}

impl CorePair<'_, Dim3> {
    /// Uses a face of one of the two as the reference face.
    fn lead(&self, PairFace { of_candidate, face }: PairFace) -> Lead<'_> {
        let ([a, b], apart) = (self.cores, self.apart);
        let (own, other, apart) = if of_candidate {
            (a, b, -apart)
        } else {
            (b, a, apart)
        };
        Lead {
            own,
            other,
            face,
            apart,
            of_candidate,
        }
    }

    /// Finds the reference face; `None` if the polyhedra are farther apart than `reach` (m). Of two
    /// faces that are equally good within `alike` (m) the candidate's is used, independent of
    /// rounding.
    fn reference_face(&self, reach: f64, alike: f64) -> Option<ReferenceFace> {
        let ([a, b], apart) = (self.cores, self.apart);
        let (from_a, face_a) = separation(a, b, &-apart, reach);
        if from_a > reach {
            return None;
        }
        let (from_b, face_b) = separation(b, a, &apart, reach);
        if from_b > reach {
            return None;
        }
        let of_candidate = from_a + alike >= from_b;
        let separation = from_a.max(from_b);
        let points = if separation.is_finite() {
            let face = if of_candidate { face_a } else { face_b };
            let lead = self.lead(PairFace { of_candidate, face });
            polyhedron_clip::clip(&lead, self.tolerances.slack)
        } else {
            Vec::new()
        };
        Some(ReferenceFace {
            separation,
            of_candidate,
            points,
        })
    }

    /// Chooses between the reference face and two edges.
    fn closest(&self, reference: &ReferenceFace, alike: f64) -> Closest {
        let (best, points) = (reference.separation, &reference.points);
        let ([a, b], tolerances) = (self.cores, &self.tolerances);
        let over = |p: &polyhedron_clip::ClipPoint| p.height <= best + alike;
        // A bond over a face keeps it while it bends, even if edges become nearer.
        let bonded = tolerances.held && points.len() > 2;
        if bonded || best >= -tolerances.slack && points.iter().any(over) {
            return Closest::Face;
        }
        let segments = a.normals().is_empty() && b.normals().is_empty();
        let crossed = if best > 0.0 || segments {
            None
        } else {
            crossing(a, b, &self.apart)
        };
        if best > 0.0 || segments || crossed.as_ref().is_some_and(|c| c.depth > 0.0) {
            let near = nearest(a, b, &self.apart);
            let distance = near.difference.norm();
            // `beside`: the nearest point is beside the face by at most the slack.
            let beside = best > 0.0
                && distance * distance - best * best <= tolerances.slack * tolerances.slack
                && !points.is_empty();
            let over_face = beside || tolerances.held && best > 0.0 && !points.is_empty();
            return if over_face {
                Closest::Face
            } else {
                Closest::Edges(near)
            };
        }
        match crossed.filter(|c| c.depth > best + alike || points.is_empty()) {
            Some(crossed) => Closest::Crossing(crossed),
            None => Closest::Face,
        }
    }

    /// Adds one point, from the points of the two cores (m) and their signed distance.
    fn push(
        &self,
        at: &[V; 2],
        normal: &V,
        distance: f64,
        feature: u64,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        out.push(ContactPoint {
            on_candidate: at[0] - normal * self.roundings[0],
            on_antagonist: at[1] + normal * self.roundings[1],
            normal: *normal,
            gap: distance - self.thickness(),
            feature,
            share: 0.0,
            facing: self.cores.iter().any(|c| c.normals().is_empty()),
        });
    }

    /// Adds the points of a face contact.
    fn face(
        &self,
        points: &[polyhedron_clip::ClipPoint],
        a_leads: bool,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        for point in points {
            let gap = point.height - self.thickness();
            if gap > self.tolerances.reach {
                continue;
            }
            // The point is on the other core; its projection on the reference core is below it.
            let at = if a_leads {
                point.at + self.apart
            } else {
                point.at
            };
            let closest_point = at - point.normal * point.height;
            let (places, normal) = if a_leads {
                ([closest_point, at], -point.normal)
            } else {
                ([at, closest_point], point.normal)
            };
            self.push(&places, &normal, point.height, point.feature, out);
            if let Some(last) = out.last_mut() {
                last.share = point.share;
                last.facing = last.facing || (point.share > 0.0 && point.facing);
            }
        }
    }

    /// Adds the point of two nearest edges; two points where they are parallel.
    fn edges(&self, near: &NearestEdgePoints, out: &mut Vec<ContactPoint<V>>) {
        let distance = near.difference.norm();
        let ([e, f], [a, b], slack) = (near.edges, self.cores, self.tolerances.slack);
        if let Some(ends) = side_by_side(
            a.ends(e).map(|p| p + self.apart),
            b.ends(f),
            slack + ROUNDING * distance,
        ) {
            let far = |at: &[V; 2]| (at[0] - at[1]).norm();
            if distance > 0.0 && ends.iter().all(|at| far(at) <= distance + slack) {
                for (k, at) in ends.iter().enumerate() {
                    let normal = (at[0] - at[1]) / far(at);
                    self.push(at, &normal, far(at), name::corner(k, true), out);
                }
                return;
            }
        }
        let along = |ends: [V; 2]| ends[1] - ends[0];
        let (u, v) = (along(a.ends(e)), along(b.ends(f)));
        let normal = edge_normal(&u, &v, &near.difference, ROUNDING * self.apart.norm());
        self.push(&near.points, &normal, distance, name::crossing(e, f), out);
    }
}

/// Returns the direction between two edges. Where it equals the edges' product up to rounding (m),
/// the product is used: between edges almost in contact, the difference vector alone has no
/// accurate direction.
fn edge_normal(u: &V, v: &V, way: &V, rounding: f64) -> V {
    let distance = way.norm();
    let product = u.cross(v).try_normalize(1e-9 * u.norm() * v.norm());
    if let Some(n) = product
        && (way - n * way.dot(&n)).norm() <= rounding
    {
        return if way.dot(&n) < 0.0 { -n } else { n };
    }
    if distance > 0.0 {
        way / distance
    } else {
        across(u)
    }
}

/// Returns the greatest separation along a face of `of`, and that face; `to` is at `apart` relative
/// to it. Minus infinity without faces; stops at the first face beyond `reach` (m).
fn separation(of: &Polyhedron, to: &Polyhedron, apart: &V, reach: f64) -> (f64, usize) {
    let mut best = (f64::NEG_INFINITY, 0);
    for (f, n) in of.normals().iter().enumerate() {
        let corner = of.topology().faces[f][0] as usize;
        let first = (apart - of.points()[corner]).dot(n);
        let mut lowest = f64::INFINITY;
        for p in to.points() {
            lowest = lowest.min(p.dot(n));
            // This face is not better than another: the remaining corners can only lower its value.
            if first + lowest <= best.0 {
                break;
            }
        }
        let s = lowest + first;
        if s > best.0 {
            best = (s, f);
            if s > reach {
                break;
            }
        }
    }
    best
}

/// Two edges that cross.
struct Crossing {
    /// Signed distance along the axis (m).
    depth: f64,
    /// Unit normal from `b` to `a`.
    normal: V,
    /// Nearest points of the two lines (m).
    points: [V; 2],
    feature: u64,
}

/// Returns the pair of edges with the greatest separation along their product; `None` if no pair
/// counts.
fn crossing(a: &Polyhedron, b: &Polyhedron, apart: &V) -> Option<Crossing> {
    let mut best: Option<Crossing> = None;
    for e in 0..a.topology().edges.len() {
        let [p0, p1] = a.ends(e).map(|p| p + apart);
        let along_a = p1 - p0;
        for f in 0..b.topology().edges.len() {
            let [q0, q1] = b.ends(f);
            let along_b = q1 - q0;
            if !(may_cross_normals(a, e, &along_b) && may_cross_normals(b, f, &along_a)) {
                continue;
            }
            let product = along_a.cross(&along_b);
            // Parallel edges have no axis of their own.
            let size = product.norm();
            if size <= 1e-6 * along_a.norm() * along_b.norm() {
                continue;
            }
            for axis in [product / size, product / -size] {
                let depth = (p0 - q0).dot(&axis);
                if best.as_ref().is_some_and(|b| b.depth >= depth) {
                    continue;
                }
                if is_between_normals(a, e, &-axis) && is_between_normals(b, f, &axis) {
                    best = Some(Crossing {
                        depth,
                        normal: axis,
                        points: nearest_on_lines(&[p0, p1], &[q0, q1]),
                        feature: name::crossing(e, f),
                    });
                }
            }
        }
    }
    best
}

/// Returns whether a plane perpendicular to a direction can contain a normal between those of an
/// edge's faces, so that the arc between these crosses it. Results within rounding are verified
/// later.
fn may_cross_normals(of: &Polyhedron, edge: usize, direction: &V) -> bool {
    let Some(faces) = of.topology().edges[edge].faces else {
        return true;
    };
    let [m, n] = faces.map(|f| of.normals()[f as usize].dot(direction));
    m * n <= 1e-12 * direction.norm_squared()
}

/// Returns whether a direction perpendicular to an edge is between the normals of its faces.
pub fn is_between_normals(of: &Polyhedron, edge: usize, axis: &V) -> bool {
    let Some(faces) = of.topology().edges[edge].faces else {
        return true;
    };
    let [m, n] = faces.map(|f| of.normals()[f as usize]);
    let [p, q] = of.ends(edge);
    let along = q - p;
    // The first face is oriented along the edge: the normals rotate about it from that face's to
    // the other's.
    m.cross(axis).dot(&along) >= 0.0 && axis.cross(&n).dot(&along) >= 0.0
}

/// Returns the nearest points of two lines that are not parallel.
fn nearest_on_lines([p0, p1]: &[V; 2], [q0, q1]: &[V; 2]) -> [V; 2] {
    let (u, v, w) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, b, c) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let (d, e) = (u.dot(&w), v.dot(&w));
    let over = a * c - b * b;
    [
        p0 + u * ((b * e - c * d) / over),
        q0 + v * ((a * e - b * d) / over),
    ]
}

/// Nearest points of the edges of two polyhedra.
struct NearestEdgePoints {
    edges: [usize; 2],
    /// Nearest points on `a` and on `b` (m).
    points: [V; 2],
    /// Difference of the points, from `b` to `a` (m).
    difference: V,
}

/// Finds the nearest points, skipping edges whose bounding balls are farther apart than the best
/// distance so far.
fn nearest(a: &Polyhedron, b: &Polyhedron, apart: &V) -> NearestEdgePoints {
    let mut best = NearestEdgePoints {
        edges: [0, 0],
        points: [V::zeros(); 2],
        difference: V::repeat(f64::INFINITY),
    };
    let mut least = f64::INFINITY;
    let ball = |[p, q]: [V; 2]| ((p + q) * 0.5, 0.5 * (p - q).norm());
    let others: Vec<(V, f64)> = (0..b.topology().edges.len())
        .map(|f| ball(b.ends(f)))
        .collect();
    for e in 0..a.topology().edges.len() {
        let one = a.ends(e).map(|p| p + apart);
        let (middle, half) = ball(one);
        let mut room = half + least.sqrt();
        for (f, (other, other_half)) in others.iter().enumerate() {
            let limit = room + other_half;
            if (middle - other).norm_squared() > limit * limit {
                continue;
            }
            let points = nearest_on_segments(&one, &b.ends(f));
            let difference = points[0] - points[1];
            let squared = difference.norm_squared();
            if squared < least {
                least = squared;
                room = half + least.sqrt();
                best = NearestEdgePoints {
                    edges: [e, f],
                    points,
                    difference,
                };
            }
        }
    }
    best
}

/// Returns the nearest points of two segments. Ericson, Real-Time Collision Detection (2005),
/// section 5.1.9.
fn nearest_on_segments([p0, p1]: &[V; 2], [q0, q1]: &[V; 2]) -> [V; 2] {
    let (u, v, r) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, e, f) = (u.norm_squared(), v.norm_squared(), v.dot(&r));
    let (b, c) = (u.dot(&v), u.dot(&r));
    let over = a * e - b * b;
    let mut s = if over > 1e-14 * a * e {
        ((b * f - c * e) / over).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mut t = (b * s + f) / e;
    if t < 0.0 {
        t = 0.0;
        s = (-c / a).clamp(0.0, 1.0);
    } else if t > 1.0 {
        t = 1.0;
        s = ((b - c) / a).clamp(0.0, 1.0);
    }
    [p0 + u * s, q0 + v * t]
}

/// Returns the points of both segments at the two ends of their overlap, for parallel segments;
/// `None` where the overlap is not longer than `slack` (m).
fn side_by_side([p0, p1]: [V; 2], [q0, q1]: [V; 2], slack: f64) -> Option<[[V; 2]; 2]> {
    let u = p1 - p0;
    let place = |x: &V| (x - p0).dot(&u) / u.norm_squared();
    let (mut s, mut t) = (place(&q0), place(&q1));
    if s > t {
        std::mem::swap(&mut s, &mut t);
    }
    let (low, high) = (s.max(0.0), t.min(1.0));
    if (high - low) * u.norm() <= slack {
        return None;
    }
    let v = q1 - q0;
    let closest_point = |x: V| q0 + v * ((x - q0).dot(&v) / v.norm_squared()).clamp(0.0, 1.0);
    Some([low, high].map(|s| {
        let on = p0 + u * s;
        [on, closest_point(on)]
    }))
}
