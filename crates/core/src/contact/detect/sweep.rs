//! Continuous collision detection: follows two fast bodies through a step to find when and where
//! they meet.
//!
//! Conservative advancement: the gap cannot close faster than the bodies approach, so that the time
//! in which they cannot meet is skipped (Mirtich, "Impulse-based dynamic simulation of rigid body
//! systems", 1996, section 2.3). Where that gives small increments, the motion advances by a
//! fraction of the half thickness of the thinner body; a penetration missed in this way is
//! shallower than that.

use super::CollisionScene;
use super::extents::Extents;
use crate::contact::network::{Contact, ContactGeometry, Key, ShapeIndex};
use crate::geometry::convex::{
    ContactPoint, ContactTolerances, ConvexCollider, Core, CorePair, MAX_CORNER_DEPTH,
};
use crate::geometry::shape::{Ball, Carried, ClosestPoint, reduced_radius};
use crate::geometry::space::{Space, VectorLike};

/// The bodies, and their velocities over the step.
pub(super) struct PairSweep<'a, S: Space> {
    pub scene: &'a CollisionScene<'a, S>,
    pub extents: &'a Extents,
    pub velocities: &'a [(S::Vector, S::Spin)],
    pub time: f64,
    pub h: f64,
    pub alert: f64,
}

/// Collision shape of a body; for a ball also its size, for a piece half its smallest thickness
/// (m).
#[derive(Clone, Copy)]
enum Shape<'a, S: Space> {
    Ball(&'a Ball<S>, f64),
    ConvexCollider(&'a ConvexCollider<S>, f64),
    Surface(&'a Carried<S>),
}

impl<S: Space> Shape<'_, S> {
    fn body(&self) -> u32 {
        match self {
            Self::Ball(b, _) => b.body,
            Self::ConvexCollider(p, _) => p.body,
            Self::Surface(s) => s.body,
        }
    }

    fn material(&self) -> u16 {
        match self {
            Self::Ball(b, _) => b.material,
            Self::ConvexCollider(p, _) => p.material,
            Self::Surface(s) => s.material,
        }
    }

    fn offset(&self) -> &S::Vector {
        match self {
            Self::Ball(b, _) => &b.offset,
            Self::ConvexCollider(p, _) => &p.offset,
            Self::Surface(s) => &s.offset,
        }
    }

    /// Returns the radius of its bounding ball (m).
    fn bound(&self) -> f64 {
        match self {
            Self::Ball(b, _) => b.radius,
            Self::ConvexCollider(p, _) => p.bound,
            Self::Surface(_) => 0.0,
        }
    }

    /// Returns half of its smallest thickness (m).
    fn half_thickness(&self) -> f64 {
        match self {
            Self::Ball(_, size) => *size,
            Self::ConvexCollider(_, half) => *half,
            Self::Surface(_) => f64::INFINITY,
        }
    }

    /// Returns its size in the reduced radius of a single-point contact (m), given the length of
    /// each body.
    fn size(&self, lengths: &[f64]) -> f64 {
        match self {
            Self::Ball(b, _) => b.contact_radius(lengths),
            Self::ConvexCollider(p, _) => p.size,
            Self::Surface(_) => f64::INFINITY,
        }
    }
}

/// Position and orientation of a body and one of its shapes.
struct Pose<S: Space> {
    body: S::Vector,
    rotation: S::Rotation,
    centre: S::Vector,
}

/// A gap evaluated at one time.
struct Probe<V> {
    /// The gap, or a lower bound of it (m).
    gap: f64,
    /// The normal if both shapes are convex: the gap closes along it no faster than the bodies
    /// approach.
    normal: Option<V>,
}

/// Result of following a pair through the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SweepResult {
    /// The bodies do not meet.
    Separate,
    /// The bodies meet after this fraction of the step.
    Meets(f64),
    /// The bodies rotate or move too far to be followed.
    Unresolved,
}

