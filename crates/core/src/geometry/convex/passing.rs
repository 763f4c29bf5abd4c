//! Convex bodies that pass each other closer than they move in a step.
//!
//! The direction between two corners is the normal of the current gap, not of the gap at the end of
//! the step. A constraint along it would stop a body at an obstacle that it passes, and a box that
//! slides over flush boxes at the side of the next box. Every plane between the bodies keeps them
//! apart. If the nearest points would close within the step, they are replaced by the plane of the
//! face with the largest gap at the end of the step: the axis along which the bodies stay separate
//! for the longest time.

use super::{ContactPoint, ContactTolerances, Core, CorePair};
use crate::geometry::shape::{Fan, Surface};
use crate::geometry::space::{Space, VectorLike};

/// Additional room that a plane must leave compared with the nearest points, as a fraction of the
/// slack; half of the closing distance if that is smaller.
pub(super) const ALIKE: f64 = 1e-3;

/// Closing distance that is rounding, as a fraction of the slack.
const ROUNDING: f64 = 1e-9;

/// Fraction of a distance by which a position may be in front of a plane and still count as behind
/// it.
const BEHIND: f64 = 1e-9;

/// Relative motion of a pair in a step, to first order.
#[derive(Clone, Copy, Debug)]
pub struct PairMotion<S: Space> {
    /// Displacement of the candidate's centre relative to that of the antagonist (m).
    pub shift: S::Vector,
    /// Rotations of candidate and antagonist (rad).
    pub turns: [S::Spin; 2],
}

impl<S: Space> PairMotion<S> {
    /// The motion in the axes of a frame.
    #[must_use]
    pub fn seen_from(&self, rotation: &S::Rotation) -> Self {
        Self {
            shift: S::unrotate(rotation, &self.shift),
            turns: self.turns.map(|turn| S::unrotate_spin(rotation, &turn)),
        }
    }

    /// Returns the displacement of a point of the candidate relative to one of the antagonist, each
    /// given from its centre (m).
    fn of(&self, on_candidate: &S::Vector, on_antagonist: &S::Vector) -> S::Vector {
        let [turn, other] = &self.turns;
        self.shift + S::spin_velocity(turn, on_candidate) - S::spin_velocity(other, on_antagonist)
    }

    /// Returns the gap at a point at the end of the step (m), and its change.
    pub(super) fn left(&self, point: &ContactPoint<S::Vector>, apart: &S::Vector) -> [f64; 2] {
        let moved = self.of(&(point.on_candidate - *apart), &point.on_antagonist);
        let change = point.normal.dot(&moved);
        [point.gap + change, change]
    }

    /// Returns the gap at a point at the end of the step (m), if it closes in the step.
    fn closing(
        &self,
        point: &ContactPoint<S::Vector>,
        apart: &S::Vector,
        slack: f64,
    ) -> Option<f64> {
        let [left, change] = self.left(point, apart);
        let rounding = ROUNDING * slack;
        (change < -rounding && left < -rounding).then_some(left)
    }
}

/// Returns the gap that a plane must leave at the end of the step to replace points that leave
/// `least` (m).
fn room(least: f64, slack: f64) -> f64 {
    (least + ALIKE * slack).min(0.5 * least)
}

/// A face of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairFace {
    /// Whether the face belongs to the candidate.
    pub of_candidate: bool,
    /// Index of the face.
    pub face: usize,
}

/// The corners of a pair and their motion in a step.
pub(super) struct MovingPair<'a, S: Space> {
    /// Corners of candidate and antagonist, from their centres (m).
    corners: [&'a [S::Vector]; 2],
    /// Centre of the candidate relative to that of the antagonist (m).
    apart: S::Vector,
    /// Rounding radii (m).
    roundings: [f64; 2],
    motion: &'a PairMotion<S>,
}

/// A direction from the antagonist to the candidate, with the positions of both along it.
struct Plane<V> {
    normal: V,
    /// Gap along the direction (m).
    gap: f64,
    /// Face that has this normal.
    face: Option<PairFace>,
    /// Point of the candidate that is lowest along the direction, from the antagonist's centre,
    /// without rounding radius (m).
    lowest: V,
}

impl<'a, S: Space> MovingPair<'a, S> {
    pub(super) fn new(pair: &CorePair<'a, S>, motion: &'a PairMotion<S>) -> Self {
        Self {
            corners: pair.cores.map(Core::corners),
            apart: pair.apart,
            roundings: pair.roundings,
            motion,
        }
    }

