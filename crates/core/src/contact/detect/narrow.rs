//! Narrow phase: gaps and normals of candidate pairs, and transfer of contact memory.

use super::convex_pair::PairPoints;
use super::{LawTable, drop_contact, frame, held};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::convex::{ConvexCollider, Core};
use crate::geometry::shape::{Ball, ClosestPoint, Shapes, reduced_radius};
use crate::geometry::space::{Space, VectorLike};
use std::ops::Range;

/// One pass over the candidate pairs, in order, in parallel with the old contacts.
pub(super) struct Narrow<'a, S: Space> {
    pub(super) shapes: &'a Shapes<S>,
    pub(super) bodies: &'a Bodies<S>,
    /// Centres of the balls, then of the pieces (m).
    pub(super) centres: &'a [S::Vector],
    /// Cores of the pieces in world axes.
    pub(super) cores: Vec<S::Core>,
    pub(super) laws: &'a LawTable,
    pub(super) time: f64,
    pub(super) h: f64,
    /// Index of the next old contact.
    at: usize,
    touches: Vec<ClosestPoint<S::Vector>>,
}

impl<'a, S: Space> Narrow<'a, S> {
    pub(super) fn new(
        shapes: &'a Shapes<S>,
        bodies: &'a Bodies<S>,
        centres: &'a [S::Vector],
        laws: &'a LawTable,
        time: f64,
        h: f64,
    ) -> Self {
        let turned = |p: &ConvexCollider<S>| p.core.turned(&bodies.rotation[p.body as usize]);
        Self {
            shapes,
            bodies,
            centres,
            cores: shapes.pieces.iter().map(turned).collect(),
            laws,
            time,
            h,
            at: 0,
            touches: Vec::new(),
        }
    }

    /// Updates the contacts of pairs, of which the convex ones have these contact points.
    pub(super) fn update_contacts(
        &mut self,
        network: &mut Network<S>,
        pairs: &[(u32, u32)],
        found: &PairPoints<S>,
    ) {
        let mut convex = found.iter();
        for &(a, b) in pairs {
            if (a | b) & Key::PIECE != 0 {
                if let Some((pair, points)) = convex.next() {
                    self.convex_pair(network, (a, b), pair, points);
                }
            } else if b & Key::SURFACE == 0 {
                self.ball_pair(network, a, b);
            } else {
                self.ball_on_surface(network, a, b);
            }
        }
    }

    /// Returns the index of the first old contact after the last candidate.
    pub(super) fn left(&self) -> usize {
        self.at
    }

    /// Returns the old contacts of a pair; drops those of skipped pairs.
    pub(super) fn old_contacts_of(
        &mut self,
        network: &mut Network<S>,
        pair: (u32, u32),
    ) -> std::ops::Range<usize> {
        while self.at < network.old.len() && network.old[self.at].key.pair() < pair {
            drop_contact(network, self.at);
            self.at += 1;
        }
        let first = self.at;
        while self.at < network.old.len() && network.old[self.at].key.pair() == pair {
            self.at += 1;
        }
        first..self.at
    }

    pub(super) fn ball_pair(&mut self, network: &mut Network<S>, a: u32, b: u32) {
        let (p, q) = (
            &self.shapes.balls[a as usize],
            &self.shapes.balls[b as usize],
        );
        let d = self
            .shapes
            .periodic
            .shortest(self.centres[a as usize] - self.centres[b as usize]);
        let old = self.old_contacts_of(network, (a, b)).next();
        let sum = p.radius + q.radius;
        if sum == 0.0 {
            // Points of surfaces do not touch each other.
            return;
        }
        let squared = d.dot(&d);
        let limit = sum + network.alert;
        if squared >= limit * limit && !held(network, old) {
            if let Some(k) = old {
                drop_contact(network, k);
            }
            return;
        }
        let length = squared.sqrt();
        let normal = if length > 0.0 {
            d * (1.0 / length)
        } else {
            S::Vector::from_slice(&[1.0])
        };
        let (i, j) = (p.body as usize, q.body as usize);
        let simple = |ball: &Ball<S>, b: usize| {
            (ball.offset == S::Vector::zero()
                && self.bodies.length[b] == ball.radius
                && self.isotropic(b))
                || (self.bodies.immovable(b) && self.bodies.spin[b] == S::Spin::zero())
        };
        let Some(law) = self.laws.get(p.material, q.material) else {
            return;
        };
        let lengths = &self.bodies.length;
        let size = reduced_radius([p.radius, q.radius], [p.size(lengths), q.size(lengths)]);
        let closest_point = self.centres[a as usize] - normal * p.radius;
        let central = simple(p, i) && simple(q, j);
        let arms = if central {
            [normal * -p.radius, normal * q.radius]
        } else {
            let other = self.centres[b as usize] + normal * q.radius;
            [
                closest_point - self.bodies.position[i],
                other - self.bodies.position[j],
            ]
        };
        // A ball has its area where it touches the surface of a grain, not at the vertices beside that.
        let vertex = |ball: &Ball<S>| {
            let carrier = self.bodies.carrier(ball.body as usize);
            ball.radius == 0.0 && carrier.is_some_and(|c| c.grain)
        };
        let found = Contact {
            central,
            vertex_contact: vertex(p) || vertex(q),
            ..Contact::new(
                Key {
                    candidate: a,
                    antagonist: b,
                    feature: 0,
                },
                [p.body, q.body],
                law,
                ContactGeometry {
                    gap: length - sum,
                    normal,
                    arms,
                    radius: size,
                },
                self.time,
            )
        };
        self.add_contact(network, found, old, size);
    }