/// A pair of collision shapes and its relative motion.
pub(super) struct SweptPair<'a, S: Space> {
    names: (u32, u32),
    shapes: [Shape<'a, S>; 2],
    /// Velocity of the candidate's body relative to the antagonist's (m/s).
    approach: S::Vector,
    /// Upper bound of the speed that rotation adds to any point (m/s).
    turning: f64,
    /// Offset of the nearest periodic image of the antagonist (m).
    image: S::Vector,
    /// Half thickness of the thinner shape (m).
    pub half_thickness: f64,
    /// Penetration up to which a surface detects the other shape (m): farther behind it there may
    /// be another part of it.
    pub detectable: f64,
    /// Largest relative displacement of two of their points in the step (m).
    pub travel: f64,
}

impl<'a, S: Space> SweptPair<'a, S> {
    pub fn bodies(&self) -> [u32; 2] {
        [self.shapes[0].body(), self.shapes[1].body()]
    }

    /// Upper bound of the speed at which a gap with this normal closes (m/s).
    pub fn closing_speed(&self, normal: &S::Vector) -> f64 {
        (-normal.dot(&self.approach)).max(0.0) + self.turning
    }

    pub fn materials(&self) -> [u16; 2] {
        [self.shapes[0].material(), self.shapes[1].material()]
    }
}

/// Smallest increment of the motion, as a fraction of the half thickness.
const STRIDE: f64 = 0.25;
/// Largest increment of the motion, as a fraction of the penetration that remains detectable.
const DETECTABLE: f64 = 0.5;
/// Maximum number of evaluations per pair and step.
const MAX_INSTANTS: usize = 2000;
/// Smallest evaluated increment, as a fraction of the detectable penetration.
const MIN_INCREMENT: f64 = 0.01;
/// Accuracy of the time of a meeting, as a displacement relative to the half thickness.
const EXACT: f64 = 1e-3;

