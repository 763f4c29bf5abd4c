//! Narrow phase: gaps and normals of candidate pairs, and transfer of contact memory.

use super::partners::Partners;
use super::update::{ContactUpdate, DetectedContact, PlacedScene};
use super::{CollisionScene, held};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::convex::ContactPoint;
use crate::geometry::shape::{Ball, ClosestPoint, reduced_radius};
use crate::geometry::space::{Space, VectorLike};

/// Input of the narrow phase. Pairs do not depend on each other.
pub(super) struct Narrow<'a, S: Space> {
    pub(super) network: &'a Network<S>,
    pub(super) placed: &'a PlacedScene<'a, S>,
    /// Cores of the pieces in world axes.
    pub(super) cores: &'a [S::Core],
    /// Origins and rotations of the surfaces.
    pub(super) frames: &'a [(S::Vector, S::Rotation)],
    /// Data of the balls.
    pub(super) ball_data: &'a [BallData<S>],
    /// All candidate pairs, and the pieces that each ball or piece may touch.
    pub(super) pairs: &'a [(u32, u32)],
    pub(super) partners: &'a Partners,
}

/// Buffers that are used again for each pair.
pub(super) struct Scratch<S: Space> {
    pub(super) closest_points: Vec<ClosestPoint<S::Vector>>,
    pub(super) points: Vec<ContactPoint<S::Vector>>,
    /// The old contact that each point continues.
    pub(super) matched: Vec<Option<usize>>,
    /// Distances between points and old contacts (m), with the indices of both.
    pub(super) distances: Vec<(f64, usize, usize)>,
    /// Points that become contacts, and the old contacts that they continue.
    pub(super) selected: Vec<(ContactPoint<S::Vector>, Option<usize>)>,
    /// Whether each old contact of the pair continues.
    pub(super) continued: Vec<bool>,
    /// A core in the axes of a surface.
    pub(super) core: Option<S::Core>,
}

impl<S: Space> Default for Scratch<S> {
    fn default() -> Self {
        Self {
            closest_points: Vec::new(),
            points: Vec::new(),
            matched: Vec::new(),
            distances: Vec::new(),
            selected: Vec::new(),
            continued: Vec::new(),
            core: None,
        }
    }
}

