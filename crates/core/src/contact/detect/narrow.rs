//! Narrow phase: gaps and normals of candidate pairs, and transfer of contact memory.

use super::partners::Partners;
use super::renewal::{Found, Touch};
use super::{LawTable, held};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::convex::ContactPoint;
use crate::geometry::shape::{Ball, ClosestPoint, Shapes, reduced_radius};
use crate::geometry::space::{Space, VectorLike};

/// What the narrow phase reads. Pairs do not depend on each other.
pub(super) struct Narrow<'a, S: Space> {
    pub(super) network: &'a Network<S>,
    pub(super) shapes: &'a Shapes<S>,
    pub(super) bodies: &'a Bodies<S>,
    /// Centres of the balls, then of the pieces (m).
    pub(super) centres: &'a [S::Vector],
    /// Cores of the pieces in world axes.
    pub(super) cores: &'a [S::Core],
    /// Origins and rotations of the surfaces.
    pub(super) frames: &'a [(S::Vector, S::Rotation)],
    /// The balls.
    pub(super) round: &'a [Round<S>],
    pub(super) laws: &'a LawTable,
    /// All pairs, and the pieces in them by their partners.
    pub(super) pairs: &'a [(u32, u32)],
    pub(super) partners: &'a Partners,
    pub(super) time: f64,
    pub(super) h: f64,
}

/// Buffers that pairs use one after the other.
pub(super) struct Scratch<S: Space> {
    pub(super) touches: Vec<ClosestPoint<S::Vector>>,
    pub(super) points: Vec<ContactPoint<S::Vector>>,
    /// The old contact that each point continues.
    pub(super) matched: Vec<Option<usize>>,
    /// Distance of points from old contacts (m).
    pub(super) ways: Vec<(f64, usize, usize)>,
    /// Points that become contacts.
    pub(super) met: Vec<(ContactPoint<S::Vector>, Option<usize>)>,
    /// Whether each old contact of the pair goes on.
    pub(super) taken: Vec<bool>,
    /// A core in the axes of a surface.
    pub(super) core: Option<S::Core>,
}

impl<S: Space> Default for Scratch<S> {
    fn default() -> Self {
        Self {
            touches: Vec::new(),
            points: Vec::new(),
            matched: Vec::new(),
            ways: Vec::new(),
            met: Vec::new(),
            taken: Vec::new(),
            core: None,
        }
    }
}

