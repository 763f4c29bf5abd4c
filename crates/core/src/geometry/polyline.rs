//! The profile of a first body in 2D: a chain of segments, solid on its right-hand side.

use super::box_tree::{BoundingBox, BoxTree};
use super::recede::{Recede, Vertex, VertexShares};
use super::shape::{ClosestPoint, Corner, Fan, Surface, at_vertex};
use super::space::Dim2;
use nalgebra::Vector2;

type V = Vector2<f64>;

/// Distance from a vertex, relative to its segment, that counts as rounding.
const AT_VERTEX: f64 = 1e-9;

/// Depth below the line of the last segment of a deformable surface at which a point beyond its end
/// still counts as inside, as a fraction of the segment: larger than the penetration by loads. A
/// deeper point is beside the surface.
const BELOW: f64 = 0.25;

/// Points of a closed chain count as one if they are closer than this fraction of the search
/// distance.
const SEAM: f64 = 1e-9;

/// Margin of the bounding boxes of wearing segments, relative to the mean segment length; it
/// determines how often they are rebuilt.
const MARGIN: f64 = 0.25;

/// An open chain of segments. In the direction of the chain the solid is on the right, the open
/// side on the left. With a period the chain repeats along x and its last point is the image of the
/// first.
#[derive(Debug)]
pub struct Polyline {
    points: Vec<V>,
    period: Option<f64>,
    /// Whether the chain is closed: its last point is its first.
    closed: bool,
    boxes: BoxTree,
    /// Data of a wearing profile; `None` without wear.
    worn: Option<ProfileWear>,
    /// Positions of the points when the boxes were built, and the margin of the boxes (m); `None`
    /// unless the profile deforms.
    deformed: Option<(Vec<V>, f64)>,
}

/// Heights before any wear, depths, and the displacement of vertices since the boxes were built,
/// and the margin (m).
#[derive(Debug)]
struct ProfileWear {
    first: Vec<f64>,
    depth: Vec<f64>,
    moved: f64,
    margin: f64,
}

/// Reason why a chain of points is not a valid profile.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ProfileError {
    /// Fewer than two points.
    #[error("a profile needs at least two points, got {0}")]
    TooFew(usize),
    /// Two consecutive points coincide.
    #[error("points {0} and {1} of the profile coincide; remove one of them")]
    Coincident(usize, usize),
    /// The ends do not match the period.
    #[error(
        "a periodic profile must end one period after its start at the same height: it starts at \
         ({0:e}, {1:e}), ends at ({2:e}, {3:e}) and the period is {4:e} m"
    )]
    Period(f64, f64, f64, f64, f64),
    /// A coordinate is not finite.
    #[error("point {0} of the profile is not finite")]
    NotFinite(usize),
    /// Two of its segments intersect.
    #[error(
        "the profile crosses itself at ({2:.6e}, {3:.6e}) m: the segment after point {0} meets the one after \
         point {1}; order the points along the profile, or leave some out"
    )]
    Crosses(usize, usize, f64, f64),
}

impl Polyline {
    /// Builds the chain from its points (m).
    ///
    /// # Errors
    /// Too few, coincident or non-finite points, ends that do not match the period.
    pub fn new(points: Vec<V>, period: Option<f64>) -> Result<Self, ProfileError> {
        Self::build(points, period, false)
    }

    /// Builds a closed chain around a solid from its corners (m), clockwise.
    ///
    /// # Errors
    /// Too few, coincident or non-finite points.
    pub fn closed(mut corners: Vec<V>) -> Result<Self, ProfileError> {
        let vertices = corners.clone();
        corners.extend(corners.first().copied());
        let mut out = Self::build(corners, None, true)?;
        // A closed chain deforms from the start.
        out.move_vertices(&vertices);
        Ok(out)
    }

    fn build(points: Vec<V>, period: Option<f64>, closed: bool) -> Result<Self, ProfileError> {
        if points.len() < 2 {
            return Err(ProfileError::TooFew(points.len()));
        }
        if let Some(k) = points
            .iter()
            .position(|p| !(p.x.is_finite() && p.y.is_finite()))
        {
            return Err(ProfileError::NotFinite(k));
        }
        if let Some(k) = points.windows(2).position(|w| w[0] == w[1]) {
            return Err(ProfileError::Coincident(k, k + 1));
        }
        let (first, last) = (points[0], points[points.len() - 1]);
        if let Some(period) = period {
            let along = if last.x > first.x { period } else { -period };
            let mismatch = (last - first - V::new(along, 0.0)).norm();
            if mismatch > 1e-9 * period {
                return Err(ProfileError::Period(
                    first.x, first.y, last.x, last.y, period,
                ));
            }
        }
        // The last segment of a closed chain meets the first.
        let open = &points[..points.len() - usize::from(closed)];
        if let Some((one, other, at)) = super::crossing::first(open) {
            return Err(ProfileError::Crosses(one, other, at.x, at.y));
        }
        let mut out = Self {
            points,
            period,
            closed,
            boxes: BoxTree::default(),
            worn: None,
            deformed: None,
        };
        out.index([0.0, 0.0]);
        Ok(out)
    }

