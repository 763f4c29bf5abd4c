//! Contact of a convex polyhedron and a surface of a first body.
//!
//! Corners of the polyhedron touch the surface like small balls. A surface of facets has corners
//! and edges of its own: sharp ones touch the polyhedron's faces and edges. A point counts if the
//! facets around it lie behind its normal, so that there are no ghost contacts at seams, and none
//! at a seam within one plane. Planes and the insides of drums are touched by corners only.

use super::polyhedron::Polyhedron;
use super::polyhedron_pair::is_between_normals;
use super::{ContactPoint, ContactTolerances, MAX_CORNER_DEPTH, STEEPEST};
use crate::geometry::facets::{self, Facet, Ridge};
use crate::geometry::shape::{ClosestPoint, Surface};
use crate::geometry::space::Dim3;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Positions closer than this fraction of the size count as equal.
const SAME: f64 = 1e-9;

/// Finds the contact points of the polyhedron, centred at `at` in the surface's frame, in the order
/// of their features.
pub fn contact_points(
    core: &Polyhedron,
    surface: &dyn Surface<Dim3>,
    at: &V,
    rounding: f64,
    tolerances: &ContactTolerances,
    out: &mut Vec<ContactPoint<V>>,
) {
    let size = core.farthest() + rounding;
    let extent = V::repeat(size + tolerances.reach);
    let mut facets = Vec::new();
    surface.facets(&(at - extent), &(at + extent), &mut facets);
    let first = out.len();
    let placed = PlacedCore {
        core,
        at,
        rounding,
        reach: tolerances.reach + rounding,
        deep: MAX_CORNER_DEPTH * size,
        same: SAME * size,
    };
    placed.corners(surface, !facets.is_empty(), out);
    if !facets.is_empty() {
        let deforms = surface.deforms();
        let ridges = facets::ridges(&facets, deforms);
        if deforms {
            placed.vertices(&facets, out);
        } else {
            placed.points(&facets, &ridges, out);
        }
        placed.edges(&ridges, deforms, out);
    }
    out[first..].sort_by_key(|m| m.feature);
}

/// A polyhedron in the frame of a surface, and search distances.
struct PlacedCore<'a> {
    core: &'a Polyhedron,
    at: &'a V,
    rounding: f64,
    /// Search distance of the core (m).
    reach: f64,
    /// Depth up to which a corner behind facets is found (m).
    deep: f64,
    /// Distance of positions that count as equal (m).
    same: f64,
}