impl<S: Space> Narrow<'_, S> {
    /// Renews the contacts of pairs, in order; `contacts` are the old ones from the first pair to
    /// the last.
    pub(super) fn renew<'c>(
        &self,
        pairs: &[(u32, u32)],
        contacts: &'c mut [Contact<S>],
    ) -> Found<'c, S> {
        let mut found = Found::new(contacts);
        let mut scratch = Scratch::default();
        for &(a, b) in pairs {
            if (a | b) & Key::PIECE != 0 {
                found.begin_pair((a, b));
                self.convex_pair((a, b), &mut scratch, &mut found);
            } else if b & Key::SURFACE == 0 {
                self.ball_pair(a, b, &mut found);
            } else {
                found.begin_pair((a, b));
                self.ball_on_surface(a, b, &mut scratch, &mut found);
            }
        }
        found.end();
        found
    }

    fn ball_pair(&self, a: u32, b: u32, found: &mut Found<S>) {
        let (p, q) = (&self.round[a as usize], &self.round[b as usize]);
        let d = self.shapes.periodic.shortest(p.centre - q.centre);
        let old = found.old_of_balls((a, b));
        let sum = p.radius + q.radius;
        if sum == 0.0 {
            // Points of surfaces do not touch each other.
            return;
        }
        let squared = d.dot(&d);
        let limit = sum + self.network.alert;
        if squared >= limit * limit {
            match old {
                Some(k) if !held(self.network, Some(found.contact(k))) => return found.drop_old(k),
                None => return,
                _ => {}
            }
        }
        let length = squared.sqrt();
        let normal = if length > 0.0 {
            d * (1.0 / length)
        } else {
            S::Vector::from_slice(&[1.0])
        };
        let Some(law) = self.laws.get(p.material, q.material) else {
            return;
        };
        let size_of = |ball: u32| self.shapes.balls[ball as usize].size(&self.bodies.length);
        let sizes = if p.radius > 0.0 && q.radius > 0.0 {
            [p.radius, q.radius]
        } else {
            [size_of(a), size_of(b)]
        };
        let size = reduced_radius([p.radius, q.radius], sizes);
        let radius = if p.radius > 0.0 && q.radius > 0.0 {
            size
        } else {
            let radius_of =
                |ball: u32| self.shapes.balls[ball as usize].contact_radius(&self.bodies.length);
            reduced_radius([p.radius, q.radius], [radius_of(a), radius_of(b)])
        };
        let central = p.simple && q.simple;
        let arms = if central {
            [normal * -p.radius, normal * q.radius]
        } else {
            let closest_point = p.centre - normal * p.radius;
            let other = q.centre + normal * q.radius;
            [
                closest_point - self.bodies.position[p.body as usize],
                other - self.bodies.position[q.body as usize],
            ]
        };
        // A ball has its area where it touches the surface of a grain, not at the vertices beside
        // that.
        let vertex = |ball: &Round<S>| {
            ball.radius == 0.0
                && self
                    .bodies
                    .carrier(ball.body as usize)
                    .is_some_and(|c| c.grain)
        };
        let touch = Touch {
            key: Key {
                candidate: a,
                antagonist: b,
                feature: 0,
            },
            bodies: [p.body, q.body],
            law,
            central,
            vertex_contact: vertex(p) || vertex(q),
            geometry: ContactGeometry {
                gap: length - sum,
                normal,
                arms,
                radius,
            },
        };
        match old {
            Some(k) => found.renew_in_place(self, k, &touch),
            None => found.add(self, &touch, size),
        }
    }

    fn ball_on_surface(&self, a: u32, b: u32, scratch: &mut Scratch<S>, found: &mut Found<S>) {
        let network = self.network;
        let ball = &self.shapes.balls[a as usize];
        let surface = &self.shapes.surfaces[(b & !Key::SURFACE) as usize];
        let (origin, rotation) = self.frames[(b & !Key::SURFACE) as usize];
        let mut apart = self.centres[a as usize] - origin;
        if surface.shape.is_closed() {
            apart = self.shapes.periodic.shortest(apart);
        }
        let local = S::unrotate(&rotation, &apart);
        let mut margin = self.reach(found.old());
        if ball.radius == 0.0 && !surface.shape.is_closed() {
            margin = margin.max(self.behind(found.old()));
        }
        let touches = &mut scratch.touches;
        touches.clear();
        surface.shape.touches(&local, ball.radius + margin, touches);
        if touches.is_empty() {
            // A point that came too fast is pushed out of a grain from any depth.
            touches.extend(surface.shape.enclosing(&local));
        }
        let mut alone = None;
        // The vertices of a grain are points of their own.
        let several = ball.radius > 0.0 && !surface.shape.is_closed();
        if surface.shape.deforms() && several {
            let nearest = touches.len();
            let reach = ball.radius + margin;
            surface.shape.vertices_within(&local, reach, touches);
            let (first, more) = touches.split_at_mut(nearest);
            let mut kept = 0;
            for k in 0..more.len() {
                if first.iter().all(|t| t.feature != more[k].feature) {
                    more[kept] = more[k];
                    kept += 1;
                }
            }
            touches.truncate(nearest + kept);
        }
        // Its area, with bonds and attraction, is that of a ball or of a point of a surface once:
        // at the nearest point.
        let point_of_surface = ball.radius == 0.0 && ball.area == S::Vector::zero();
        if surface.shape.deforms() && (ball.radius > 0.0 || point_of_surface) {
            let nearest = touches.iter().map(|t| t.distance);
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let first = touches.iter().find(|t| t.distance == nearest);
            alone = first.map(|t| t.feature);
            touches.sort_by_key(|t| t.feature);
        }
        let Some(law) = self.laws.get(ball.material, surface.material) else {
            return;
        };
        let taken = &mut scratch.taken;
        taken.clear();
        taken.resize(found.old().len(), false);
        let (i, j) = (ball.body as usize, surface.body as usize);
        let grain = |b: usize| self.bodies.carrier(b).is_some_and(|c| c.grain);
        let twice = ball.radius == 0.0 && grain(i) && grain(j);
        // The points of the other grain stand for the other half of the area.
        let share = if twice {
            f64::powf(0.5, 1.0 / (S::D - 1) as f64)
        } else {
            1.0
        };
        let size = ball.size(&self.bodies.length);
        // A bond whose facet is no longer touched goes on at the nearest one, also where that had a
        // contact without a bond.
        let old = found.old();
        let mut heir = None;
        let mut left = None;
        if let Some(feature) = alone {
            let of = old.iter().find(|c| c.key.feature == u64::from(feature));
            heir = Some(feature).filter(|_| !held(network, of));
            left = heir.and_then(|_| {
                let gone = |c: &Contact<S>| is_gone(c, touches) && held(network, Some(c));
                old.iter().position(gone)
            });
        }
        for touch in touches.iter() {
            // The contact of the same feature, or else the nearest of those no longer found.
            let old = found.old();
            let matched = match left {
                Some(k) if heir == Some(touch.feature) => Some(k),
                _ => {
                    let free = |k: &usize| !taken[*k] && Some(*k) != left;
                    let of = u64::from(touch.feature);
                    let mut all = (0..old.len()).filter(free);
                    let same = all.find(|k| old[*k].key.feature == of);
                    let mut others = (0..old.len()).filter(free);
                    same.or_else(|| others.find(|k| is_gone(&old[*k], touches)))
                }
            };
            let matched = matched.filter(|k| !taken[*k]);
            let gap = touch.distance - ball.radius;
            if gap >= network.alert && !held(network, matched.map(|k| &old[k])) {
                continue;
            }
            if let Some(k) = matched {
                taken[k] = true;
            }
            let normal = S::rotate(&rotation, &touch.normal);
            let own = S::unrotate(&self.bodies.rotation[i], &normal);
            let radius = share * ball.radius_towards(&own, &self.bodies.length);
            let closest_point = origin + S::rotate(&rotation, &touch.closest_point);
            let still = self.bodies.immovable(j) && self.bodies.spin[j] == S::Spin::zero();
            let centred = ball.offset == S::Vector::zero() && self.bodies.length[i] == ball.radius;
            let arm = self.centres[a as usize] - normal * ball.radius - self.bodies.position[i];
            let touch = Touch {
                key: Key {
                    candidate: a,
                    antagonist: b,
                    feature: u64::from(touch.feature),
                },
                bodies: [ball.body, surface.body],
                law,
                central: still && centred && is_isotropic(self.bodies, i),
                vertex_contact: alone.is_some_and(|f| f != touch.feature),
                geometry: ContactGeometry {
                    gap,
                    normal,
                    arms: [arm, closest_point - self.bodies.position[j]],
                    radius,
                },
            };
            match matched {
                Some(k) => found.renew(self, k, &touch),
                None => found.add(self, &touch, size),
            }
        }
        found.drop_others(|k| taken[k]);
    }

    /// Distance within which a point is found again that was pressed behind an open surface by much
    /// of the alert distance (m), as errors of the solution do; 0 for others.
    fn behind(&self, old: &[Contact<S>]) -> f64 {
        let alert = self.network.alert;
        let deepest = old.iter().fold(0.0, |d: f64, c| d.max(-c.gap));
        if deepest > 0.25 * alert {
            2.0 * deepest + alert
        } else {
            0.0
        }
    }

    /// Returns the search distance for contacts of a pair (m): it covers the stretched bond, the
    /// same extension within a step, and the displacement of its bodies in the step.
    pub(super) fn reach(&self, old: &[Contact<S>]) -> f64 {
        let network = self.network;
        let stretch = |old: &Contact<S>| {
            let bond = network.bond(old).filter(|b| b.intact())?;
            let moved = [0, 1].map(|side| {
                let b = old.bodies[side] as usize;
                let (v, w) = (&self.bodies.velocity[b], &self.bodies.spin[b]);
                self.h * (v.norm() + w.norm() * old.arms[side].norm())
            });
            let open = old.gap.max(0.0) + bond.opening_t.norm();
            Some(network.skin + 2.0 * open + moved[0] + moved[1])
        };
        network.alert + old.iter().filter_map(stretch).fold(0.0, f64::max)
    }
}

