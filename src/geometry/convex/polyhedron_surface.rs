//! A convex polyhedron and a surface of a first body.
//!
//! A surface of facets meets it facet by facet, as a pair of polyhedra. A point counts where the facets about it
//! lie behind its normal (no ghosts at seams), and where it is a corner of the polyhedron or on a sharp edge of the
//! surface: on a seam between facets of one plane there is nothing to touch. Planes and the insides of drums are
//! touched by corners alone.

use super::polyhedron::{Polyhedron, Topology};
use super::{Gauge, Meeting, polyhedron_pair};
use crate::geometry::facets::Facet;
use crate::geometry::shape::{Surface, Touch};
use crate::geometry::space::Solid;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// How far, in parts of the distance, a facet may stand out before a normal and still count as behind it.
const BEHIND: f64 = 1e-6;
/// Places nearer than this part of the reach are the same.
const SEAM: f64 = 1e-9;

/// Meetings of the polyhedron, centred at `at` in the surface's frame, in the order of their features.
pub fn meet(
    core: &Polyhedron,
    surface: &dyn Surface<Solid>,
    at: &V,
    rounding: f64,
    gauge: &Gauge,
    out: &mut Vec<Meeting<V>>,
) {
    let extent = V::repeat(core.farthest() + rounding + gauge.reach);
    let mut facets = Vec::new();
    surface.facets(&(at - extent), &(at + extent), &mut facets);
    let first = out.len();
    if facets.is_empty() {
        corners(core, surface, at, rounding, gauge.reach, out);
    } else {
        sides(core, &facets, at, rounding, gauge, out);
    }
    out[first..].sort_by_key(|m| m.feature);
}

/// Corners on a surface that has none of its own.
fn corners(
    core: &Polyhedron,
    surface: &dyn Surface<Solid>,
    at: &V,
    rounding: f64,
    reach: f64,
    out: &mut Vec<Meeting<V>>,
) {
    let mut touches: Vec<Touch<V>> = Vec::new();
    for (k, point) in core.points().iter().enumerate() {
        let p = point + at;
        touches.clear();
        surface.touches(&p, reach + rounding, &mut touches);
        for touch in &touches {
            // Of the face that faces the surface; a segment has none, and both its ends count.
            let facing = core.facing(&touch.normal);
            if facing.is_some_and(|f| !core.topology().faces[f].contains(&(k as u32))) {
                continue;
            }
            out.push(Meeting {
                on_candidate: p - touch.normal * rounding,
                on_antagonist: touch.foot,
                normal: touch.normal,
                gap: touch.distance - rounding,
                feature: u64::from(touch.feature) << 32 | k as u64,
                share: facing.map_or(0.0, |f| share(core, f)),
                facing: core.faces(&touch.normal),
            });
        }
    }
}

/// Radius of a disk with a corner's part of the area of a face (m).
fn share(core: &Polyhedron, face: usize) -> f64 {
    let corners: Vec<V> = core.face(face).collect();
    let from = |k: usize| corners[k] - corners[0];
    let area: V = (1..corners.len() - 1)
        .map(|k| from(k).cross(&from(k + 1)) * 0.5)
        .sum();
    (area.norm() / (corners.len() as f64 * std::f64::consts::PI)).sqrt()
}

/// Facet by facet.
fn sides(
    core: &Polyhedron,
    facets: &[Facet<V>],
    at: &V,
    rounding: f64,
    gauge: &Gauge,
    out: &mut Vec<Meeting<V>>,
) {
    let topology = Topology::facet();
    let (first, mut met) = (out.len(), Vec::new());
    for facet in facets {
        // About its own first corner: the two are near each other, wherever the surface's origin is.
        let origin = facet.corners[0];
        let triangle = Polyhedron::facet(facet.corners.map(|c| c - origin), &topology);
        met.clear();
        let apart = origin - at;
        polyhedron_pair::meet(&triangle, core, &apart, [0.0, rounding], gauge, &mut met);
        for m in &met {
            // The facet was the candidate there.
            let own_corner = m.feature & 3 == 1;
            let meeting = Meeting {
                on_candidate: m.on_antagonist + at,
                on_antagonist: m.on_candidate + at,
                normal: -m.normal,
                gap: m.gap,
                feature: u64::from(facet.name) << 32 | m.feature & 0xffff_ffff,
                share: 0.0,
                facing: m.facing,
            };
            if !stands(&meeting, facet, facets, own_corner, gauge.slack) {
                continue;
            }
            let alike = |o: &Meeting<V>| {
                (o.on_antagonist - meeting.on_antagonist).norm() <= SEAM * gauge.reach + gauge.slack
                    && o.normal.dot(&meeting.normal) >= 1.0 - SEAM
            };
            if !out[first..].iter().any(alike) {
                out.push(meeting);
            }
        }
    }
}

/// Whether a point counts: see the module.
fn stands(
    m: &Meeting<V>,
    facet: &Facet<V>,
    facets: &[Facet<V>],
    own_corner: bool,
    slack: f64,
) -> bool {
    if m.normal.dot(&facet.normal()) <= 0.0 {
        return false;
    }
    let foot = m.on_antagonist;
    let used = on(facet, &foot, slack);
    let part = facet.part(used);
    let height = |c: &V| (c - foot).dot(&m.normal);
    let far = |c: &V| (c - foot).norm();
    let about = || facets.iter().filter(|f| f.has(&part));
    let behind = |f: &Facet<V>| {
        f.corners
            .iter()
            .all(|c| height(c) <= BEHIND * far(c) + slack)
    };
    if !about().all(behind) {
        return false;
    }
    if own_corner {
        return true;
    }
    match used.iter().filter(|u| **u).count() {
        // An edge is sharp where a facet falls away from it, or none follows.
        2 => {
            let falls = |f: &Facet<V>| {
                f.corners
                    .iter()
                    .any(|c| height(c) < -BEHIND * far(c) - slack)
            };
            about().count() == 1 || about().any(falls)
        }
        // Angles about a corner of a plane make a full turn.
        1 => {
            let angle = |f: &Facet<V>| {
                let at = f.names.iter().position(|n| *n == part[0]);
                at.map_or(0.0, |k| f.angle(k))
            };
            about().map(angle).sum::<f64>() < std::f64::consts::TAU * (1.0 - BEHIND)
        }
        _ => false,
    }
}

/// The corners of the part of a facet that a point of it is on.
fn on(facet: &Facet<V>, point: &V, slack: f64) -> [bool; 3] {
    let normal = facet.normal();
    let mut used = [true; 3];
    for k in 0..3 {
        let (a, b) = (facet.corners[k], facet.corners[(k + 1) % 3]);
        let inward = normal.cross(&(b - a)).normalize();
        if (point - a).dot(&inward) <= slack {
            // On this side: without the corner that is not of it.
            used[(k + 2) % 3] = false;
        }
    }
    if used == [false; 3] {
        // Smaller than the slack: the nearest corner.
        let far = |k: &usize| (facet.corners[*k] - point).norm();
        let nearest = (0..3).min_by(|a, b| far(a).total_cmp(&far(b)));
        used[nearest.unwrap_or(0)] = true;
    }
    used
}
