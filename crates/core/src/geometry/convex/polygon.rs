//! Convex polygons in 2D.

use super::{
    Boundary, ContactPoint, ContactTolerances, ConvexPart, Core, CorePair, PairFace, mass,
    polygon_line, polygon_pair, polygon_surface,
};
use crate::geometry::shape::Surface;
use crate::geometry::space::{Dim2, Space};
use nalgebra::{Matrix1, Vector2};

type V = Vector2<f64>;

/// Cosine of the largest angle between two sides that count as opposite: about five degrees.
const FACING: f64 = 0.996;

/// Bound of the rounding of rotations and distances, relative to the size.
const ROUNDING: f64 = 1e-12;

/// Anticlockwise corners, and the outward unit normals of the sides that start at them. Two points
/// are a segment with two sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    points: Vec<V>,
    normals: Vec<V>,
    /// Smallest distance of a side from the origin (m), slightly reduced for rounding; `None` if
    /// the origin is outside. A rotation keeps it.
    inner: f64,
    /// Distance of the farthest corner from the origin (m), up to rounding.
    far: f64,
}

/// Reason why points do not form a convex polygon.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum PolygonError {
    /// Fewer than three points.
    #[error("a polygon needs at least three points, got {0}")]
    TooFew(usize),
    /// A coordinate is not finite.
    #[error("point {0} of the polygon is not finite")]
    NotFinite(usize),
    /// Two consecutive points coincide.
    #[error("points {0} and {1} of the polygon coincide; remove one of them")]
    Coincident(usize, usize),
    /// Clockwise order.
    #[error("the points of a polygon must be in anticlockwise order; reverse their order")]
    Clockwise,
    /// All points on one line.
    #[error("the points of the polygon lie on one line")]
    Flat,
    /// A concave corner.
    #[error(
        "the polygon is not convex at point {0}; divide it into convex ones (a body may have several shapes)"
    )]
    NotConvex(usize),
    /// Three points on a line.
    #[error("point {0} of the polygon lies on the line between its neighbours; remove it")]
    Straight(usize),
    /// The boundary winds around more than once.
    #[error("the boundary of the polygon crosses itself")]
    Crosses,
}