/// Returns whether a body's response to impulses is isotropic.
fn is_isotropic<S: Space>(bodies: &Bodies<S>, b: usize) -> bool {
    let mass = &bodies.inverse_mass[b];
    bodies.tensor(b).is_none() && (1..S::D).all(|k| mass[k] == mass[0])
}

/// What a pair of balls needs of either, side by side in memory.
pub(super) struct Round<S: Space> {
    centre: S::Vector,
    radius: f64,
    body: u32,
    material: u16,
    /// Whether it is a whole body whose response is isotropic, or belongs to one that stands still:
    /// contacts of two such balls are central.
    simple: bool,
}

impl<S: Space> Round<S> {
    pub(super) fn new(ball: &Ball<S>, centre: S::Vector, bodies: &Bodies<S>) -> Self {
        let b = ball.body as usize;
        let whole = ball.offset == S::Vector::zero()
            && bodies.length[b] == ball.radius
            && is_isotropic(bodies, b);
        Self {
            centre,
            radius: ball.radius,
            body: ball.body,
            material: ball.material,
            simple: whole || (bodies.immovable(b) && bodies.spin[b] == S::Spin::zero()),
        }
    }
}

/// Whether no touch has the feature of an old contact.
fn is_gone<S: Space>(old: &Contact<S>, touches: &[ClosestPoint<S::Vector>]) -> bool {
    touches
        .iter()
        .all(|t| u64::from(t.feature) != old.key.feature)
}
