//! Convex polyhedra cut by planes. Each corner carries the labels of the three planes that meet
//! there.
//!
//! Two corners that share two planes are the ends of an edge, so edges need not be stored.

use fretwork_core::geometry::convex::polyhedron::across;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// A corner, and the three planes that meet there.
#[derive(Clone, Copy, Debug)]
pub struct Corner<L> {
    /// Position (m).
    pub at: V,
    /// The planes.
    pub sides: [L; 3],
}

impl<L: Copy + PartialEq> Corner<L> {
    /// The two planes of the edge between two corners; `None` if no edge joins them.
    pub fn edge(&self, other: &Self) -> Option<[L; 2]> {
        let [a, b, c] = self.sides;
        let on = |s: L| other.sides.contains(&s);
        match (on(a), on(b), on(c)) {
            (true, true, false) => Some([a, b]),
            (true, false, true) => Some([a, c]),
            (false, true, true) => Some([b, c]),
            _ => None,
        }
    }
}

/// Cuts off the part above a plane, where the dot product of a point and the normal exceeds
/// `height` (m). Returns whether anything was cut off.
pub fn cut<L: Copy + PartialEq>(
    corners: &mut Vec<Corner<L>>,
    side: L,
    normal: &V,
    height: f64,
) -> bool {
    let over = |c: &Corner<L>| c.at.dot(normal) - height;
    // Early exit: most planes cut nothing off.
    if !corners.iter().any(|c| over(c) > 0.0) {
        return false;
    }
    let (off, mut kept): (Vec<Corner<L>>, Vec<Corner<L>>) =
        corners.iter().partition(|c| over(c) > 0.0);
    let whole = kept.len();
    for o in &off {
        for k in 0..whole {
            let Some([a, b]) = o.edge(&kept[k]) else {
                continue;
            };
            let (high, low) = (over(o), over(&kept[k]));
            let at = kept[k].at + (o.at - kept[k].at) * (low / (low - high));
            let sides = [a, b, side];
            kept.push(Corner { at, sides });
        }
    }
    *corners = kept;
    true
}

/// The corners on a plane, counter-clockwise seen from outside.
pub fn ordered<L: Copy + PartialEq>(corners: &[Corner<L>], side: L, normal: &V) -> Vec<u32> {
    let mut on: Vec<u32> = (0..corners.len() as u32)
        .filter(|k| corners[*k as usize].sides.contains(&side))
        .collect();
    let at = |k: &u32| corners[*k as usize].at;
    let middle = on.iter().map(at).sum::<V>() / on.len() as f64;
    let right = across(normal);
    let up = normal.cross(&right);
    let angle = |k: &u32| {
        let way = at(k) - middle;
        way.dot(&up).atan2(way.dot(&right))
    };
    on.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    on
}

/// The planes, sorted.
pub fn sides_of<L: Copy + Ord>(corners: &[Corner<L>]) -> Vec<L> {
    let mut sides: Vec<L> = corners.iter().flat_map(|c| c.sides).collect();
    sides.sort_unstable();
    sides.dedup();
    sides
}

/// Centroid of a polyhedron that contains the origin (m).
pub fn centre<L: Copy + Ord>(corners: &[Corner<L>]) -> V {
    let (mut first, mut volume) = (V::zeros(), 0.0);
    for side in sides_of(corners) {
        // The origin is inside: a face's outward normal points towards its corners.
        let on = || corners.iter().filter(|c| c.sides.contains(&side));
        let [a, b, c] = {
            let mut at = on().map(|c| c.at);
            [at.next(), at.next(), at.next()].map(|p| p.unwrap_or_default())
        };
        let across = (b - a).cross(&(c - a));
        let Some(across) = across.try_normalize(0.0) else {
            continue;
        };
        let outward = if across.dot(&a) < 0.0 {
            -across
        } else {
            across
        };
        let face = ordered(corners, side, &outward);
        let at = |k: usize| corners[face[k] as usize].at;
        for k in 1..face.len().saturating_sub(1) {
            let part = at(0).dot(&at(k).cross(&at(k + 1))) / 6.0;
            first += (at(0) + at(k) + at(k + 1)) * (0.25 * part);
            volume += part;
        }
    }
    first / volume
}