impl Polygon {
    /// Creates a polygon from anticlockwise corners (m).
    ///
    /// # Errors
    /// Too few, coincident or non-finite points, points on a line, a polygon that is not convex.
    pub fn new(points: Vec<V>) -> Result<Self, PolygonError> {
        let n = points.len();
        if n < 3 {
            return Err(PolygonError::TooFew(n));
        }
        if let Some(k) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(PolygonError::NotFinite(k));
        }
        let side = |k: usize| points[(k + 1) % n] - points[k];
        let size = (0..n).map(|k| side(k).norm()).fold(0.0, f64::max);
        if let Some(k) = (0..n).find(|k| side(*k).norm() <= 1e-9 * size) {
            return Err(PolygonError::Coincident(k, (k + 1) % n));
        }
        let twice: f64 = (0..n)
            .map(|k| (points[k] - points[0]).perp(&(points[(k + 1) % n] - points[0])))
            .sum();
        if twice.abs() <= 1e-9 * size * size {
            return Err(PolygonError::Flat);
        }
        if twice < 0.0 {
            return Err(PolygonError::Clockwise);
        }
        let mut turn = 0.0;
        for k in 0..n {
            let (before, after) = (side((k + n - 1) % n), side(k));
            let sine = before.perp(&after) / (before.norm() * after.norm());
            if sine.abs() <= 1e-9 {
                return Err(PolygonError::Straight(k));
            }
            if sine < 0.0 {
                return Err(PolygonError::NotConvex(k));
            }
            turn += sine.atan2(before.dot(&after) / (before.norm() * after.norm()));
        }
        if turn > 1.5 * std::f64::consts::TAU {
            return Err(PolygonError::Crosses);
        }
        Ok(Self::with_normals(points))
    }

    /// Creates the segment between two different points (m), the core of a capsule.
    pub fn segment(from: V, to: V) -> Self {
        Self::with_normals(vec![from, to])
    }

    /// Creates a regular polygon about the origin, with its first corner on the x axis at `radius`
    /// (m) and at least three sides.
    pub fn regular(sides: usize, radius: f64) -> Self {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / sides as f64;
        let corner = |k: usize| V::new(angle(k).cos(), angle(k).sin()) * radius;
        Self::with_normals((0..sides).map(corner).collect())
    }

    fn with_normals(points: Vec<V>) -> Self {
        let n = points.len();
        let normal = |k: usize| {
            let along = points[(k + 1) % n] - points[k];
            V::new(along.y, -along.x) / along.norm()
        };
        let normals = (0..n).map(normal).collect();
        Self::of(points, normals)
    }

    fn of(points: Vec<V>, normals: Vec<V>) -> Self {
        let height = points.iter().zip(&normals).map(|(p, n)| p.dot(n));
        let inner = height.fold(f64::INFINITY, f64::min);
        let far = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
        Self {
            points,
            normals,
            inner: if inner > 0.0 {
                inner - ROUNDING * far
            } else {
                f64::NEG_INFINITY
            },
            far,
        }
    }

    /// Returns the part of a body with this core and a rounding radius (m).
    pub fn part(&self, rounding: f64) -> ConvexPart<Dim2> {
        let properties = mass::of(&self.points, rounding);
        let points = self.points.iter().map(|p| p - properties.centre);
        let core = Self::of(points.collect(), self.normals.clone());
        ConvexPart {
            bound: core.farthest() + rounding,
            core,
            centre: properties.centre,
            rounding,
            volume: properties.area,
            inertia: Matrix1::new(properties.polar),
        }
    }

    /// Returns the corners (m).
    pub fn points(&self) -> &[V] {
        &self.points
    }

    /// Returns the outward unit normals of the sides; side k goes from corner k to the next.
    pub fn normals(&self) -> &[V] {
        &self.normals
    }

    /// Returns whether a side with this outward normal is parallel to the opposite side, within
    /// about five degrees. Always true for the round end of a capsule.
    pub fn faces(&self, normal: &V) -> bool {
        self.points.len() == 2 || self.normals[self.facing(normal)].dot(normal) < -FACING
    }

    /// The point is outside, beyond the ends of that side: the nearest of all sides and corners
    /// counts.
    pub fn side(&self, k: usize) -> (V, V) {
        let next = if k + 1 == self.points.len() { 0 } else { k + 1 };
        (self.points[k], self.points[next])
    }

    /// Returns the distance of the farthest corner from the origin (m).
    pub fn farthest(&self) -> f64 {
        let squared = self.points.iter().map(|p| p.norm_squared());
        squared.fold(0.0, f64::max).sqrt()
    }

    /// Returns the largest error of rounding of a distance to another polygon near it, with its
    /// centre at `apart` (m).
    pub(super) fn rounding(&self, other: &Self, apart: &V) -> f64 {
        ROUNDING * (self.far + other.far + apart.amax())
    }

    /// Returns the radius of a circle about the origin within the polygon (m); minus infinity if
    /// the origin is not.
    pub fn inner(&self) -> f64 {
        self.inner
    }

    /// Returns the side whose normal is most opposed to a direction.
    pub fn facing(&self, direction: &V) -> usize {
        let mut best: (f64, usize) = (f64::INFINITY, 0);
        for (k, normal) in self.normals.iter().enumerate() {
            let along = normal.dot(direction);
            if along.total_cmp(&best.0).is_lt() {
                best = (along, k);
            }
        }
        best.1
    }

    /// Returns the signed distance of a point from the boundary (m, negative inside), the unit
    /// normal at the nearest point, and the corner if that is one.
    pub fn distance(&self, point: &V) -> (f64, V, Option<usize>) {
        let n = self.points.len();
        let (mut deepest, mut depth): (_, f64) = (0, f64::NEG_INFINITY);
        for (k, (corner, normal)) in self.points.iter().zip(&self.normals).enumerate() {
            let height = (point - corner).dot(normal);
            // The last of equal corners is taken.
            if height.total_cmp(&depth).is_ge() {
                (deepest, depth) = (k, height);
            }
        }
        let (a, b) = self.side(deepest);
        let s = (point - a).dot(&(b - a));
        if depth <= 0.0 || (s >= 0.0 && s <= (b - a).norm_squared()) {
            return (depth, self.normals[deepest], None);
        }
        // Outside, beyond the ends of that side: the nearest of all sides and corners.
        let mut best = (f64::INFINITY, self.normals[deepest], None);
        for k in 0..n {
            let (a, b) = self.side(k);
            let along = b - a;
            let s = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let d = point - (a + along * s);
            let length = d.norm();
            if length < best.0 && length > 0.0 {
                let corner = if s == 0.0 {
                    Some(k)
                } else if s == 1.0 {
                    Some((k + 1) % n)
                } else {
                    None
                };
                best = (length, d / length, corner);
            }
        }
        if best.0.is_infinite() {
            // The point is on a corner: the normal is between those of its two sides.
            return (0.0, self.normals[deepest], Some(deepest));
        }
        best
    }
}

impl Core<Dim2> for Polygon {
    fn turned(&self, rotation: &f64) -> Self {
        let mut out = Self {
            points: Vec::with_capacity(self.points.len()),
            normals: Vec::with_capacity(self.normals.len()),
            ..*self
        };
        self.turn_into(rotation, &mut out);
        out
    }

