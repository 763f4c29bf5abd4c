//! Seams: pieces that lie beside each other, flush, are one surface.
//!
//! What lies on them a little too deep, as springs and the drift of rigid contacts have it,
//! overlaps the piece that it has just reached less across the seam than from above: the pair alone
//! is that of a body and the side of a step. A place of the pair that a third piece covers is on
//! the surface of none. Where all places of a pair are covered, only faces keep the two apart that
//! have an edge at one of them and do not lead into what covers it (the seam of a step is open
//! above the piece beside it); which of three pieces lies beside which need not be known. A ball
//! touches the nearer of two pieces alone.

use super::passing::{ALIKE, Pair, PairMotion, faces};
use super::{ContactPoint, ContactTolerances, Core};
use crate::geometry::space::{Space, VectorLike};

/// Depth below a face down to which it is one that a pair lies on, as a fraction of the size of the
/// smaller: what springs ordinarily have.
pub const DEEPEST: f64 = 0.05;

/// Cosine of the angle from which a face is another one than that of a contact.
const OTHER: f64 = 0.99;

/// Cosine of the angle up to which a face goes on as that of the piece beside it: free pieces tilt
/// a little under what they carry.
const PARALLEL: f64 = 0.9999;

/// How far in front of a covered place a face must be open, in slacks: more than pieces that count
/// as flush stand out.
const OPEN: f64 = 4.0;

/// A piece beside one of a pair, which also is near the other; places are relative to the
/// antagonist's centre.
pub struct Beside<'a, S: Space> {
    /// Its core.
    pub core: &'a S::Core,
    /// Its centre (m).
    pub at: S::Vector,
    /// Its rounding (m).
    pub rounding: f64,
    /// Whether it is beside the candidate.
    pub of_candidate: bool,
    /// Its name: of two pieces that are equally near the first counts.
    pub name: u32,
}

impl<S: Space> Beside<'_, S> {
    fn distance(&self, place: &S::Vector) -> f64 {
        self.core.outward(&(*place - self.at)).0 - self.rounding
    }

    /// The place of a contact point that it may cover.
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

    /// Whether a direction from the antagonist to the candidate leads from a point into the piece.
    fn blocks(&self, point: &ContactPoint<S::Vector>, normal: &S::Vector, slack: f64) -> bool {
        let outward = if self.of_candidate { -1.0 } else { 1.0 };
        let ahead = self.place(point) + *normal * (outward * OPEN * slack);
        self.distance(&ahead) <= slack
    }
}

/// Whether points do not overlap by the end of the step, but for what slack allows.
fn apart_at_end<S: Space>(
    points: &[ContactPoint<S::Vector>],
    apart: &S::Vector,
    slack: f64,
    motion: &PairMotion<S>,
) -> bool {
    let left = points.iter().map(|m| motion.left(m, apart)[0]);
    left.fold(f64::INFINITY, f64::min) >= -ALIKE * slack
}

