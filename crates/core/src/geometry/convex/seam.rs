//! Seams: adjacent pieces whose faces are flush form one surface.
//!
//! A body that lies slightly too deep on such a surface, because contacts are springs or rigid
//! contacts drift, overlaps the piece that it has just reached less across the seam than from
//! above: the pair alone looks like a body that meets the side of a step. A contact point covered
//! by a third piece is not on the surface. Where all points of a pair are covered, only those faces
//! keep the two apart that have an edge at one of the points and do not lead into the covering
//! piece (the seam of a step is open above the piece next to it); which of three pieces is adjacent
//! to which need not be known. A ball touches only the nearer of two pieces.

use super::passing::{ALIKE, MovingPair, PairMotion, faces};
use super::{ContactPoint, Core, CorePair};
use crate::geometry::space::{Space, VectorLike};

/// Greatest depth below a face at which a pair still lies on it, relative to the size of the
/// smaller piece: the ordinary overlap of springs.
pub const MAX_SEAM_DEPTH: f64 = 0.05;

/// Cosine of the angle from which a face differs from that of a contact.
const OTHER: f64 = 0.99;

/// Cosine of the angle up to which a face continues that of the adjacent piece: free pieces tilt
/// slightly under load.
const PARALLEL: f64 = 0.9999;

/// Distance in front of a covered point in which a face must be open, in slacks: more than the
/// difference in height of pieces that count as flush.
const OPEN: f64 = 4.0;

/// A piece adjacent to one of a pair and near the other; positions are relative to the antagonist's
/// centre.
pub struct AdjacentPiece<'a, S: Space> {
    /// Core.
    pub core: &'a S::Core,
    /// Centre (m).
    pub at: S::Vector,
    /// Rounding (m).
    pub rounding: f64,
    /// Whether it is adjacent to the candidate.
    pub of_candidate: bool,
    /// Side of a key; of two pieces that are equally near the one with the lower number counts.
    pub name: u32,
}

impl<S: Space> AdjacentPiece<'_, S> {
    fn distance(&self, place: &S::Vector) -> f64 {
        self.core.outward(&(*place - self.at)).0 - self.rounding
    }

    /// Returns the position of a contact point on the side that the piece may cover (m).
    fn place(&self, point: &ContactPoint<S::Vector>) -> S::Vector {
        if self.of_candidate {
            point.on_candidate
        } else {
            point.on_antagonist
        }
    }

    fn covers(&self, point: &ContactPoint<S::Vector>, slack: f64) -> bool {
        self.distance(&self.place(point)) <= slack
    }

    /// Returns whether a direction from the antagonist to the candidate leads from a point into the
    /// piece.
    fn blocks(&self, point: &ContactPoint<S::Vector>, normal: &S::Vector, slack: f64) -> bool {
        let outward = if self.of_candidate { -1.0 } else { 1.0 };
        let ahead = self.place(point) + *normal * (outward * OPEN * slack);
        self.distance(&ahead) <= slack
    }
}

/// Returns whether no point overlaps at the end of the step by more than a fraction of the slack.
fn apart_at_end<S: Space>(
    points: &[ContactPoint<S::Vector>],
    apart: &S::Vector,
    slack: f64,
    motion: &PairMotion<S>,
) -> bool {
    let left = points.iter().map(|m| motion.left(m, apart)[0]);
    left.fold(f64::INFINITY, f64::min) >= -ALIKE * slack
}