    /// Builds the bounding boxes of the segments, with a margin along each axis (m).
    fn index(&mut self, margin: [f64; 2]) {
        let margin = V::from(margin);
        let of = |ends: &[V]| BoundingBox {
            low: ends[0].inf(&ends[1]) - margin,
            high: ends[0].sup(&ends[1]) + margin,
        };
        self.boxes.set(self.points.windows(2).map(of));
    }

    /// Calls `each` with the segments whose boxes meet a window, and their shifts along x (m),
    /// until it returns false.
    fn visit(&self, bounds: &BoundingBox, mut each: impl FnMut(usize, f64) -> bool) {
        let Some(period) = self.period else {
            self.boxes.visit(bounds, &mut |k| each(k, 0.0));
            return;
        };
        for shift in [-period, 0.0, period] {
            let image = bounds.shifted(-shift);
            if !self.boxes.visit(&image, &mut |k| each(k, shift)) {
                return;
            }
        }
    }

    /// Returns whether the first segment follows the last.
    fn continues(&self) -> bool {
        self.closed || self.period.is_some()
    }

    /// Returns the ends of a segment, shifted along x (m).
    fn segment(&self, k: usize, shift: f64) -> [V; 2] {
        let image = |p: V| V::new(p.x + shift, p.y);
        [image(self.points[k]), image(self.points[k + 1])]
    }

    /// Returns 1 if the chain goes to the right, so that the solid is below it, and -1 if it goes
    /// to the left.
    fn direction(&self) -> f64 {
        let last = self.points[self.points.len() - 1];
        if last.x > self.points[0].x { 1.0 } else { -1.0 }
    }

    fn segments(&self) -> usize {
        self.points.len() - 1
    }

    /// Maps a position into the period that starts at the first point.
    fn wrapped(&self, centre: &V) -> (V, f64) {
        let Some(period) = self.period else {
            return (*centre, 0.0);
        };
        let start = self.points[0].x.min(self.points[self.points.len() - 1].x);
        let shift = ((centre.x - start) / period).floor() * period;
        (V::new(centre.x - shift, centre.y), shift)
    }

    /// Returns the direction of the chain after a segment; `None` at its end.
    fn following(&self, segment: usize) -> Option<V> {
        let next = match segment + 1 {
            next if next < self.segments() => next,
            _ => self.continues().then_some(0)?,
        };
        Some(self.points[next + 1] - self.points[next])
    }
}

impl Surface<Dim2> for Polyline {
    fn closest_points(&self, centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
        let (c, shift) = self.wrapped(centre);
        let start = out.len();
        self.visit(&BoundingBox::around(&c, reach), |segment, image| {
            let k = segment as u32;
            let [a, b] = self.segment(segment, image);
            let along = b - a;
            let (s, end) = ((c - a).dot(&along), along.norm_squared());
            if s >= 0.0 && s <= end {
                let normal = V::new(-along.y, along.x) / along.norm();
                let distance = (c - a).dot(&normal);
                if distance.abs() < reach {
                    let closest_point = c - normal * distance + V::new(shift, 0.0);
                    out.push(ClosestPoint {
                        closest_point,
                        normal,
                        distance,
                        feature: 2 * k,
                    });
                }
                return true;
            }
            // A vertex gives one contact point: from the segment that ends in it, or at the chain's
            // start.
            let at_end = s > end;
            if !at_end && (k > 0 || self.continues()) {
                return true;
            }
            let vertex = if at_end { b } else { a };
            let next = if at_end {
                self.following(segment)
            } else {
                None
            };
            let from = c - vertex;
            let nearest = next.is_none_or(|next| from.dot(&next) <= 0.0);
            // Beyond both faces of a valley means behind them.
            let valley = next.is_some_and(|next| along.perp(&next) > 0.0);
            let length = from.norm();
            if length < reach && nearest {
                // At the vertex itself, and behind a vertex that is not a valley, the direction
                // from the vertex is meaningless.
                let of = |v: V| V::new(-v.y, v.x) / v.norm();
                let mean = (of(along) + of(next.unwrap_or(along))).normalize();
                let level = from.dot(&mean) >= -BELOW * along.norm();
                let ends = next.is_none() && self.deforms() && level && 2.0 * length < along.norm();
                let behind = !valley && next.is_some() && from.dot(&mean) < 0.0 || ends;
                let (normal, distance) = if behind || length <= AT_VERTEX * along.norm() {
                    (mean, from.dot(&mean))
                } else {
                    let distance = if valley { -length } else { length };
                    (from / distance, distance)
                };
                let closest_point = vertex + V::new(shift, 0.0);
                let feature = if at_end { 2 * k + 1 } else { u32::MAX };
                out.push(ClosestPoint {
                    closest_point,
                    normal,
                    distance,
                    feature,
                });
            }
            true
        });
        out[start..].sort_by_key(|t| t.feature);
        // A vertex on a vertex of another grain is found by both segments.
        let mut k = start + 1;
        while self.closed && k < out.len() {
            let (before, here) = (&out[start..k], &out[k]);
            let alike = |t: &ClosestPoint<V>| {
                (t.closest_point - here.closest_point).norm() <= SEAM * reach
                    && t.normal.dot(&here.normal) > 0.5
            };
            if before.iter().any(alike) {
                out.remove(k);
            } else {
                k += 1;
            }
        }
    }