impl<'a, S: Space> PairSweep<'a, S> {
    fn shape(&self, name: u32) -> Shape<'a, S> {
        let CollisionScene { shapes, bodies, .. } = *self.scene;
        match ShapeIndex::of(name) {
            ShapeIndex::Ball(k) => {
                Shape::Ball(&shapes.balls[k], shapes.balls[k].size(&bodies.length))
            }
            ShapeIndex::Piece(k) => {
                Shape::ConvexCollider(&shapes.pieces[k], self.extents.pieces[k])
            }
            ShapeIndex::Surface(k) => Shape::Surface(&shapes.surfaces[k]),
        }
    }

    /// Returns the pose of a shape after the fraction `s` of the step.
    fn pose(&self, shape: &Shape<S>, s: f64) -> Pose<S> {
        let b = shape.body() as usize;
        let (v, w) = &self.velocities[b];
        let mut rotation = self.scene.bodies.rotation[b];
        if s > 0.0 && *w != S::Spin::zero() {
            rotation = S::turned(&rotation, &(*w * (s * self.h)));
        }
        let body = self.scene.bodies.position[b] + *v * (s * self.h);
        let centre = if *shape.offset() == S::Vector::zero() {
            body
        } else {
            body + S::rotate(&rotation, shape.offset())
        };
        Pose {
            body,
            rotation,
            centre,
        }
    }

    /// Returns the pair with these keys.
    pub fn pair(&self, names: (u32, u32)) -> SweptPair<'a, S> {
        let shapes = [self.shape(names.0), self.shape(names.1)];
        let [one, other] = [0, 1].map(|k: usize| self.pose(&shapes[k], 0.0));
        let [(v, w), (v_other, w_other)] =
            [0, 1].map(|k: usize| self.velocities[shapes[k].body() as usize]);
        let lever = |shape: &Shape<S>| match shape {
            Shape::Ball(b, _) => b.offset.norm(),
            Shape::ConvexCollider(p, _) => p.offset.norm() + p.bound,
            Shape::Surface(_) => 0.0,
        };
        let approach = v - v_other;
        let mut turning = w.norm() * lever(&shapes[0]);
        let mut image = S::Vector::zero();
        match &shapes[1] {
            Shape::Surface(surface) => {
                let own = S::unrotate_spin(&other.rotation, &w_other);
                if surface.shape.is_closed() {
                    let apart = one.centre - other.centre;
                    image = apart - self.scene.shapes.periodic.shortest(apart);
                }
                if !surface.shape.is_unchanged_by(&own) {
                    let far = (one.centre - other.body).norm() + shapes[0].bound();
                    turning += w_other.norm() * (far + self.h * (approach.norm() + turning));
                }
            }
            shape => {
                turning += w_other.norm() * lever(shape);
                let apart = one.centre - other.centre;
                image = apart - self.scene.shapes.periodic.shortest(apart);
            }
        }
        let half = |k: usize| shapes[k].half_thickness();
        let half_thickness = half(0).min(half(1));
        let detectable = match &shapes[1] {
            Shape::Surface(surface) if !surface.shape.any_depth() => {
                self.detectable(&shapes[0], surface, half_thickness)
            }
            _ => f64::INFINITY,
        };
        SweptPair {
            names,
            approach,
            turning,
            image,
            half_thickness,
            detectable,
            travel: self.h * (approach.norm() + turning),
            shapes,
        }
    }

    /// Penetration up to which the narrow phase finds contact points of a shape with a surface (m).
    fn detectable(&self, shape: &Shape<S>, surface: &Carried<S>, half_thickness: f64) -> f64 {
        match shape {
            Shape::Ball(ball, _) => 2.0 * ball.radius + self.reach(surface, half_thickness),
            Shape::ConvexCollider(piece, _) => MAX_CORNER_DEPTH * piece.bound + piece.rounding,
            Shape::Surface(_) => f64::INFINITY,
        }
    }

    /// Distance at which contact points with a surface are searched (m). A shape that passed
    /// through a grain is behind the surface of the grain by more than the alert distance.
    fn reach(&self, surface: &Carried<S>, half_thickness: f64) -> f64 {
        if surface.shape.is_closed() {
            self.alert.max(half_thickness)
        } else {
            self.alert
        }
    }

    /// Follows a pair through the step; it meets where its gap falls below `-margin` (m).
    pub fn follow(&self, pair: &SweptPair<S>, margin: f64) -> SweepResult {
        if !pair.travel.is_finite() {
            return SweepResult::Unresolved;
        }
        let travel = pair.travel;
        // No increment is longer than half of the penetration in which the pair is both beyond the
        // margin and detected.
        let remaining = DETECTABLE * (pair.detectable - margin).max(0.0);
        let stride =
            (STRIDE * pair.half_thickness).min(remaining.max(MIN_INCREMENT * pair.detectable));
        let (mut before, mut s) = (0.0, 0.0);
        for _ in 0..MAX_INSTANTS {
            let left = (1.0 - s) * travel;
            let Probe { gap, normal } = self.probe(pair, s, left + margin);
            let room = gap + margin;
            if room < 0.0 {
                return SweepResult::Meets(self.meeting_time(pair, margin, before, s));
            }
            if room > left || s >= 1.0 {
                return SweepResult::Separate;
            }
            let closing = match normal {
                Some(n) => pair.closing_speed(&n),
                None => travel / self.h,
            };
            if closing <= 0.0 {
                return SweepResult::Separate;
            }
            before = s;
            s = (s + (room / (self.h * closing)).max(stride / travel)).min(1.0);
        }
        SweepResult::Unresolved
    }

    /// Bisects for the time at which a pair meets.
    fn meeting_time(
        &self,
        pair: &SweptPair<S>,
        margin: f64,
        mut before: f64,
        mut after: f64,
    ) -> f64 {
        while (after - before) * pair.travel > EXACT * pair.half_thickness {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                break;
            }
            if self.probe(pair, middle, pair.travel + margin).gap + margin < 0.0 {
                after = middle;
            } else {
                before = middle;
            }
        }
        after
    }

    /// Evaluates the gap of a pair at one time; beyond `range` only a lower bound.
    fn probe(&self, pair: &SweptPair<S>, s: f64, range: f64) -> Probe<S::Vector> {
        let [one, other] = [0, 1].map(|k: usize| self.pose(&pair.shapes[k], s));
        let bound = pair.shapes[0].bound();
        if let Shape::Surface(surface) = &pair.shapes[1] {
            let origin = other.centre;
            let place = S::unrotate(&other.rotation, &(one.centre - origin - pair.image));
            // The gap to a plane closes along its normal only.
            let normal = surface.shape.flat().map(|n| S::rotate(&other.rotation, &n));
            // A cheap distance check first: surfaces are only evaluated within a short range.
            let near = |range: f64| surface.shape.near(&place, bound + range);
            let short = self.alert.max(pair.half_thickness);
            for range in [range, short] {
                if !near(range) {
                    return Probe { gap: range, normal };
                }
            }
        } else {
            let apart = (one.centre - other.centre - pair.image).norm();
            let gap = apart - bound - pair.shapes[1].bound();
            if gap > range {
                return Probe { gap, normal: None };
            }
        }
        let mut met = Vec::new();
        let reach = match pair.shapes[1] {
            Shape::Surface(surface) => self.reach(surface, pair.half_thickness),
            _ => f64::INFINITY,
        };
        let poses = [one, other];
        self.contact_points(pair, &poses, reach, &mut met);
        let [_, other] = &poses;
        let nearest = met.iter().min_by(|m, n| m.gap.total_cmp(&n.gap));
        let normal = match &pair.shapes[1] {
            Shape::Surface(s) => s.shape.flat().map(|n| S::rotate(&other.rotation, &n)),
            _ => nearest.map(|m| m.normal),
        };
        let gap = nearest.map_or(self.alert, |m| m.gap);
        Probe { gap, normal }
    }

    /// Finds the contact points of a pair in these poses, relative to the centres of the two
    /// bodies.
    fn contact_points(
        &self,
        pair: &SweptPair<S>,
        [one, other]: &[Pose<S>; 2],
        reach: f64,
        out: &mut Vec<ContactPoint<S::Vector>>,
    ) {
        let tolerances = ContactTolerances {
            reach,
            slack: super::SLACK * self.alert,
            held: false,
        };
        let apart = one.centre - other.centre - pair.image;
        let turned = |p: &ConvexCollider<S>, pose: &Pose<S>| p.core.turned(&pose.rotation);
        match (&pair.shapes[0], &pair.shapes[1]) {
            (Shape::Ball(a, _), Shape::Ball(b, _)) => out.push(point_of_balls::<S>(a, b, apart)),
            (Shape::Ball(a, _), Shape::ConvexCollider(b, _)) => {
                let core = turned(b, other);
                out.push(core.contact_point_with_ball(&apart, a.radius, b.rounding));
            }
            (Shape::ConvexCollider(a, _), Shape::ConvexCollider(b, _)) => {
                let cores = [turned(a, one), turned(b, other)];
                let pair = CorePair::<S> {
                    cores: cores.each_ref(),
                    apart,
                    roundings: [a.rounding, b.rounding],
                    tolerances,
                };
                S::Core::contact_points(&pair, out);
            }
            (Shape::Ball(a, _), Shape::Surface(b)) => {
                let place = S::unrotate(&other.rotation, &apart);
                let mut closest_points = Vec::new();
                b.shape
                    .closest_points(&place, a.radius + reach, &mut closest_points);
                keep_same_side(&mut closest_points);
                out.extend(closest_points.iter().map(|t| ContactPoint {
                    on_candidate: place - t.normal * a.radius,
                    on_antagonist: t.closest_point,
                    normal: t.normal,
                    gap: t.distance - a.radius,
                    feature: u64::from(t.feature),
                    share: 0.0,
                    facing: true,
                }));
            }
            (Shape::ConvexCollider(a, _), Shape::Surface(b)) => {
                let place = S::unrotate(&other.rotation, &apart);
                let core = turned(a, one).turned(&S::inverse(&other.rotation));
                let surface = b.shape.as_ref();
                core.contact_points_with_surface(surface, &place, a.rounding, &tolerances, out);
            }
            // Candidates precede antagonists in the order balls, pieces, surfaces.
            _ => {}
        }
        if let Shape::Surface(_) = &pair.shapes[1] {
            let turned = |m: &mut ContactPoint<_>| *m = m.rotated::<S>(&other.rotation);
            out.iter_mut().for_each(turned);
        }
        let from_candidate = other.centre + pair.image - one.body;
        let from_antagonist = other.centre - other.body;
        for m in out.iter_mut() {
            m.on_candidate += from_candidate;
            m.on_antagonist += from_antagonist;
        }
    }

    /// Adds the contacts of a pair that meets after the fraction `s` of the step as constraints: at
    /// the end of the step each body must lie on its side of the common tangent plane.
    pub fn contacts(&self, pair: &SweptPair<S>, s: f64, law: u16, out: &mut Vec<Contact<S>>) {
        let poses = [0, 1].map(|k: usize| self.pose(&pair.shapes[k], s));
        let mut met = Vec::new();
        let reach = self.alert.max(EXACT * pair.half_thickness);
        self.contact_points(pair, &poses, reach, &mut met);
        met.retain(|m| m.gap < reach);
        met.sort_by_key(|m| m.feature);
        met.dedup_by_key(|m| m.feature);
        let [i, j] = pair.bodies();
        let [(v, w), (v_other, w_other)] = [i, j].map(|b| self.velocities[b as usize]);
        let sizes = [0, 1].map(|k: usize| pair.shapes[k].size(&self.scene.bodies.length));
        let radius = match (&pair.shapes[0], &pair.shapes[1]) {
            (_, Shape::Surface(_)) | (Shape::Ball(..), Shape::ConvexCollider(..)) => sizes[0],
            (Shape::Ball(a, _), Shape::Ball(b, _)) => reduced_radius([a.radius, b.radius], sizes),
            _ => sizes[0] * sizes[1] / (sizes[0] + sizes[1]),
        };
        for m in met {
            let velocity = v + S::spin_velocity(&w, &m.on_candidate)
                - v_other
                - S::spin_velocity(&w_other, &m.on_antagonist);
            // Approach of the two until they meet.
            let way = (-s * self.h * m.normal.dot(&velocity)).max(0.0);
            out.push(Contact {
                vertex_contact: !m.facing,
                closing: true,
                beyond: true,
                ..Contact::new(
                    Key::new(pair.names.0, pair.names.1, m.feature),
                    [i, j],
                    law,
                    ContactGeometry {
                        gap: m.gap + way,
                        normal: m.normal,
                        arms: [m.on_candidate, m.on_antagonist],
                        radius: if m.share > 0.0 { m.share } else { radius },
                    },
                    self.time,
                )
            });
        }
    }
}

/// Returns the contact point of two balls, the first at `apart` from the second, relative to the
/// centre of the second.
fn point_of_balls<S: Space>(a: &Ball<S>, b: &Ball<S>, apart: S::Vector) -> ContactPoint<S::Vector> {
    let distance = apart.norm();
    let normal = if distance > 0.0 {
        apart * (1.0 / distance)
    } else {
        S::Vector::from_slice(&[1.0])
    };
    ContactPoint {
        on_candidate: apart - normal * a.radius,
        on_antagonist: normal * b.radius,
        normal,
        gap: distance - a.radius - b.radius,
        feature: 0,
        share: 0.0,
        facing: true,
    }
}

/// Keeps the points on the side of the nearest one: a ball near a thin part is also behind the
/// other side of the part.
fn keep_same_side<V>(closest_points: &mut Vec<ClosestPoint<V>>) {
    let nearest = closest_points
        .iter()
        .min_by(|t, u| t.distance.abs().total_cmp(&u.distance.abs()));
    if let Some(behind) = nearest.map(|t| t.distance < 0.0) {
        closest_points.retain(|t| (t.distance < 0.0) == behind);
    }
}