/// Replaces contact points that lie across a seam by the points of an open face. `deepest` is the
/// depth to which the pair may lie below that face (m), `adjacent` gives the pieces adjacent to the
/// two.
pub fn leave_seam<'a, S: Space + 'a>(
    pair: &CorePair<S>,
    motion: &PairMotion<S>,
    deepest: f64,
    adjacent: impl FnOnce() -> Vec<AdjacentPiece<'a, S>>,
    out: &mut Vec<ContactPoint<S::Vector>>,
) {
    let (cores, slack) = (pair.cores, pair.tolerances.slack);
    if apart_at_end(out, &pair.apart, slack, motion) {
        return;
    }
    let normal = out[0].normal;
    let moving = MovingPair::new(pair, motion);
    let mut others = faces::<S>(cores).filter(|(n, _)| n.dot(&normal) < OTHER);
    if !others.any(|(n, _)| moving.gap(&n, -deepest).is_some()) {
        return;
    }
    let adjacent = adjacent();
    let covered = |m: &ContactPoint<S::Vector>| adjacent.iter().any(|b| b.covers(m, slack));
    if !out.iter().all(covered) {
        return;
    }
    // Of the points on the side of a piece, the upper ones are at its edge, where the adjacent
    // piece continues.
    let open = |n: &S::Vector| {
        let [low, top] = moving.ends(n);
        let at_edge = |b: &AdjacentPiece<S>, m: &ContactPoint<S::Vector>| {
            let height = n.dot(&b.place(m));
            let below = if b.of_candidate {
                height - low
            } else {
                top - height
            };
            below <= OPEN * slack
        };
        let continues = |b: &AdjacentPiece<S>, m: &ContactPoint<S::Vector>| {
            b.covers(m, slack) && at_edge(b, m) && !b.blocks(m, n, slack)
        };
        out.iter().any(|m| adjacent.iter().any(|b| continues(b, m)))
    };
    let open_faces =
        faces::<S>(cores).filter(|(n, _)| moving.gap(n, -deepest).is_some() && open(n));
    let of = open_faces.map(|(n, face)| (moving.left(&n), n, face));
    let Some((_, n, face)) = of.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return;
    };
    if n.dot(&normal) < OTHER {
        out.clear();
        S::Core::points_on_face(pair, face, out);
    }
}

/// An edge at which two pieces meet: one of them lies on a third piece, whose face continues that
/// of the other.
#[derive(Clone, Copy, Debug)]
pub struct SeamEdge<S: Space> {
    /// Side of a key of the piece on which the body lies.
    pub below: u32,
    /// Whether that piece is adjacent to the candidate; the antagonist then lies on it.
    pub of_candidate: bool,
    /// Normal of the faces, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Height of the other piece above the underside of the body that lies on its neighbour (m).
    pub height: f64,
}

/// Returns the edges at which two pieces touch at a point, of heights up to `low`. The pieces
/// adjacent to them are within `near` of the point (m), and their faces differ in height by no more
/// than `low`.
pub fn edges_at<S: Space>(
    pair: &CorePair<S>,
    point: &ContactPoint<S::Vector>,
    [low, near]: [f64; 2],
    adjacent: &[AdjacentPiece<S>],
) -> Vec<SeamEdge<S>> {
    let at_rest = PairMotion {
        shift: S::Vector::zero(),
        turns: [S::Spin::zero(); 2],
    };
    let placed = MovingPair::new(pair, &at_rest);
    let continues = |b: &AdjacentPiece<S>, n: &S::Vector| {
        let [bottom, top] = placed.ends(n);
        let (out, height) = if b.of_candidate {
            (-*n, -bottom)
        } else {
            (*n, top)
        };
        let corners = b.core.corners().iter();
        let reach = corners.map(|q| out.dot(&(b.at + *q)));
        let reach = reach.fold(f64::NEG_INFINITY, f64::max) + b.rounding;
        let faces = b.core.normals();
        (reach - height).abs() <= low
            && b.covers(point, near)
            && faces.iter().any(|m| m.dot(&out) > PARALLEL)
    };
    let mut out = Vec::new();
    for (normal, _) in faces::<S>(pair.cores).filter(|(n, _)| n.dot(&point.normal) < PARALLEL) {
        let Some((gap, _)) = placed.gap(&normal, -low).filter(|(gap, _)| *gap <= low) else {
            continue;
        };
        let below = adjacent.iter().filter(|b| continues(b, &normal));
        out.extend(below.map(|b| SeamEdge {
            below: b.name,
            of_candidate: b.of_candidate,
            normal,
            height: -gap,
        }));
    }
    out
}

/// Returns whether a ball, the candidate, meets a core across a seam: another piece is as near at
/// the point of the core nearest to the ball. `name` is the side of the key of the core.
pub fn ball_is_over_seam<'a, S: Space + 'a>(
    point: &ContactPoint<S::Vector>,
    apart: &S::Vector,
    radius: f64,
    slack: f64,
    name: u32,
    adjacent: impl FnOnce() -> Vec<AdjacentPiece<'a, S>>,
) -> bool {
    let nearer = |b: &AdjacentPiece<S>| {
        let before = b.distance(apart) - radius - point.gap;
        // Rounding may differ when the other piece is the antagonist.
        before < -ALIKE * ALIKE * slack || before <= ALIKE * ALIKE * slack && b.name < name
    };
    let mut of_core = adjacent().into_iter().filter(|b| !b.of_candidate);
    of_core.any(|b| b.covers(point, slack) && nearer(&b))
}