    fn near(&self, centre: &V, reach: f64) -> bool {
        let (c, _) = self.wrapped(centre);
        let mut any = false;
        self.visit(&BoundingBox::around(&c, reach), |_, _| {
            any = true;
            false
        });
        any
    }

    fn corners(&self, low: &V, high: &V, out: &mut Vec<Corner<V>>) {
        // The chain's images are one period to each side.
        let middle = (low + high) * 0.5;
        let (_, shift) = self.wrapped(&middle);
        let bounds = BoundingBox {
            low: V::new(low.x - shift, low.y),
            high: V::new(high.x - shift, high.y),
        };
        let first = out.len();
        self.visit(&bounds, |k, image| {
            let [a, b] = self.segment(k, image);
            let at = b + V::new(shift, 0.0);
            let inside = (0..2).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]);
            if !inside {
                return true;
            }
            let next = if k + 1 < self.segments() {
                k + 1
            } else if self.continues() {
                0
            } else {
                return true;
            };
            let (before, after) = (b - a, self.points[next + 1] - self.points[next]);
            let normal = |v: V| V::new(-v.y, v.x) / v.norm();
            let normals = [normal(before), normal(after)];
            // With the solid on the right, a convex corner turns right.
            let convex = normals[0].perp(&normals[1]) < -1e-9;
            if convex || self.deforms() {
                let feature = 2 * k as u32 + 1;
                out.push(Corner {
                    at,
                    normals,
                    feature,
                });
            }
            true
        });
        out[first..].sort_by_key(|c| c.feature);
    }

    fn fan(&self, at: &V, within: f64, out: &mut Fan<V>) {
        let (c, _) = self.wrapped(at);
        self.visit(&BoundingBox::around(&c, within), |k, image| {
            let [a, b] = self.segment(k, image);
            let along = b - a;
            let length = along.norm();
            for (end, other) in [(a, b), (b, a)] {
                if (end - c).norm() <= within {
                    out.normals.push(V::new(-along.y, along.x) / length);
                    out.spokes.push(other - end);
                }
            }
            true
        });
    }

    fn vertices_within(&self, centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
        if !self.deforms() {
            return;
        }
        let (extent, mut corners) = (V::repeat(reach), Vec::new());
        self.corners(&(centre - extent), &(centre + extent), &mut corners);
        out.extend(corners.iter().filter_map(|c| {
            let outward = c.normals[0] + c.normals[1];
            at_vertex(c.at, &outward, centre, reach, c.feature)
        }));
    }

    fn outline(&self) -> Vec<Vec<V>> {
        vec![self.points.clone()]
    }

    fn is_closed(&self) -> bool {
        self.closed
    }

    fn move_vertices(&mut self, vertices: &[V]) {
        self.points[..vertices.len()].copy_from_slice(vertices);
        if self.closed {
            let last = self.points.len() - 1;
            self.points[last] = self.points[0];
        }
        // The vertices are those of the body without wear.
        let down = self.direction();
        if let Some(worn) = &mut self.worn {
            for (k, point) in self.points.iter_mut().enumerate() {
                worn.first[k] = point.y;
                point.y -= down * worn.depth[k];
            }
        }
        let far = |(built, margin): &(Vec<V>, f64)| {
            let mut moved = built.iter().zip(&self.points);
            moved.any(|(a, b)| (b - a).amax() > *margin)
        };
        if self.deformed.as_ref().is_none_or(far) {
            let lengths = self.points.windows(2).map(|w| (w[1] - w[0]).norm());
            let mean = lengths.sum::<f64>() / self.segments() as f64;
            let margin = MARGIN * mean;
            self.deformed = Some((self.points.clone(), margin));
            self.index([margin, margin]);
        }
    }

    fn moving_vertices(&self) -> &[V] {
        if self.deformed.is_some() {
            &self.points
        } else {
            &[]
        }
    }

    fn border_normal(&self, feature: u32) -> Option<V> {
        let last = self.segments() - 1;
        let segment = match feature {
            u32::MAX => 0,
            vertex if vertex as usize == 2 * last + 1 => last,
            _ => return None,
        };
        let along = self.points[segment + 1] - self.points[segment];
        let open = self.deforms() && !self.continues();
        open.then(|| V::new(-along.y, along.x).normalize())
    }

    fn receding(&self) -> Option<&dyn Recede<Dim2>> {
        Some(self)
    }

    fn receding_mut(&mut self) -> Option<&mut dyn Recede<Dim2>> {
        Some(self)
    }
}