    fn turn_into(&self, rotation: &f64, out: &mut Self) {
        let (s, c) = rotation.sin_cos();
        let turn = |v: &V| V::new(c * v.x - s * v.y, s * v.x + c * v.y);
        out.points.clear();
        out.points.extend(self.points.iter().map(turn));
        out.normals.clear();
        out.normals.extend(self.normals.iter().map(turn));
        (out.inner, out.far) = (self.inner, self.far);
    }

    fn scale_into(&self, factor: f64, out: &mut Self) {
        out.points.clear();
        out.points.extend(self.points.iter().map(|p| p * factor));
        out.normals.clone_from(&self.normals);
        (out.inner, out.far) = (self.inner * factor, self.far * factor);
    }

    fn contact_points(pair: &CorePair<Dim2>, out: &mut Vec<ContactPoint<V>>) {
        polygon_pair::contact_points(pair, out);
    }

    fn corners(&self) -> &[V] {
        &self.points
    }

    fn normals(&self) -> &[V] {
        &self.normals
    }

    fn corner_of(&self, face: usize) -> V {
        self.points[face]
    }

    fn points_on_face(pair: &CorePair<Dim2>, face: PairFace, out: &mut Vec<ContactPoint<V>>) {
        polygon_line::points_on_line(pair, face, out);
    }

    fn feature_from_other_side(feature: u64) -> u64 {
        feature ^ 1
    }

    fn outward(&self, point: &V) -> (f64, V) {
        let (distance, normal, _) = self.distance(point);
        (distance, normal)
    }

    fn half_thickness(&self) -> f64 {
        super::half_thickness::<Dim2>(&self.points, &self.normals)
    }

    fn contact_points_with_surface(
        &self,
        surface: &dyn Surface<Dim2>,
        at: &V,
        rounding: f64,
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        polygon_surface::contact_points(self, surface, at, rounding, tolerances, out);
    }

    fn outline(&self, rounding: f64) -> Vec<Vec<V>> {
        if rounding == 0.0 {
            return vec![self.points.clone()];
        }
        let n = self.points.len();
        let mut out = Vec::new();
        for k in 0..n {
            let (before, after) = (self.normals[(k + n - 1) % n], self.normals[k]);
            let mut angle = before.perp(&after).atan2(before.dot(&after));
            if angle < 0.0 {
                angle += std::f64::consts::TAU;
            }
            let parts = (angle / 0.2).ceil().max(1.0) as usize;
            for part in 0..=parts {
                let turn = angle * part as f64 / parts as f64;
                out.push(self.points[k] + Dim2::rotate(&turn, &before) * rounding);
            }
        }
        vec![out]
    }

    fn boundary(&self) -> Boundary<V> {
        self.as_boundary()
    }

    fn bounded_by(boundary: Boundary<V>) -> Result<Self, String> {
        Self::of_boundary(boundary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Result<Polygon, PolygonError> {
        Polygon::new(points.iter().map(|p| V::new(p.0, p.1)).collect())
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused() {
        let of = |points: &[(f64, f64)]| polygon(points).unwrap_err();
        assert_eq!(of(&[(0.0, 0.0), (1.0, 0.0)]), PolygonError::TooFew(2));
        let nan = [(0.0, 0.0), (1.0, f64::NAN), (0.0, 1.0)];
        assert_eq!(of(&nan), PolygonError::NotFinite(1));
        let twice = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
        assert_eq!(of(&twice), PolygonError::Coincident(1, 2));
        let clock = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
        assert_eq!(of(&clock), PolygonError::Clockwise);
        let line = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)];
        assert_eq!(of(&line), PolygonError::Flat);
        let dart = [(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)];
        assert_eq!(of(&dart), PolygonError::NotConvex(2));
        let straight = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 2.0)];
        assert_eq!(of(&straight), PolygonError::Straight(1));
        let angle = |k: usize| std::f64::consts::TAU * 0.4 * k as f64;
        let star: Vec<_> = (0..5).map(|k| (angle(k).cos(), angle(k).sin())).collect();
        assert_eq!(of(&star), PolygonError::Crosses);
    }

    #[test]
    fn a_ball_meets_sides_and_corners() {
        let square = polygon(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]).unwrap();
        let m = square.contact_point_with_ball(&V::new(0.3, 1.7), 0.5, 0.1);
        assert!((m.gap - 0.1).abs() < 1e-15 && m.normal == V::new(0.0, 1.0));
        assert!((m.on_antagonist - V::new(0.3, 1.1)).norm() < 1e-15);
        let m = square.contact_point_with_ball(&V::new(4.0, 5.0), 0.5, 0.0);
        assert!((m.gap - 4.5).abs() < 1e-15 && (m.normal - V::new(0.6, 0.8)).norm() < 1e-15);
        let m = square.contact_point_with_ball(&V::new(0.9, 0.2), 0.5, 0.0);
        assert!((m.gap + 0.6).abs() < 1e-15 && m.normal == V::new(1.0, 0.0));
    }
}
