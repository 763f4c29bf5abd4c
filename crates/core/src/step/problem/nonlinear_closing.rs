//! Closing of a gap in a step beyond its velocity: bodies move on straight lines, while a hollow
//! surface bends towards them, and rotating walls carry bodies that rest on them around.
//!
//! A velocity along the tangent plane leaves a circle of radius R by (h u)^2/(2 R) in each step.
//! Since contacts that overlap only require u_n >= 0, these distances would add up. The contact
//! therefore requires the velocity at which the gap is not closed at the end of the step,
//! h u_n + g >= s. The normal velocity of a body that follows the surface then changes at each step
//! from u_n = -s/h to u_n = +s/h, and its energy is conserved. Surfaces that bend away need
//! nothing: their gap opens, and closes in the next step.
//!
//! Where material passes through a surface that stays in place
//! ([`crate::bodies::DynamicalSystem::passing`]) it moves along the surface, and its apparent
//! normal velocity on a slope closes no gap either.

use crate::bodies::{Bodies, DynamicalSystem};
use crate::contact::{Contact, Key, Network};
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::Interface;
use crate::step::Simulation;
use crate::step::motion::BodyVelocity;
use crate::threads::fill;

/// Finds by how much the motion closes each gap beyond its velocity (m); `free` holds the
/// velocities without contacts. The list is empty where nothing is hollow, no driven body rotates
/// and no material passes.
pub(super) fn find_nonlinear_closing<S: Space>(
    s: &mut Simulation<S>,
    free: &[BodyVelocity<S>],
    h: f64,
) {
    let mut nonlinear_closing = std::mem::take(&mut s.workspace.nonlinear_closing);
    nonlinear_closing.clear();
    let hollow = s.shapes.surfaces.iter().any(|s| s.shape.is_hollow());
    let driven = s.state.bodies.driven.iter().map(|d| d.body as usize);
    let mut turning: Vec<usize> = driven.filter(|b| free[*b].1 != S::Spin::zero()).collect();
    turning.sort_unstable();
    let systems = &s.state.systems;
    let all = (0..systems.len()).filter_map(|k| systems.get(k));
    let passing: Vec<S::Vector> = all.map(DynamicalSystem::passing).collect();
    let passes = passing.iter().any(|v| *v != S::Vector::zero());
    if hollow || passes || !turning.is_empty() {
        let turns = |b: u32| turning.binary_search(&(b as usize)).is_ok();
        let contacts = &s.state.network.contacts;
        let scene = Scene {
            network: &s.state.network,
            bodies: &s.state.bodies,
            shapes: &s.shapes,
            laws: &s.laws,
        };
        fill(
            s.divides_contacts(),
            &mut nonlinear_closing,
            contacts.len(),
            |k| {
                let c = &contacts[k];
                let bends = hollow && scene.is_on_hollow(c);
                let bent = if bends || c.bodies.into_iter().any(turns) {
                    scene.closing(c, free, h)
                } else {
                    0.0
                };
                if !passes {
                    return bent;
                }
                let [one, other] = c.bodies.map(|b| {
                    let carrier = scene.bodies.carrier(b as usize);
                    carrier.map_or(S::Vector::zero(), |c| passing[c.system as usize])
                });
                bent + h * c.normal.dot(&(one - other))
            },
        );
    }
    s.workspace.nonlinear_closing = nonlinear_closing;
}

/// Data from which the closing of gaps is computed.
struct Scene<'a, S: Space> {
    network: &'a Network<S>,
    bodies: &'a Bodies<S>,
    shapes: &'a Shapes<S>,
    laws: &'a [Interface],
}

impl<S: Space> Scene<'_, S> {
    fn is_on_hollow(&self, contact: &Contact<S>) -> bool {
        let surface = contact.key.surface();
        surface.is_some_and(|s| self.shapes.surfaces[s].shape.is_hollow())
    }

    fn closing(&self, contact: &Contact<S>, free: &[BodyVelocity<S>], h: f64) -> f64 {
        let network = self.network;
        // A spring pushes out what overlaps, a bond holds what it joins; a predicted contact has
        // the geometry at the time of closing.
        let held = network.bond(contact).is_some_and(|b| b.intact());
        if contact.closing || held || self.laws[usize::from(contact.law)].compliant() {
            return 0.0;
        }
        let [one, other] = contact.arms;
        let n = contact.normal;
        let rise = self.rise(contact, [0, 1], [one, other + n * contact.gap], n, free, h);
        let both_flat = contact.key.candidate & Key::PIECE != 0 && contact.key.surface().is_none();
        let rise = if both_flat {
            // Either side may be the rotating face.
            let place = one - n * contact.gap;
            rise.min(self.rise(contact, [1, 0], [other, place], -n, free, h))
        } else {
            rise
        };
        (-rise).max(0.0)
    }

    /// Returns how much a point of a body rises along the tangent plane of the other by moving
    /// along it (m). `arm` is the vector from the body's centre to the point, `place` that from the
    /// centre of the other.
    fn rise(
        &self,
        contact: &Contact<S>,
        sides: [usize; 2],
        [arm, place]: [S::Vector; 2],
        n: S::Vector,
        free: &[BodyVelocity<S>],
        h: f64,
    ) -> f64 {
        let bodies = self.bodies;
        let [i, j] = sides.map(|side| contact.bodies[side] as usize);
        // Contacts change the motion along the surface little; loads without contacts may change it
        // much.
        let motion = |b: usize| {
            if bodies.immovable(b) {
                free[b]
            } else {
                (bodies.velocity[b], bodies.spin[b])
            }
        };
        let ((v, w), (v_other, w_other)) = (motion(i), motion(j));
        let ball = contact.key.ball().filter(|_| sides[0] == 0);
        let radius = ball.map_or(0.0, |k| self.shapes.balls[k].radius);
        // The centre of a ball stays opposite to the surface; for other shapes the touching point
        // does.
        let (arm, place) = (arm + n * radius, place + n * radius);
        let turn = |w: S::Spin, x: &S::Vector| S::rotate(&S::turned(&S::identity(), &(w * h)), x);
        let back = |w: S::Spin, x: &S::Vector| S::unrotate(&S::turned(&S::identity(), &(w * h)), x);
        let linear = v + S::spin_velocity(&w, &arm) - v_other - S::spin_velocity(&w_other, &place);
        let moved = (v - v_other) * h + turn(w, &arm) - arm - n * (h * n.dot(&linear));
        let after = back(w_other, &(place + moved));
        let surface = contact.key.surface().map(|k| &self.shapes.surfaces[k]);
        if let Some(surface) = surface.filter(|s| s.shape.is_hollow()) {
            let local = |x: &S::Vector| S::unrotate(&bodies.rotation[j], x) - surface.offset;
            return surface
                .shape
                .distance_gained(&local(&place), &local(&after));
        }
        match contact.key.antagonist_ball() {
            Some(k) if ball.is_some() => {
                let centre = contact.arms[1] - n * self.shapes.balls[k].radius;
                (after - centre).norm() - (place - centre).norm()
            }
            _ => n.dot(&(after - place)),
        }
    }
}

/// Returns the velocity at which a step may close the gap of a contact; for a penetration, the
/// (negative) velocity at which the correction removes its share (m/s).
pub(super) fn shift_of_gap<S: Space>(
    network: &Network<S>,
    contact: &Contact<S>,
    correction: f64,
    h: f64,
) -> f64 {
    let gap = network.open_gap(contact);
    if gap > 0.0 {
        gap / h
    } else {
        correction * gap / h
    }
}
