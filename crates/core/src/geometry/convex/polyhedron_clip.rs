//! The face that faces a leading face, cut off at its sides (Sutherland and Hodgman, 1974).

use super::polyhedron::Polyhedron;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Names of contact points. A corner or a crossing of two edges has the same name whichever face leads.
pub mod name {
    use super::super::polyhedron::MAX_EDGES;

    /// A corner of the candidate or of the antagonist.
    pub fn corner(corner: usize, of_candidate: bool) -> u64 {
        4 * corner as u64 + u64::from(!of_candidate)
    }

    /// An edge of the candidate over one of the antagonist.
    pub fn crossing(of_candidate: usize, of_antagonist: usize) -> u64 {
        4 * (of_candidate * MAX_EDGES + of_antagonist) as u64 + 2
    }

    /// The name where the antagonist is taken for the candidate.
    pub fn from_other_side(feature: u64) -> u64 {
        if feature % 4 < 2 {
            return feature ^ 1;
        }
        let (edges, most) = (feature / 4, MAX_EDGES as u64);
        4 * ((edges % most) * most + edges / most) + 2
    }
}

/// A face and what faces it. Vectors are relative to the leading polyhedron's centre.
pub struct Lead<'a> {
    /// The polyhedron whose face leads.
    pub own: &'a Polyhedron,
    /// The other one.
    pub other: &'a Polyhedron,
    /// The leading face.
    pub face: usize,
    /// Where the other one's centre stands (m).
    pub apart: V,
    /// Whether the leading face is the candidate's.
    pub of_candidate: bool,
}

/// A point of the facing face.
pub struct Point {
    /// Where it is (m).
    pub at: V,
    /// Its height over the leading face (m).
    pub height: f64,
    /// Outward normal of the leading face.
    pub normal: V,
    /// Its name.
    pub feature: u64,
    /// Radius of a disk with its part of the common area (m).
    pub share: f64,
    /// Whether the two faces lie along each other.
    pub facing: bool,
}

/// What a side of the polygon at hand lies along.
#[derive(Clone, Copy)]
enum Side {
    /// An edge of the other polyhedron.
    Other(usize),
    /// A side of the leading face.
    Lead(usize),
}

/// A corner of the polygon at hand, and the side that begins in it.
#[derive(Clone, Copy)]
struct Corner {
    at: V,
    feature: u64,
    side: Side,
}

/// The points of the facing face that are over the leading one, or beside it by no more than `slack` (m).
pub fn clip(lead: &Lead, slack: f64) -> Vec<Point> {
    let normal = lead.own.normals()[lead.face];
    let mut polygon = facing(lead, &normal);
    let sides = &lead.own.topology().sides[lead.face];
    let corners: Vec<V> = lead.own.face(lead.face).collect();
    for k in 0..corners.len() {
        let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
        let inward = normal.cross(&(to - from)).normalize();
        let depth = |c: &Corner| (c.at - from).dot(&inward);
        let mut kept = Vec::with_capacity(polygon.len() + 2);
        for (i, now) in polygon.iter().enumerate() {
            let next = &polygon[(i + 1) % polygon.len()];
            let (d, e) = (depth(now), depth(next));
            let (inside, goes_on) = (d >= -slack, e >= -slack);
            if inside {
                kept.push(*now);
            }
            if inside != goes_on {
                let at = now.at + (next.at - now.at) * (d / (d - e)).clamp(0.0, 1.0);
                kept.push(Corner {
                    at,
                    feature: lead.name(now.side, k, sides),
                    side: if inside { Side::Lead(k) } else { now.side },
                });
            }
        }
        polygon = kept;
    }
    merge(&mut polygon, slack);
    let (share, facing) = (share(&polygon, &normal), lead.other.faces(&normal));
    let height = |c: &Corner| (c.at - corners[0]).dot(&normal);
    polygon
        .iter()
        .map(|c| Point {
            at: c.at,
            height: height(c),
            normal,
            feature: c.feature,
            share,
            facing,
        })
        .collect()
}

/// The face of the other polyhedron that faces the leading one; the edge, of a segment.
fn facing(lead: &Lead, normal: &V) -> Vec<Corner> {
    let topology = lead.other.topology();
    let corner = |c: u32, side: u32| Corner {
        at: lead.other.points()[c as usize] + lead.apart,
        feature: name::corner(c as usize, !lead.of_candidate),
        side: Side::Other(side as usize),
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
    /// The name of the point where a side of the polygon at hand crosses side `k` of the leading face.
    fn name(&self, side: Side, k: usize, sides: &[u32]) -> u64 {
        let edge = |k: usize| sides[k] as usize;
        match side {
            Side::Other(other) if self.of_candidate => name::crossing(edge(k), other),
            Side::Other(other) => name::crossing(other, edge(k)),
            Side::Lead(j) => {
                // Side j goes from corner j to the next.
                let corner = if j == (k + 1) % sides.len() { j } else { k };
                let corner = self.own.topology().faces[self.face][corner];
                name::corner(corner as usize, self.of_candidate)
            }
        }
    }
}

/// Of points nearer than `slack` to the one before only that one stays.
fn merge(polygon: &mut Vec<Corner>, slack: f64) {
    polygon.dedup_by(|b, a| (b.at - a.at).norm() <= slack);
    while polygon.len() > 1 && (polygon[0].at - polygon[polygon.len() - 1].at).norm() <= slack {
        polygon.pop();
    }
}

fn share(polygon: &[Corner], normal: &V) -> f64 {
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