/// Puts the points of an open face in place of those that lie across a seam; `apart` and
/// `roundings` as in [`Core::contact_points`], `deepest` the depth to which the pair may lie below
/// that face (m), and `beside` the pieces beside the two.
#[expect(
    clippy::too_many_arguments,
    reason = "those of the pair, and what is beside it"
)]
pub fn leave_seam<'a, S: Space + 'a>(
    cores: [&S::Core; 2],
    apart: &S::Vector,
    roundings: [f64; 2],
    tolerances: &ContactTolerances,
    motion: &PairMotion<S>,
    deepest: f64,
    beside: impl FnOnce() -> Vec<Beside<'a, S>>,
    out: &mut Vec<ContactPoint<S::Vector>>,
) {
    let slack = tolerances.slack;
    if apart_at_end(out, apart, slack, motion) {
        return;
    }
    let normal = out[0].normal;
    let pair = Pair::<S> {
        corners: cores.map(Core::corners),
        apart: *apart,
        thickness: roundings[0] + roundings[1],
        motion,
    };
    let mut others = faces::<S>(cores).filter(|(n, _)| n.dot(&normal) < OTHER);
    if !others.any(|(n, _)| pair.gap(&n, -deepest).is_some()) {
        return;
    }
    let beside = beside();
    let covered = |m: &ContactPoint<S::Vector>| beside.iter().any(|b| b.covers(m, slack));
    if !out.iter().all(covered) {
        return;
    }
    // Of the places on the side of a piece, the upper ones are at its edge, where the piece beside
    // it goes on.
    let open = |n: &S::Vector| {
        let [low, top] = pair.ends(n, roundings);
        let at_edge = |b: &Beside<S>, m: &ContactPoint<S::Vector>| {
            let height = n.dot(&b.place(m));
            let below = if b.of_candidate {
                height - low
            } else {
                top - height
            };
            below <= OPEN * slack
        };
        let goes_on = |b: &Beside<S>, m: &ContactPoint<S::Vector>| {
            b.covers(m, slack) && at_edge(b, m) && !b.blocks(m, n, slack)
        };
        out.iter().any(|m| beside.iter().any(|b| goes_on(b, m)))
    };
    let open_faces = faces::<S>(cores).filter(|(n, _)| pair.gap(n, -deepest).is_some() && open(n));
    let of = open_faces.map(|(n, face)| (pair.left(&n), n, face));
    let Some((_, n, face)) = of.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return;
    };
    if n.dot(&normal) < OTHER {
        out.clear();
        cores[0].points_on_face(cores[1], apart, roundings, tolerances, face, out);
    }
}

/// An edge at which two pieces meet: one of the two lies on a third piece, whose face goes on as
/// that of the other one.
#[derive(Clone, Copy, Debug)]
pub struct Edge<S: Space> {
    /// The name of the piece that the body lies on.
    pub below: u32,
    /// Whether it is beside the candidate: then the antagonist lies on it.
    pub of_candidate: bool,
    /// Normal of the faces, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// How far the other one stands out above what lies on its neighbour (m).
    pub height: f64,
}

/// The edges at which two pieces touch at a point, of heights up to `low`. The pieces beside them
/// are within `near` of the point (m), and their faces differ in height by no more than `low`.
/// `apart` and `roundings` as in [`Core::contact_points`].
pub fn edges_at<S: Space>(
    cores: [&S::Core; 2],
    apart: &S::Vector,
    roundings: [f64; 2],
    point: &ContactPoint<S::Vector>,
    [low, near]: [f64; 2],
    beside: &[Beside<S>],
) -> Vec<Edge<S>> {
    let pair = Pair::<S> {
        corners: cores.map(Core::corners),
        apart: *apart,
        thickness: roundings[0] + roundings[1],
        motion: &PairMotion {
            shift: S::Vector::zero(),
            turns: [S::Spin::zero(); 2],
        },
    };
    let goes_on = |b: &Beside<S>, n: &S::Vector| {
        let [bottom, top] = pair.ends(n, roundings);
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
    for (normal, _) in faces::<S>(cores).filter(|(n, _)| n.dot(&point.normal) < PARALLEL) {
        let Some((gap, _)) = pair.gap(&normal, -low).filter(|(gap, _)| *gap <= low) else {
            continue;
        };
        let below = beside.iter().filter(|b| goes_on(b, &normal));
        out.extend(below.map(|b| Edge {
            below: b.name,
            of_candidate: b.of_candidate,
            normal,
            height: -gap,
        }));
    }
    out
}

/// Whether a ball, the candidate, meets a core across a seam: where that is nearest to it, another
/// piece is as near. `name` is that of the core.
pub fn ball_is_over_seam<'a, S: Space + 'a>(
    point: &ContactPoint<S::Vector>,
    apart: &S::Vector,
    radius: f64,
    slack: f64,
    name: u32,
    beside: impl FnOnce() -> Vec<Beside<'a, S>>,
) -> bool {
    let nearer = |b: &Beside<S>| {
        let before = b.distance(apart) - radius - point.gap;
        // Seen from the other one, rounding may differ.
        before < -ALIKE * ALIKE * slack || before <= ALIKE * ALIKE * slack && b.name < name
    };
    let mut of_core = beside().into_iter().filter(|b| !b.of_candidate);
    of_core.any(|b| b.covers(point, slack) && nearer(&b))
}
