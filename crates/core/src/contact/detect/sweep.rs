//! Two bodies that move fast, followed through a step: when they meet, and where.
//!
//! Conservative advancement: the gap cannot close faster than the two approach, so that the time in which they cannot meet is
//! passed over (Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996, section 2.3). Where that makes small
//! steps, a part of the half thickness of the thinner one is gone on: what is missed so is shallower than that part.

use super::extents::Extents;
use crate::bodies::Bodies;
use crate::contact::network::{Contact, Key};
use crate::geometry::convex::{ContactPoint, ContactTolerances, ConvexCollider, Core};
use crate::geometry::shape::{Ball, Carried, ClosestPoint, Shapes};
use crate::geometry::space::{Space, VectorLike};

/// Bodies, and the velocities that they have over the step.
pub(super) struct Sweep<'a, S: Space> {
    pub shapes: &'a Shapes<S>,
    pub bodies: &'a Bodies<S>,
    pub extents: &'a Extents,
    pub velocities: &'a [(S::Vector, S::Spin)],
    pub time: f64,
    pub h: f64,
    pub alert: f64,
}

/// What of a body can touch.
#[derive(Clone, Copy)]
enum Shape<'a, S: Space> {
    Ball(&'a Ball<S>),
    ConvexCollider(&'a ConvexCollider<S>, f64),
    Surface(&'a Carried<S>),
}

impl<S: Space> Shape<'_, S> {
    fn body(&self) -> u32 {
        match self {
            Self::Ball(b) => b.body,
            Self::ConvexCollider(p, _) => p.body,
            Self::Surface(s) => s.body,
        }
    }

    fn material(&self) -> u16 {
        match self {
            Self::Ball(b) => b.material,
            Self::ConvexCollider(p, _) => p.material,
            Self::Surface(s) => s.material,
        }
    }

    fn offset(&self) -> &S::Vector {
        match self {
            Self::Ball(b) => &b.offset,
            Self::ConvexCollider(p, _) => &p.offset,
            Self::Surface(s) => &s.offset,
        }
    }

    /// Radius of a ball about its centre that holds it (m).
    fn bound(&self) -> f64 {
        match self {
            Self::Ball(b) => b.radius,
            Self::ConvexCollider(p, _) => p.bound,
            Self::Surface(_) => 0.0,
        }
    }

    /// Half of what it is thick at least (m).
    fn half_thickness(&self) -> f64 {
        match self {
            Self::Ball(b) => b.radius,
            Self::ConvexCollider(_, half) => *half,
            Self::Surface(_) => f64::INFINITY,
        }
    }

    /// The size that a contact of one point has by it (m).
    fn size(&self) -> f64 {
        match self {
            Self::Ball(b) => b.radius,
            Self::ConvexCollider(p, _) => p.size,
            Self::Surface(_) => f64::INFINITY,
        }
    }
}

/// Where a body and one of its shapes stand.
struct Pose<S: Space> {
    body: S::Vector,
    rotation: S::Rotation,
    centre: S::Vector,
}

/// What is known of a gap at an instant.
struct Probe<V> {
    /// The gap, or what it is at least (m).
    gap: f64,
    /// The normal where both are convex: along it the gap closes no faster than the bodies approach.
    normal: Option<V>,
}

/// How a pair gets through the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Course {
    /// They do not meet.
    Clear,
    /// They meet when this part of the step is over.
    Meets(f64),
    /// They turn or move too far to be followed.
    Lost,
}

/// A pair of what can touch, and how it moves.
pub(super) struct Pair<'a, S: Space> {
    names: (u32, u32),
    shapes: [Shape<'a, S>; 2],
    /// Velocity of the candidate's body relative to the antagonist's (m/s).
    approach: S::Vector,
    /// What turning adds to the speed of any point at most (m/s).
    turning: f64,
    /// The image of the antagonist that is nearest stands so far off (m).
    image: S::Vector,
    /// Of the thinner one (m).
    pub half_thickness: f64,
    /// The farthest that two of their points move in the step (m).
    pub travel: f64,
}

impl<'a, S: Space> Pair<'a, S> {
    pub fn bodies(&self) -> [u32; 2] {
        [self.shapes[0].body(), self.shapes[1].body()]
    }

    pub fn materials(&self) -> [u16; 2] {
        [self.shapes[0].material(), self.shapes[1].material()]
    }
}

/// Parts of the half thickness that are gone on at least.
const STRIDE: f64 = 0.25;
/// Instants of a step that are looked at for one pair.
const MAX_INSTANTS: usize = 2000;
/// How exactly the instant of a meeting is found, in parts of the half thickness.
const EXACT: f64 = 1e-3;