impl Recede<Dim2> for Polyline {
    fn vertices(&self) -> Vec<Vertex<V>> {
        let n = self.segments();
        let wide = |k: usize| (self.points[k + 1].x - self.points[k].x).abs();
        let count = if self.period.is_some() { n } else { n + 1 };
        let vertex = |k: usize| {
            let before = match (k, self.period) {
                (0, Some(_)) => wide(n - 1),
                (0, None) => 0.0,
                _ => wide(k - 1),
            };
            let after = if k < n { wide(k) } else { 0.0 };
            let mut at = self.points[k];
            if let Some(worn) = &self.worn {
                at.y = worn.first[k];
            }
            let tributary = 0.5 * (before + after);
            Vertex { at, tributary }
        };
        (0..count).map(vertex).collect()
    }

    fn end(&self) -> Option<V> {
        self.period.map(|_| {
            let last = self.segments();
            let height = self.worn.as_ref().map(|w| w.first[last]);
            let at = self.points[last];
            V::new(at.x, height.unwrap_or(at.y))
        })
    }

    fn shares(&self, closest_point: &V) -> VertexShares {
        let (closest_point, _) = self.wrapped(closest_point);
        let (n, to) = (self.segments(), self.direction());
        let passed = self
            .points
            .partition_point(|p| to * p.x <= to * closest_point.x);
        let k = passed.clamp(1, n) - 1;
        let (a, b) = (self.points[k].x, self.points[k + 1].x);
        let s = if a == b {
            0.0
        } else {
            (closest_point.x - a) / (b - a)
        };
        let s = s.clamp(0.0, 1.0);
        let next = if k + 1 == n && self.period.is_some() {
            0
        } else {
            k + 1
        };
        [(k, 1.0 - s), (next, s), (k, 0.0)]
    }

    fn recede(&mut self, depth: &[f64], named: &[usize]) -> f64 {
        let (n, down) = (self.segments(), self.direction());
        let wide = (self.points[n].x - self.points[0].x).abs();
        let worn = self.worn.get_or_insert_with(|| ProfileWear {
            first: self.points.iter().map(|p| p.y).collect(),
            depth: vec![0.0; n + 1],
            // The boxes have no margin for wear yet.
            moved: f64::INFINITY,
            margin: MARGIN * wide / n as f64,
        });
        // The end of a period is the image of its start.
        let image = named
            .iter()
            .filter(|k| **k == 0 && self.period.is_some())
            .map(|_| (n, 0));
        let mut step = 0.0f64;
        for (k, of) in named.iter().map(|k| (*k, *k)).chain(image) {
            worn.depth[k] = depth[of];
            let next = worn.first[k] - down * depth[of];
            let height = &mut self.points[k].y;
            step = step.max((*height - next).abs());
            *height = next;
        }
        worn.moved += step;
        // The boxes of a surface that deforms are built again as it moves.
        if self.deformed.is_none() && worn.moved > worn.margin {
            worn.moved = 0.0;
            let margin = worn.margin;
            self.index([0.0, margin]);
        }
        step
    }

    fn sign(&self) -> f64 {
        self.direction()
    }
}

#[cfg(test)]
mod tests;