impl<S: Space> Narrow<'_, S> {
    /// Updates the contacts of pairs, in order; `contacts` are the old ones from the first pair to
    /// the last.
    pub(super) fn update<'c>(
        &self,
        pairs: &[(u32, u32)],
        contacts: &'c mut [Contact<S>],
    ) -> ContactUpdate<'c, S> {
        let mut update = ContactUpdate::new(contacts);
        let mut scratch = Scratch::default();
        for &(a, b) in pairs {
            if (a | b) & Key::PIECE != 0 {
                update.begin_pair((a, b));
                self.convex_pair((a, b), &mut scratch, &mut update);
            } else if b & Key::SURFACE == 0 {
                self.ball_pair(a, b, &mut update);
            } else {
                update.begin_pair((a, b));
                self.ball_on_surface(a, b, &mut scratch, &mut update);
            }
        }
        update.end();
        update
    }

    fn ball_pair(&self, a: u32, b: u32, update: &mut ContactUpdate<S>) {
        let (p, q) = (&self.ball_data[a as usize], &self.ball_data[b as usize]);
        let CollisionScene {
            shapes,
            bodies,
            laws,
        } = *self.placed.scene;
        let d = shapes.periodic.shortest(p.centre - q.centre);
        let old = update.old_of_balls((a, b));
        let sum = p.radius + q.radius;
        if sum == 0.0 {
            // Points of surfaces do not touch each other.
            return;
        }
        let squared = d.dot(&d);
        let limit = sum + self.network.alert;
        if squared >= limit * limit {
            match old {
                Some(k) if !held(self.network, Some(update.contact(k))) => {
                    return update.drop_old(k);
                }
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
        let Some(law) = laws.get(p.material, q.material) else {
            return;
        };
        let size_of = |ball: u32| shapes.balls[ball as usize].size(&bodies.length);
        let sizes = if p.radius > 0.0 && q.radius > 0.0 {
            [p.radius, q.radius]
        } else {
            [size_of(a), size_of(b)]
        };
        let size = reduced_radius([p.radius, q.radius], sizes);
        let radius = if p.radius > 0.0 && q.radius > 0.0 {
            size
        } else {
            let radius_of = |ball: u32| shapes.balls[ball as usize].contact_radius(&bodies.length);
            reduced_radius([p.radius, q.radius], [radius_of(a), radius_of(b)])
        };
        let central = p.simple && q.simple;
        let arms = if central {
            [normal * -p.radius, normal * q.radius]
        } else {
            let closest_point = p.centre - normal * p.radius;
            let other = q.centre + normal * q.radius;
            [
                closest_point - bodies.position[p.body as usize],
                other - bodies.position[q.body as usize],
            ]
        };
        // The area of a ball on a grain belongs to its contact with the surface of the grain, not
        // to those with the vertices next to it.
        let vertex = |ball: &BallData<S>| {
            let carrier = bodies.carrier(ball.body as usize);
            ball.radius == 0.0 && carrier.is_some_and(|c| c.grain)
        };
        let found = DetectedContact {
            key: Key::new(a, b, 0),
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
            Some(k) => update.continue_in_place(self, k, &found),
            None => update.add(self, &found, size),
        }
    }

    fn ball_on_surface(
        &self,
        a: u32,
        b: u32,
        scratch: &mut Scratch<S>,
        update: &mut ContactUpdate<S>,
    ) {
        let network = self.network;
        let CollisionScene {
            shapes,
            bodies,
            laws,
        } = *self.placed.scene;
        let ball = &shapes.balls[a as usize];
        let surface = &shapes.surfaces[(b & !Key::SURFACE) as usize];
        let (origin, rotation) = self.frames[(b & !Key::SURFACE) as usize];
        let mut apart = self.placed.centres[a as usize] - origin;
        if surface.shape.is_closed() {
            apart = shapes.periodic.shortest(apart);
        }
        let local = S::unrotate(&rotation, &apart);
        let mut margin = self.reach(update.old());
        if ball.radius == 0.0 && !surface.shape.is_closed() {
            margin = margin.max(self.reach_from_behind(update.old()));
        }
        let closest_points = &mut scratch.closest_points;
        closest_points.clear();
        surface
            .shape
            .closest_points(&local, ball.radius + margin, closest_points);
        if closest_points.is_empty() {
            // A point that moved too fast is pushed out of a grain from any depth.
            closest_points.extend(surface.shape.enclosing(&local));
        }
        // The vertices of a grain touch as points of their own.
        let several = ball.radius > 0.0 && !surface.shape.is_closed();
        if surface.shape.deforms() && several {
            let nearest = closest_points.len();
            let reach = ball.radius + margin;
            surface.shape.vertices_within(&local, reach, closest_points);
            let (first, more) = closest_points.split_at_mut(nearest);
            let mut kept = 0;
            for k in 0..more.len() {
                if first.iter().all(|t| t.feature != more[k].feature) {
                    more[kept] = more[k];
                    kept += 1;
                }
            }
            closest_points.truncate(nearest + kept);
        }
        // The area of a ball or of a point of a surface, with its bonds and attraction, counts
        // once: at the nearest point.
        let mut nearest_feature = None;
        let point_of_surface = ball.radius == 0.0 && ball.area == S::Vector::zero();
        if surface.shape.deforms() && (ball.radius > 0.0 || point_of_surface) {
            let nearest = closest_points.iter().map(|t| t.distance);
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let first = closest_points.iter().find(|t| t.distance == nearest);
            nearest_feature = first.map(|t| t.feature);
            closest_points.sort_by_key(|t| t.feature);
        }
        let Some(law) = laws.get(ball.material, surface.material) else {
            return;
        };
        let continued = &mut scratch.continued;
        continued.clear();
        continued.resize(update.old().len(), false);
        let (i, j) = (ball.body as usize, surface.body as usize);
        let grain = |b: usize| bodies.carrier(b).is_some_and(|c| c.grain);
        let twice = ball.radius == 0.0 && grain(i) && grain(j);
        // Two grains both have contact points on each other, each with half of the area.
        let share = if twice {
            f64::powf(0.5, 1.0 / (S::D - 1) as f64)
        } else {
            1.0
        };
        let size = ball.size(&bodies.length);
        // A bond whose facet is no longer touched continues at the nearest one, even if that had a
        // contact without a bond.
        let old = update.old();
        let mut successor = None;
        let mut lost_bond = None;
        if let Some(feature) = nearest_feature {
            let of = old.iter().find(|c| c.key.feature == u64::from(feature));
            successor = Some(feature).filter(|_| !held(network, of));
            lost_bond = successor.and_then(|_| {
                let lost = |c: &Contact<S>| is_lost(c, closest_points) && held(network, Some(c));
                old.iter().position(lost)
            });
        }
        for closest in closest_points.iter() {
            // The old contact with the same feature, or else one whose feature is no longer found.
            let old = update.old();
            let matched = match lost_bond {
                Some(k) if successor == Some(closest.feature) => Some(k),
                _ => {
                    let free = |k: &usize| !continued[*k] && Some(*k) != lost_bond;
                    let of = u64::from(closest.feature);
                    let mut all = (0..old.len()).filter(free);
                    let same = all.find(|k| old[*k].key.feature == of);
                    let mut others = (0..old.len()).filter(free);
                    same.or_else(|| others.find(|k| is_lost(&old[*k], closest_points)))
                }
            };
            let matched = matched.filter(|k| !continued[*k]);
            let gap = closest.distance - ball.radius;
            if gap >= network.alert && !held(network, matched.map(|k| &old[k])) {
                continue;
            }
            if let Some(k) = matched {
                continued[k] = true;
            }
            let normal = S::rotate(&rotation, &closest.normal);
            let own = S::unrotate(&bodies.rotation[i], &normal);
            let radius = share * ball.radius_towards(&own, &bodies.length);
            let closest_point = origin + S::rotate(&rotation, &closest.closest_point);
            let still = bodies.immovable(j) && bodies.spin[j] == S::Spin::zero();
            let centred = ball.offset == S::Vector::zero() && bodies.length[i] == ball.radius;
            let arm = self.placed.centres[a as usize] - normal * ball.radius - bodies.position[i];
            let found = DetectedContact {
                key: Key::new(a, b, u64::from(closest.feature)),
                bodies: [ball.body, surface.body],
                law,
                central: still && centred && is_isotropic(bodies, i),
                vertex_contact: nearest_feature.is_some_and(|f| f != closest.feature),
                geometry: ContactGeometry {
                    gap,
                    normal,
                    arms: [arm, closest_point - bodies.position[j]],
                    radius,
                },
            };
            match matched {
                Some(k) => update.continue_old(self, k, &found),
                None => update.add(self, &found, size),
            }
        }
        update.drop_others(|k| continued[k]);
    }

    /// Returns the search distance (m) for a point that the errors of the solution have pressed
    /// behind an open surface by a large part of the alert distance; 0 for other points.
    fn reach_from_behind(&self, old: &[Contact<S>]) -> f64 {
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
                let (v, w) = (
                    &self.placed.scene.bodies.velocity[b],
                    &self.placed.scene.bodies.spin[b],
                );
                self.placed.h * (v.norm() + w.norm() * old.arms[side].norm())
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

/// Data of a ball for its contacts with other balls, next to each other in memory.
pub(super) struct BallData<S: Space> {
    centre: S::Vector,
    radius: f64,
    body: u32,
    material: u16,
    /// Whether the ball is a whole body with isotropic response, or belongs to a body at rest:
    /// contacts of two such balls are central.
    simple: bool,
}

impl<S: Space> BallData<S> {
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

/// Returns whether the feature of an old contact is no longer found.
fn is_lost<S: Space>(old: &Contact<S>, found: &[ClosestPoint<S::Vector>]) -> bool {
    let feature = old.key.feature;
    found.iter().all(|t| u64::from(t.feature) != feature)
}