impl<'a, S: Space> Sweep<'a, S> {
    fn shape(&self, name: u32) -> Shape<'a, S> {
        if name & Key::SURFACE != 0 {
            Shape::Surface(&self.shapes.surfaces[(name & !Key::SURFACE) as usize])
        } else if name & Key::PIECE != 0 {
            let k = (name & !Key::PIECE) as usize;
            Shape::ConvexCollider(&self.shapes.pieces[k], self.extents.pieces[k])
        } else {
            Shape::Ball(&self.shapes.balls[name as usize])
        }
    }

    /// Where a shape stands when part `s` of the step is over.
    fn pose(&self, shape: &Shape<S>, s: f64) -> Pose<S> {
        let b = shape.body() as usize;
        let (v, w) = &self.velocities[b];
        let mut rotation = self.bodies.rotation[b];
        if s > 0.0 && *w != S::Spin::zero() {
            rotation = S::turned(&rotation, &(*w * (s * self.h)));
        }
        let body = self.bodies.position[b] + *v * (s * self.h);
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

    /// The pair of these names.
    pub fn pair(&self, names: (u32, u32)) -> Pair<'a, S> {
        let shapes = [self.shape(names.0), self.shape(names.1)];
        let [one, other] = [0, 1].map(|k: usize| self.pose(&shapes[k], 0.0));
        let [(v, w), (v_other, w_other)] =
            [0, 1].map(|k: usize| self.velocities[shapes[k].body() as usize]);
        let lever = |shape: &Shape<S>| match shape {
            Shape::Ball(b) => b.offset.norm(),
            Shape::ConvexCollider(p, _) => p.offset.norm() + p.bound,
            Shape::Surface(_) => 0.0,
        };
        let approach = v - v_other;
        let mut turning = w.norm() * lever(&shapes[0]);
        let mut image = S::Vector::zero();
        match &shapes[1] {
            Shape::Surface(surface) => {
                let own = S::unrotate_spin(&other.rotation, &w_other);
                if !surface.shape.keeps_place(&own) {
                    let far = (one.centre - other.body).norm() + shapes[0].bound();
                    turning += w_other.norm() * (far + self.h * (approach.norm() + turning));
                }
            }
            shape => {
                turning += w_other.norm() * lever(shape);
                let apart = one.centre - other.centre;
                image = apart - self.shapes.periodic.shortest(apart);
            }
        }
        let half = |k: usize| shapes[k].half_thickness();
        Pair {
            names,
            approach,
            turning,
            image,
            half_thickness: half(0).min(half(1)),
            travel: self.h * (approach.norm() + turning),
            shapes,
        }
    }

    /// How a pair gets through the step, where it meets when its gap falls below `-margin` (m).
    pub fn course(&self, pair: &Pair<S>, margin: f64) -> Course {
        if !pair.travel.is_finite() {
            return Course::Lost;
        }
        let (travel, half) = (pair.travel, pair.half_thickness);
        let (mut before, mut s) = (0.0, 0.0);
        for _ in 0..MAX_INSTANTS {
            let left = (1.0 - s) * travel;
            let Probe { gap, normal } = self.probe(pair, s, left + margin);
            let room = gap + margin;
            if room < 0.0 {
                return Course::Meets(self.instant(pair, margin, before, s));
            }
            if room > left || s >= 1.0 {
                return Course::Clear;
            }
            let closing = match normal {
                Some(n) => (-n.dot(&pair.approach)).max(0.0) + pair.turning,
                None => travel / self.h,
            };
            if closing <= 0.0 {
                return Course::Clear;
            }
            before = s;
            s = (s + (room / (self.h * closing)).max(STRIDE * half / travel)).min(1.0);
        }
        Course::Lost
    }

    /// The instant at which a pair meets between two.
    fn instant(&self, pair: &Pair<S>, margin: f64, mut before: f64, mut after: f64) -> f64 {
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

    /// The gap of a pair at an instant; where it is beyond `range` that is all that is said of it.
    fn probe(&self, pair: &Pair<S>, s: f64, range: f64) -> Probe<S::Vector> {
        let [one, other] = [0, 1].map(|k: usize| self.pose(&pair.shapes[k], s));
        let bound = pair.shapes[0].bound();
        if let Shape::Surface(surface) = &pair.shapes[1] {
            let origin = other.centre;
            let place = S::unrotate(&other.rotation, &(one.centre - origin));
            // Of a plane the gap closes along its normal alone.
            let normal = surface.shape.flat().map(|n| S::rotate(&other.rotation, &n));
            // First whether it is near at all: surfaces are looked at within a short reach alone.
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
            Shape::Surface(_) => self.alert,
            _ => f64::INFINITY,
        };
        let poses = [one, other];
        self.meetings(pair, &poses, reach, &mut met);
        let [_, other] = &poses;
        let nearest = met.iter().min_by(|m, n| m.gap.total_cmp(&n.gap));
        let normal = match &pair.shapes[1] {
            Shape::Surface(s) => s.shape.flat().map(|n| S::rotate(&other.rotation, &n)),
            _ => nearest.map(|m| m.normal),
        };
        let gap = nearest.map_or(self.alert, |m| m.gap);
        Probe { gap, normal }
    }

    /// Where a pair is near in these poses; points are seen from the centres of the two bodies.
    fn meetings(
        &self,
        pair: &Pair<S>,
        [one, other]: &[Pose<S>; 2],
        reach: f64,
        out: &mut Vec<ContactPoint<S::Vector>>,
    ) {
        let gauge = ContactTolerances {
            reach,
            slack: super::SLACK * self.alert,
            held: false,
        };
        let apart = one.centre - other.centre - pair.image;
        let turned = |p: &ConvexCollider<S>, pose: &Pose<S>| p.core.turned(&pose.rotation);
        match (&pair.shapes[0], &pair.shapes[1]) {
            (Shape::Ball(a), Shape::Ball(b)) => {
                let distance = apart.norm();
                let normal = if distance > 0.0 {
                    apart * (1.0 / distance)
                } else {
                    S::Vector::from_slice(&[1.0])
                };
                out.push(ContactPoint {
                    on_candidate: apart - normal * a.radius,
                    on_antagonist: normal * b.radius,
                    normal,
                    gap: distance - a.radius - b.radius,
                    feature: 0,
                    share: 0.0,
                    facing: true,
                });
            }
            (Shape::Ball(a), Shape::ConvexCollider(b, _)) => {
                let core = turned(b, other);
                out.push(core.meet_ball(&apart, a.radius, b.rounding));
            }
            (Shape::ConvexCollider(a, _), Shape::ConvexCollider(b, _)) => {
                let roundings = [a.rounding, b.rounding];
                let (a, b) = (turned(a, one), turned(b, other));
                a.meet(&b, &apart, roundings, &gauge, out);
            }
            (Shape::Ball(a), Shape::Surface(b)) => {
                let place = S::unrotate(&other.rotation, &apart);
                let mut touches = Vec::new();
                b.shape.touches(&place, a.radius + reach, &mut touches);
                keep_same_side(&mut touches);
                out.extend(touches.iter().map(|t| ContactPoint {
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
                core.meet_surface(b.shape.as_ref(), &place, a.rounding, &gauge, out);
            }
            // Candidates come before antagonists: balls, pieces, surfaces.
            _ => {}
        }
        if let Shape::Surface(_) = &pair.shapes[1] {
            for m in out.iter_mut() {
                m.normal = S::rotate(&other.rotation, &m.normal);
                m.on_candidate = S::rotate(&other.rotation, &m.on_candidate);
                m.on_antagonist = S::rotate(&other.rotation, &m.on_antagonist);
            }
        }
        let from_candidate = other.centre + pair.image - one.body;
        let from_antagonist = other.centre - other.body;
        for m in out.iter_mut() {
            m.on_candidate += from_candidate;
            m.on_antagonist += from_antagonist;
        }
    }

    /// The contacts of a pair that meets when part `s` of the step is over, as the step's constraints: at the end of the
    /// step the bodies are in front of each other's tangent planes.
    pub fn contacts(&self, pair: &Pair<S>, s: f64, law: u16, out: &mut Vec<Contact<S>>) {
        let poses = [0, 1].map(|k: usize| self.pose(&pair.shapes[k], s));
        let mut met = Vec::new();
        let reach = self.alert.max(EXACT * pair.half_thickness);
        self.meetings(pair, &poses, reach, &mut met);
        met.retain(|m| m.gap < reach);
        met.sort_by_key(|m| m.feature);
        met.dedup_by_key(|m| m.feature);
        let [i, j] = pair.bodies();
        let [(v, w), (v_other, w_other)] = [i, j].map(|b| self.velocities[b as usize]);
        let sizes = [pair.shapes[0].size(), pair.shapes[1].size()];
        let radius = match (&pair.shapes[0], &pair.shapes[1]) {
            (_, Shape::Surface(_)) | (Shape::Ball(_), Shape::ConvexCollider(..)) => sizes[0],
            _ => sizes[0] * sizes[1] / (sizes[0] + sizes[1]),
        };
        for m in met {
            let velocity = v + S::spin_velocity(&w, &m.on_candidate)
                - v_other
                - S::spin_velocity(&w_other, &m.on_antagonist);
            // What the two go on the way there.
            let way = (-s * self.h * m.normal.dot(&velocity)).max(0.0);
            out.push(Contact {
                key: Key {
                    candidate: pair.names.0,
                    antagonist: pair.names.1,
                    feature: m.feature,
                },
                bodies: [i, j],
                law,
                central: false,
                vertex_contact: !m.facing,
                broken: false,
                slot: Contact::<S>::NO_MEMORY,
                gap: m.gap + way,
                normal: m.normal,
                arms: [m.on_candidate, m.on_antagonist],
                radius: if m.share > 0.0 { m.share } else { radius },
                impulse: S::Vector::zero(),
                moment: S::Spin::zero(),
                formed_at: self.time,
                pressed: 0.0,
                slides: false,
                friction_work: 0.0,
                closing: true,
                later: false,
                beyond: true,
            });
        }
    }
}

/// A ball near a thin part is also behind its other side: leaves what is on the side of the nearest.
fn keep_same_side<V>(touches: &mut Vec<ClosestPoint<V>>) {
    let nearest = touches
        .iter()
        .min_by(|t, u| t.distance.abs().total_cmp(&u.distance.abs()));
    if let Some(behind) = nearest.map(|t| t.distance < 0.0) {
        touches.retain(|t| (t.distance < 0.0) == behind);
    }
}