    fn thickness(&self) -> f64 {
        self.roundings[0] + self.roundings[1]
    }

    /// Returns the current gap along a direction (m), and the point of the candidate that is lowest
    /// along it; `None` where the gap is less than `least`.
    pub(super) fn gap(&self, normal: &S::Vector, least: f64) -> Option<(f64, S::Vector)> {
        let [a, b] = self.corners;
        let top = b.iter().map(|q| normal.dot(q));
        let below = top.fold(f64::NEG_INFINITY, f64::max) + self.thickness();
        let (mut gap, mut lowest) = (f64::INFINITY, self.apart);
        for p in a {
            let now = *p + self.apart;
            let height = normal.dot(&now) - below;
            if height < least {
                return None;
            }
            if height < gap {
                (gap, lowest) = (height, now);
            }
        }
        Some((gap, lowest))
    }

    /// Returns the lowest coordinate of the candidate and the highest of the antagonist along a
    /// direction (m).
    pub(super) fn ends(&self, normal: &S::Vector) -> [f64; 2] {
        let ([a, b], roundings) = (self.corners, self.roundings);
        let low = a.iter().map(|p| normal.dot(&(*p + self.apart)));
        let top = b.iter().map(|q| normal.dot(q));
        [
            low.fold(f64::INFINITY, f64::min) - roundings[0],
            top.fold(f64::NEG_INFINITY, f64::max) + roundings[1],
        ]
    }

    /// Returns the gap along a direction at the end of the step (m).
    pub(super) fn left(&self, normal: &S::Vector) -> f64 {
        let ([a, b], [turn, other]) = (self.corners, &self.motion.turns);
        let shift = self.apart + self.motion.shift;
        let end = |p: &S::Vector| normal.dot(&(*p + S::spin_velocity(turn, p)));
        let low = a.iter().map(end).fold(f64::INFINITY, f64::min);
        let end = |q: &S::Vector| normal.dot(&(*q + S::spin_velocity(other, q)));
        let top = b.iter().map(end).fold(f64::NEG_INFINITY, f64::max);
        normal.dot(&shift) + low - top - self.thickness()
    }
}

/// The normals of the faces of a pair, from the antagonist to the candidate.
pub(super) fn faces<S: Space>(cores: [&S::Core; 2]) -> impl Iterator<Item = (S::Vector, PairFace)> {
    let of = move |of_candidate: bool| {
        let normals = cores[usize::from(!of_candidate)].normals().iter();
        let sign = if of_candidate { -1.0 } else { 1.0 };
        let named =
            move |(face, n): (usize, &S::Vector)| (*n * sign, PairFace { of_candidate, face });
        normals.enumerate().map(named)
    };
    of(true).chain(of(false))
}

/// Replaces the contact points of a pair by points on a plane that keeps the two apart, if they
/// close in the step although the pair passes.
pub fn keep_apart<S: Space>(
    pair: &CorePair<S>,
    motion: &PairMotion<S>,
    out: &mut Vec<ContactPoint<S::Vector>>,
) {
    let (cores, roundings, slack) = (pair.cores, pair.roundings, pair.tolerances.slack);
    let closing = out.iter().filter_map(|m| {
        let left = motion.closing(m, &pair.apart, slack)?;
        Some((left, *m))
    });
    let Some((least, nearest)) = closing.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return;
    };
    let moving = MovingPair::new(pair, motion);
    let sideways = sideways::<S>(&nearest, pair.thickness(), &pair.apart, motion);
    let planes = faces::<S>(cores).map(|(n, face)| (n, Some(face)));
    let mut room = room(least, slack);
    let mut best: Option<Plane<S::Vector>> = None;
    for (normal, face) in planes.chain(sideways.map(|n| (n, None))) {
        let Some((gap, lowest)) = moving.gap(&normal, -slack) else {
            continue;
        };
        let left = moving.left(&normal);
        if left > room {
            room = left;
            best = Some(Plane {
                normal,
                gap,
                face,
                lowest,
            });
        }
    }
    let Some(plane) = best else {
        return;
    };
    out.clear();
    if let Some(face) = plane.face {
        S::Core::points_on_face(pair, face, out);
        return;
    }
    let n = plane.normal;
    out.push(ContactPoint {
        on_candidate: plane.lowest - n * roundings[0],
        on_antagonist: plane.lowest - n * (roundings[0] + plane.gap),
        normal: n,
        gap: plane.gap,
        share: 0.0,
        facing: false,
        ..nearest
    });
}

