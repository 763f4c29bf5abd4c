//! Clipping of the opposite face to the sides of a reference face (Sutherland and Hodgman, 1974).

use super::polyhedron::Polyhedron;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Names of contact points. A corner or a crossing of two edges has the same name for either
/// reference face.
pub mod name {
    use super::super::polyhedron::MAX_EDGES;

    /// Returns the name of a corner of the candidate or of the antagonist.
    pub fn corner(corner: usize, of_candidate: bool) -> u64 {
        4 * corner as u64 + u64::from(!of_candidate)
    }

    /// Returns the name of the crossing of an edge of the candidate with one of the antagonist.
    pub fn crossing(of_candidate: usize, of_antagonist: usize) -> u64 {
        4 * (of_candidate * MAX_EDGES + of_antagonist) as u64 + 2
    }

    /// Returns the name with candidate and antagonist exchanged.
    pub fn from_other_side(feature: u64) -> u64 {
        if feature % 4 < 2 {
            return feature ^ 1;
        }
        let (edges, most) = (feature / 4, MAX_EDGES as u64);
        4 * ((edges % most) * most + edges / most) + 2
    }
}

/// A reference face and its opposite. Vectors are relative to the reference polyhedron's centre.
pub struct Lead<'a> {
    /// The polyhedron of the reference face.
    pub own: &'a Polyhedron,
    /// The other one.
    pub other: &'a Polyhedron,
    /// The reference face.
    pub face: usize,
    /// Centre of the other polyhedron (m).
    pub apart: V,
    /// Whether the reference face belongs to the candidate.
    pub of_candidate: bool,
}

/// A point of the opposite face.
pub struct ClipPoint {
    /// Position (m).
    pub at: V,
    /// Height above the reference face (m).
    pub height: f64,
    /// Outward normal of the reference face.
    pub normal: V,
    /// Name.
    pub feature: u64,
    /// Radius of a disk with its fraction of the common area (m).
    pub share: f64,
    /// Whether the two faces are parallel.
    pub facing: bool,
}

/// Origin of a side of the current polygon.
#[derive(Clone, Copy)]
enum ClipSide {
    /// An edge of the other polyhedron.
    Other(usize),
    /// A side of the reference face.
    Lead(usize),
}

/// A corner of the current polygon, and the side that starts at it.
#[derive(Clone, Copy)]
struct ClipCorner {
    at: V,
    feature: u64,
    side: ClipSide,
}

/// Returns the points of the opposite face that are above the reference face, or beside it by at
/// most `slack` (m).
pub fn clip(lead: &Lead, slack: f64) -> Vec<ClipPoint> {
    let normal = lead.own.normals()[lead.face];
    let mut polygon = facing(lead, &normal);
    let sides = &lead.own.topology().sides[lead.face];
    let corners: Vec<V> = lead.own.face(lead.face).collect();
    for k in 0..corners.len() {
        let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
        let inward = normal.cross(&(to - from)).normalize();
        let depth = |c: &ClipCorner| (c.at - from).dot(&inward);
        let mut clipped = Vec::with_capacity(polygon.len() + 2);
        for (i, now) in polygon.iter().enumerate() {
            let next = &polygon[(i + 1) % polygon.len()];
            let (d, e) = (depth(now), depth(next));
            let (inside, next_inside) = (d >= -slack, e >= -slack);
            if inside {
                clipped.push(*now);
            }
            if inside != next_inside {
                let at = now.at + (next.at - now.at) * (d / (d - e)).clamp(0.0, 1.0);
                clipped.push(ClipCorner {
                    at,
                    feature: lead.name(now.side, k, sides),
                    side: if inside { ClipSide::Lead(k) } else { now.side },
                });
            }
        }
        polygon = clipped;
    }
    merge(&mut polygon, slack);
    let (share, facing) = (share(&polygon, &normal), lead.other.faces(&normal));
    let height = |c: &ClipCorner| (c.at - corners[0]).dot(&normal);
    polygon
        .iter()
        .map(|c| ClipPoint {
            at: c.at,
            height: height(c),
            normal,
            feature: c.feature,
            share,
            facing,
        })
        .collect()
}

/// Returns the face of the other polyhedron opposite the reference face; for a segment its edge.
fn facing(lead: &Lead, normal: &V) -> Vec<ClipCorner> {
    let topology = lead.other.topology();
    let corner = |c: u32, side: u32| ClipCorner {
        at: lead.other.points()[c as usize] + lead.apart,
        feature: name::corner(c as usize, !lead.of_candidate),
        side: ClipSide::Other(side as usize),
    };
    match lead.other.facing(normal) {
        Some(f) => {
            let sides = topology.sides[f].iter();
            topology.faces[f]
                .iter()
                .zip(sides)
                .map(|(c, s)| corner(*c, *s))
                .collect()
        }
        None => vec![corner(0, 0), corner(1, 0)],
    }
}

impl Lead<'_> {
    /// Returns the name of the point where a side of the current polygon crosses side `k` of the
    /// reference face.
    fn name(&self, side: ClipSide, k: usize, sides: &[u32]) -> u64 {
        let edge = |k: usize| sides[k] as usize;
        match side {
            ClipSide::Other(other) if self.of_candidate => name::crossing(edge(k), other),
            ClipSide::Other(other) => name::crossing(other, edge(k)),
            ClipSide::Lead(j) => {
                // Side j goes from corner j to the next.
                let corner = if j == (k + 1) % sides.len() { j } else { k };
                let corner = self.own.topology().faces[self.face][corner];
                name::corner(corner as usize, self.of_candidate)
            }
        }
    }
}

/// Removes points closer than `slack` to the previous one.
fn merge(polygon: &mut Vec<ClipCorner>, slack: f64) {
    polygon.dedup_by(|b, a| (b.at - a.at).norm() <= slack);
    while polygon.len() > 1 && (polygon[0].at - polygon[polygon.len() - 1].at).norm() <= slack {
        polygon.pop();
    }
}

fn share(polygon: &[ClipCorner], normal: &V) -> f64 {
    let n = polygon.len();
    if n < 3 {
        return 0.0;
    }
    let from = |k: usize| polygon[k].at - polygon[0].at;
    let area: f64 = (1..n - 1)
        .map(|k| 0.5 * from(k).cross(&from(k + 1)).dot(normal))
        .sum();
    (area.abs() / (n as f64 * std::f64::consts::PI)).sqrt()
}