    /// Returns whether a body's response to impulses is isotropic.
    fn isotropic(&self, b: usize) -> bool {
        let mass = &self.bodies.inverse_mass[b];
        self.bodies.tensor(b).is_none() && (1..S::D).all(|k| mass[k] == mass[0])
    }

    pub(super) fn ball_on_surface(&mut self, network: &mut Network<S>, a: u32, b: u32) {
        let ball = &self.shapes.balls[a as usize];
        let surface = &self.shapes.surfaces[(b & !Key::SURFACE) as usize];
        let old = self.old_contacts_of(network, (a, b));
        let (origin, rotation) = frame(surface.body, &surface.offset, self.bodies);
        let mut apart = self.centres[a as usize] - origin;
        if surface.shape.is_closed() {
            apart = self.shapes.periodic.shortest(apart);
        }
        let local = S::unrotate(&rotation, &apart);
        let margin = self.reach(network, old.clone());
        let mut touches = std::mem::take(&mut self.touches);
        touches.clear();
        surface
            .shape
            .touches(&local, ball.radius + margin, &mut touches);
        if touches.is_empty() {
            // A point that came too fast is pushed out of a grain from any depth.
            touches.extend(surface.shape.enclosing(&local));
        }
        let mut alone = Vec::new();
        // The vertices of a grain are points of their own.
        let several = ball.radius > 0.0 && !surface.shape.is_closed();
        if surface.shape.deforms() && several {
            let found = touches.len();
            let reach = ball.radius + margin;
            surface.shape.vertices_within(&local, reach, &mut touches);
            let (first, more) = touches.split_at_mut(found);
            let mut kept = 0;
            for k in 0..more.len() {
                if first.iter().all(|t| t.feature != more[k].feature) {
                    more[kept] = more[k];
                    kept += 1;
                }
            }
            touches.truncate(found + kept);
        }
        // Its area, with bonds and attraction, is that of a ball or of a point of a surface once: at the nearest point.
        let point_of_surface = ball.radius == 0.0 && ball.area == S::Vector::zero();
        if surface.shape.deforms() && (ball.radius > 0.0 || point_of_surface) {
            let nearest = touches.iter().map(|t| t.distance);
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let first = touches.iter().find(|t| t.distance == nearest);
            alone.extend(first.map(|t| t.feature));
            touches.sort_by_key(|t| t.feature);
        }
        let Some(law) = self.laws.get(ball.material, surface.material) else {
            return;
        };
        let mut taken = vec![false; old.len()];
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
        // A bond whose facet is no longer touched goes on at the nearest one, also where that had a contact without a bond.
        let left = old
            .clone()
            .find(|k| is_gone(network, *k, &touches) && held(network, Some(*k)));
        let heir = alone
            .iter()
            .find(|f| !held(network, of_feature(network, &old, **f)));
        let left = left.filter(|_| heir.is_some());
        for touch in &touches {
            // The contact of the same feature, or else the nearest of those no longer found.
            let matched = match left {
                Some(k) if heir == Some(&touch.feature) => Some(k),
                _ => {
                    let free = |k: &usize| !taken[k - old.start] && Some(*k) != left;
                    let of = u64::from(touch.feature);
                    let mut all = old.clone().filter(free);
                    let same = all.find(|k| network.old[*k].key.feature == of);
                    let mut others = old.clone().filter(free);
                    same.or_else(|| others.find(|k| is_gone(network, *k, &touches)))
                }
            };
            let matched = matched.filter(|k| !taken[k - old.start]);
            let gap = touch.distance - ball.radius;
            if gap >= network.alert && !held(network, matched) {
                continue;
            }
            if let Some(k) = matched {
                taken[k - old.start] = true;
            }
            let normal = S::rotate(&rotation, &touch.normal);
            let own = S::unrotate(&self.bodies.rotation[i], &normal);
            let radius = share * ball.size_towards(&own, &self.bodies.length);
            let closest_point = origin + S::rotate(&rotation, &touch.closest_point);
            let still = self.bodies.immovable(j) && self.bodies.spin[j] == S::Spin::zero();
            let centred = ball.offset == S::Vector::zero() && self.bodies.length[i] == ball.radius;
            let arm = self.centres[a as usize] - normal * ball.radius - self.bodies.position[i];
            let found = Contact {
                central: still && centred && self.isotropic(i),
                vertex_contact: alone.first().is_some_and(|f| *f != touch.feature),
                ..Contact::new(
                    Key {
                        candidate: a,
                        antagonist: b,
                        feature: u64::from(touch.feature),
                    },
                    [ball.body, surface.body],
                    law,
                    ContactGeometry {
                        gap,
                        normal,
                        arms: [arm, closest_point - self.bodies.position[j]],
                        radius,
                    },
                    self.time,
                )
            };
            self.add_contact(network, found, matched, size);
        }
        for k in old.clone() {
            if !taken[k - old.start] {
                drop_contact(network, k);
            }
        }
        self.touches = touches;
    }