/// Returns the direction across the motion of the nearest points, to the side on which the
/// candidate passes.
fn sideways<S: Space>(
    nearest: &ContactPoint<S::Vector>,
    thickness: f64,
    apart: &S::Vector,
    motion: &PairMotion<S>,
) -> Option<S::Vector> {
    let way = nearest.normal * (nearest.gap + thickness);
    let moved = motion.of(&(nearest.on_candidate - *apart), &nearest.on_antagonist);
    let along = way.dot(&moved) / moved.dot(&moved);
    let across = way - moved * along;
    let length = across.norm();
    // A vector of the size of rounding errors has no direction.
    (length > ALIKE * way.norm()).then(|| across * (1.0 / length))
}

/// Keeps a ball (the candidate) apart from a convex core that it passes within the step: moves the
/// contact to the plane between both.
pub fn keep_ball_apart<S: Space>(
    core: &S::Core,
    apart: &S::Vector,
    [radius, rounding]: [f64; 2],
    tolerances: &ContactTolerances,
    motion: &PairMotion<S>,
    point: &mut ContactPoint<S::Vector>,
) {
    let Some(least) = motion.closing(point, apart, tolerances.slack) else {
        return;
    };
    let centre = [S::Vector::zero()];
    let pair = MovingPair::<S> {
        corners: [&centre, core.corners()],
        apart: *apart,
        roundings: [radius, rounding],
        motion,
    };
    let sideways = sideways::<S>(point, radius + rounding, apart, motion);
    let mut room = room(least, tolerances.slack);
    for n in core.normals().iter().copied().chain(sideways) {
        let Some((gap, _)) = pair.gap(&n, -tolerances.slack) else {
            continue;
        };
        let left = pair.left(&n);
        if left > room {
            room = left;
            *point = ContactPoint {
                on_candidate: *apart - n * radius,
                // Collinear with the other point, so that impulses there exert no moment on the
                // pair, even if this point is beside the face.
                on_antagonist: *apart - n * (radius + gap),
                normal: n,
                gap,
                // The core is beside the ball.
                facing: false,
                ..*point
            };
        }
    }
}

/// Keeps a core, centred at `at` in the frame of a surface, apart from the points of the surface
/// that it passes within the step: by a plane through each point, if the faces around that point
/// lie behind the plane.
pub fn keep_apart_from_surface<S: Space>(
    core: &S::Core,
    surface: &dyn Surface<S>,
    at: &S::Vector,
    rounding: f64,
    tolerances: &ContactTolerances,
    motion: &PairMotion<S>,
    out: &mut [ContactPoint<S::Vector>],
) {
    let alike = ALIKE * tolerances.slack;
    let mut fan = Fan::default();
    for point in out {
        let Some(least) = motion.closing(point, at, tolerances.slack) else {
            continue;
        };
        fan.normals.clear();
        fan.spokes.clear();
        surface.fan(&point.on_antagonist, alike, &mut fan);
        let sideways = sideways::<S>(point, rounding, at, motion);
        let own = core.normals().iter().map(|n| -*n);
        let foot = point.on_antagonist;
        let mut room = room(least, tolerances.slack);
        for n in fan.normals.iter().copied().chain(own).chain(sideways) {
            let rises = |spoke: &S::Vector| spoke.dot(&n) > BEHIND * spoke.norm() + alike;
            if fan.spokes.is_empty() || fan.spokes.iter().any(rises) {
                continue;
            }
            let (mut gap, mut left, mut lowest) = (f64::INFINITY, f64::INFINITY, foot);
            for p in core.corners() {
                let from = *at + *p - foot;
                if n.dot(&from) < gap {
                    (gap, lowest) = (n.dot(&from), *at + *p);
                }
                left = left.min(n.dot(&(from + motion.of(p, &foot))));
            }
            (gap, left) = (gap - rounding, left - rounding);
            if gap >= -tolerances.slack && left > room {
                room = left;
                *point = ContactPoint {
                    on_candidate: lowest - n * rounding,
                    on_antagonist: lowest - n * (rounding + gap),
                    normal: n,
                    gap,
                    facing: false,
                    ..*point
                };
            }
        }
    }
}