impl PlacedCore<'_> {
    /// Finds contacts of the polyhedron's corners with the surface.
    fn corners(&self, surface: &dyn Surface<Dim3>, faceted: bool, out: &mut Vec<ContactPoint<V>>) {
        let reach = if faceted {
            self.reach.max(self.deep)
        } else {
            self.reach
        };
        let mut closest_points: Vec<ClosestPoint<V>> = Vec::new();
        for (k, point) in self.core.points().iter().enumerate() {
            let p = point + self.at;
            closest_points.clear();
            surface.closest_points(&p, reach, &mut closest_points);
            for closest in closest_points.iter().filter(|t| t.distance < self.reach) {
                // Corners of the face opposite the surface; for a segment, which has no faces, both
                // ends.
                let facing = self.core.facing(&closest.normal);
                let faces = &self.core.topology().faces;
                if facing.is_some_and(|f| !faces[f].contains(&(k as u32))) {
                    continue;
                }
                out.push(ContactPoint {
                    on_candidate: p - closest.normal * self.rounding,
                    on_antagonist: closest.closest_point,
                    normal: closest.normal,
                    gap: closest.distance - self.rounding,
                    feature: u64::from(closest.feature) << 32 | k as u64,
                    share: facing.map_or(0.0, |f| share(self.core, f)),
                    facing: self.core.faces(&closest.normal),
                });
            }
        }
    }

    /// The contact point of a corner of the surface, at a distance from the core (m).
    fn point_at(
        &self,
        place: V,
        distance: f64,
        outward: V,
        feature: u64,
        facing: bool,
    ) -> ContactPoint<V> {
        ContactPoint {
            on_candidate: place - outward * (distance - self.rounding),
            on_antagonist: place,
            normal: -outward,
            gap: distance - self.rounding,
            feature,
            share: 0.0,
            facing,
        }
    }

    /// Finds contacts of all vertices of a surface that deforms with the faces of the polyhedron.
    fn vertices(&self, facets: &[Facet<V>], out: &mut Vec<ContactPoint<V>>) {
        facets::vertices(facets, |place, mean, feature| {
            let (distance, outward) = self.core.distance(&(place - self.at));
            if distance > self.reach || distance < -self.deep {
                return;
            }
            let face = |n: &V| (n - outward).norm() <= SAME;
            if !self.core.normals().iter().any(face) || -outward.dot(&mean) <= STEEPEST {
                return;
            }
            let feature = u64::from(feature) << 32 | 1 << 30;
            out.push(self.point_at(place, distance, outward, feature, false));
        });
    }

    /// Finds contacts of sharp corners of the surface with the faces and edges of the polyhedron.
    fn points(&self, facets: &[Facet<V>], ridges: &[Ridge], out: &mut Vec<ContactPoint<V>>) {
        let mut seen: Vec<u64> = Vec::new();
        for ridge in ridges {
            for (name, place) in ridge.names.into_iter().zip(ridge.ends) {
                if seen.contains(&name) {
                    continue;
                }
                seen.push(name);
                let (distance, outward) = self.core.distance(&(place - self.at));
                if distance > self.reach || distance < -self.deep {
                    continue;
                }
                // Corner on corner is found as a corner of the polyhedron.
                let closest_point = place - self.at - outward * distance;
                let corner = |p: &V| (p - closest_point).norm() <= self.same;
                if self.core.points().iter().any(corner)
                    || !facets::behind(facets, name, &place, &-outward)
                {
                    continue;
                }
                let feature = u64::from(ridge.facet) << 32 | 1 << 30 | (name & 0xfff_ffff);
                let facing = self.core.normals().is_empty();
                out.push(self.point_at(place, distance, outward, feature, facing));
            }
        }
    }

    /// Finds contacts of sharp edges of the surface with edges of the polyhedron; of all edges of a
    /// surface that deforms.
    fn edges(&self, ridges: &[Ridge], deforms: bool, out: &mut Vec<ContactPoint<V>>) {
        for ridge in ridges {
            let outward = ridge.outward();
            let holds = |normal: &V| {
                if deforms && outward != V::zeros() {
                    normal.dot(&outward) > STEEPEST * outward.norm()
                } else {
                    ridge.holds(normal)
                }
            };
            let [p, q] = ridge.ends;
            let u = q - p;
            for e in 0..self.core.topology().edges.len() {
                let [a, b] = self.core.ends(e).map(|x| x + self.at);
                let v = b - a;
                let Some(across) = u.cross(&v).try_normalize(1e-6 * u.norm() * v.norm()) else {
                    continue;
                };
                let distance = (a - p).dot(&across);
                if distance.abs() > self.reach.max(self.deep) {
                    continue;
                }
                // Nearest points of the lines, as fractions of the edges.
                let w = p - a + across * distance;
                let part = |x: &V, y: &V| w.cross(x).dot(&across) / y.cross(x).dot(&across);
                let (s, t) = (-part(&v, &u), part(&u, &v));
                let inside = |x: f64| (0.0..=1.0).contains(&x);
                if !inside(s) || !inside(t) {
                    continue;
                }
                for normal in [across, -across] {
                    let gap = (a - p).dot(&normal);
                    if gap < self.reach
                        && gap > -self.deep
                        && holds(&normal)
                        && is_between_normals(self.core, e, &-normal)
                    {
                        out.push(ContactPoint {
                            on_candidate: a + v * t - normal * self.rounding,
                            on_antagonist: p + u * s,
                            normal,
                            gap: gap - self.rounding,
                            feature: u64::from(ridge.facet) << 32
                                | 2 << 30
                                | u64::from(ridge.side) << 28
                                | e as u64,
                            share: 0.0,
                            facing: self.core.normals().is_empty(),
                        });
                    }
                }
            }
        }
    }
}

/// Returns the radius of a disk with a corner's fraction of the area of a face (m).
fn share(core: &Polyhedron, face: usize) -> f64 {
    let corners: Vec<V> = core.face(face).collect();
    let from = |k: usize| corners[k] - corners[0];
    let area: V = (1..corners.len() - 1)
        .map(|k| from(k).cross(&from(k + 1)) * 0.5)
        .sum();
    (area.norm() / (corners.len() as f64 * std::f64::consts::PI)).sqrt()
}