    /// Returns the search distance for contacts of a pair (m): it covers the stretched bond, the same
    /// extension within a step, and the displacement of its bodies in the step.
    pub(super) fn reach(&self, network: &Network<S>, old: Range<usize>) -> f64 {
        let stretch = |k: usize| {
            let old = &network.old[k];
            let bond = network.bond(old).filter(|b| b.intact())?;
            let moved = [0, 1].map(|side| {
                let b = old.bodies[side] as usize;
                let (v, w) = (&self.bodies.velocity[b], &self.bodies.spin[b]);
                self.h * (v.norm() + w.norm() * old.arms[side].norm())
            });
            let open = old.gap.max(0.0) + bond.opening_t.norm();
            Some(network.skin + 2.0 * open + moved[0] + moved[1])
        };
        network.alert + old.filter_map(stretch).fold(0.0, f64::max)
    }

    /// Adds a contact, with the memory of an old one of the same key, of bodies of the reduced radius `size` (m).
    pub(super) fn add_contact(
        &self,
        network: &mut Network<S>,
        mut found: Contact<S>,
        old: Option<usize>,
        size: f64,
    ) {
        match old {
            Some(k) => {
                let old = &network.old[k];
                found.impulse = old.impulse;
                found.moment = old.moment;
                found.formed_at = old.formed_at;
                found.friction_work = old.friction_work;
                found.compression_time = old.compression_time;
                found.slot = old.slot;
                found.broken = old.broken;
                found.spring = old.spring;
                let (from, normal) = (old.normal, found.normal);
                // Tangential forces of springs and the memory of a bond rotate with the pair.
                let [i, j] = found.bodies.map(|b| self.bodies.spin[b as usize]);
                let angle = || 0.5 * self.h * S::split_spin(&normal, &(i + j)).0;
                if found.spring.force_t != S::Tangent::zero() {
                    let force = &mut found.spring.force_t;
                    *force = S::transport(&from, &normal, angle(), force);
                }
                if let Some(slot) = found.memory() {
                    let angle = angle();
                    let memory = &mut network.memory[found.law as usize];
                    let bond = &mut memory.bonds[slot];
                    bond.opening_t = S::transport(&from, &found.normal, angle, &bond.opening_t);
                    if let Some(rotation) = memory.rotations.get_mut(slot) {
                        *rotation = S::transport_spin(&from, &found.normal, angle, rotation);
                    }
                }
            }
            None => {
                found.broken = network.broken_pairs.contains(&found.key.pair());
                // Penetrations in the initial state belong to the sample.
                if self.time > 0.0 {
                    let pair = found.key.pair();
                    let before = network.old[..self.at].iter().rev();
                    let same = before.take_while(|c| c.key.pair() == pair);
                    let known = same.map(|c| -c.gap).fold(0.0, f64::max);
                    // A point of a grain is as thick as its grain.
                    let grain =
                        |b: &&u32| self.bodies.carrier(**b as usize).is_some_and(|c| c.grain);
                    let grain = found.bodies.iter().find(grain);
                    let size = grain.map_or(size, |b| self.bodies.length[*b as usize]);
                    let compliant = network.memory[found.law as usize].compliant;
                    network.step_size.record_late(
                        &found,
                        [known, size],
                        compliant,
                        self.time,
                        self.bodies,
                    );
                }
            }
        }
        network.contacts.push(found);
    }
}

/// The old contact of a pair with a feature of its surface.
fn of_feature<S: Space>(network: &Network<S>, old: &Range<usize>, feature: u32) -> Option<usize> {
    let mut all = old.clone();
    all.find(|k| network.old[*k].key.feature == u64::from(feature))
}

/// Whether no touch has the feature of an old contact.
fn is_gone<S: Space>(
    network: &Network<S>,
    old: usize,
    touches: &[ClosestPoint<S::Vector>],
) -> bool {
    let of = network.old[old].key.feature;
    touches.iter().all(|t| u64::from(t.feature) != of)
}
