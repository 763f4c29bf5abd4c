//! Contacts of convex pieces with balls, with each other and with surfaces, several contact points
//! per pair.

use super::narrow::{Narrow, Scratch};
use super::renewal::{Found, Touch};
use super::{SLACK, held};
use crate::contact::network::{Contact, ContactGeometry, Key};
use crate::geometry::convex::passing::{
    PairMotion, keep_apart, keep_apart_from_surface, keep_ball_apart,
};
use crate::geometry::convex::seam::{Beside, DEEPEST, ball_is_over_seam, leave_seam};
use crate::geometry::convex::{ContactPoint, ContactTolerances, Core};
use crate::geometry::space::{Space, VectorLike};

/// Share of the cosine between two directions that is of rounding.
const ROUNDING: f64 = 1e-12;

/// The pair: bodies, materials, and the size used where the contact point defines none (m).
struct Pair<S: Space> {
    name: (u32, u32),
    bodies: [u32; 2],
    law: u16,
    radius: f64,
    /// Vectors from the centres of the two bodies to the origin of the contact points (m).
    origins: [S::Vector; 2],
}

impl<S: Space> Narrow<'_, S> {
    /// Renews the contacts of a pair with at least one convex piece.
    pub(super) fn convex_pair(
        &self,
        name: (u32, u32),
        scratch: &mut Scratch<S>,
        found: &mut Found<S>,
    ) {
        let held = found.old().iter().any(|c| held(self.network, Some(c)));
        scratch.points.clear();
        let pair = if !held && self.far(name) {
            None
        } else {
            let tolerances = ContactTolerances {
                reach: self.reach(found.old()),
                slack: SLACK * self.network.alert,
                held,
            };
            self.contact_points(name.0, name.1, &tolerances, scratch)
        };
        match pair {
            Some(pair) if !(scratch.points.is_empty() && found.old().is_empty()) => {
                self.create_contacts(&pair, scratch, found);
            }
            _ => found.drop_others(|_| false),
        }
    }

    /// Relative motion of a pair with these centres (m) in a step, at the velocities at its start.
    fn motion(&self, bodies: [u32; 2], centres: [S::Vector; 2]) -> PairMotion<S> {
        let of = |side: usize| {
            let b = bodies[side] as usize;
            let arm = centres[side] - self.bodies.position[b];
            let (v, w) = (self.bodies.velocity[b], self.bodies.spin[b]);
            ((v + S::spin_velocity(&w, &arm)) * self.h, w * self.h)
        };
        let ((shift, turn), (shift_other, turn_other)) = (of(0), of(1));
        PairMotion {
            shift: shift - shift_other,
            turns: [turn, turn_other],
        }
    }

    /// The pieces beside either of a pair that may touch the other one too; the antagonist is a
    /// piece.
    fn beside(&self, pair: [u32; 2]) -> Vec<Beside<'_, S>> {
        let centre = |k: usize| self.centres[self.shapes.balls.len() + k];
        self.partners
            .beside(self.pairs, self.shapes, self.cores, centre, pair)
    }

    /// Returns whether the bounding balls of a pair without bonds are too far from each other for
    /// contacts.
    fn far(&self, (a, b): (u32, u32)) -> bool {
        if b & Key::SURFACE != 0 {
            return false;
        }
        let balls = self.shapes.balls.len();
        let place = |name: u32| {
            let k = (name & !Key::PIECE) as usize;
            if name & Key::PIECE == 0 {
                (self.centres[k], self.shapes.balls[k].radius)
            } else {
                (self.centres[balls + k], self.shapes.pieces[k].bound)
            }
        };
        let ((x, r), (y, s)) = (place(a), place(b));
        let apart = self.shapes.periodic.shortest(x - y);
        // Beyond what counts as corner on face.
        let limit = r + s + (1.0 + 4.0 * SLACK) * self.network.alert;
        apart.dot(&apart) > limit * limit
    }

    /// Finds the contact points of a pair in world axes. `None` if the pair has no law.
    fn contact_points(
        &self,
        a: u32,
        b: u32,
        tolerances: &ContactTolerances,
        scratch: &mut Scratch<S>,
    ) -> Option<Pair<S>> {
        let out = &mut scratch.points;
        let balls = self.shapes.balls.len();
        let at = |name: u32| (name & !Key::PIECE) as usize;
        let of = |body: u32| self.bodies.position[body as usize];
        if b & Key::SURFACE != 0 {
            let k = at(a);
            let (piece, surface) = (
                &self.shapes.pieces[k],
                &self.shapes.surfaces[(b & !Key::SURFACE) as usize],
            );
            let law = self.laws.get(piece.material, surface.material)?;
            let (origin, rotation) = self.frames[(b & !Key::SURFACE) as usize];
            let closed = surface.shape.is_closed();
            let mut apart = self.centres[balls + k] - origin;
            if closed {
                apart = self.shapes.periodic.shortest(apart);
            }
            let place = S::unrotate(&rotation, &apart);
            // The core in the surface's axes.
            let own = &self.cores[k];
            let core = scratch.core.get_or_insert_with(|| own.clone());
            own.turn_into(&S::inverse(&rotation), core);
            core.contact_points_with_surface(
                surface.shape.as_ref(),
                &place,
                piece.rounding,
                tolerances,
                out,
            );
            if !(out.is_empty() || tolerances.held || surface.shape.deforms()) {
                let bodies = [piece.body, surface.body];
                let motion = self.motion(bodies, [self.centres[balls + k], origin]);
                let motion = motion.seen_from(&rotation);
                let rounding = piece.rounding;
                let surface = surface.shape.as_ref();
                keep_apart_from_surface::<S>(
                    core, surface, &place, rounding, tolerances, &motion, out,
                );
            }
            for m in out.iter_mut() {
                m.normal = S::rotate(&rotation, &m.normal);
                m.on_candidate = S::rotate(&rotation, &m.on_candidate);
                m.on_antagonist = S::rotate(&rotation, &m.on_antagonist);
                // The vertices of a grain stand for its area.
                m.facing &= !closed;
            }
            return Some(Pair {
                name: (a, b),
                bodies: [piece.body, surface.body],
                law,
                radius: piece.size,
                origins: [
                    self.centres[balls + k] - apart - of(piece.body),
                    origin - of(surface.body),
                ],
            });
        }
        let k = at(b);
        let (other, centre) = (&self.shapes.pieces[k], self.centres[balls + k]);
        let (bodies, law, radius, own_centre, apart);
        if a & Key::PIECE == 0 {
            let ball = &self.shapes.balls[a as usize];
            own_centre = self.centres[a as usize];
            apart = self.shapes.periodic.shortest(own_centre - centre);
            let core = &self.cores[k];
            let mut meeting = core.contact_point_with_ball(&apart, ball.radius, other.rounding);
            if meeting.gap > 0.0 && !tolerances.held {
                let sizes = [ball.radius, other.rounding];
                let motion = self.motion([ball.body, other.body], [own_centre, centre]);
                keep_ball_apart::<S>(core, &apart, sizes, tolerances, &motion, &mut meeting);
            }
            // The inside of a face is on no seam.
            let inside = |n: &S::Vector| n.dot(&meeting.normal) > 1.0 - ROUNDING;
            let over_seam = meeting.gap <= tolerances.reach
                && !tolerances.held
                && !core.normals().iter().any(inside)
                && ball_is_over_seam::<S>(
                    &meeting,
                    &apart,
                    ball.radius,
                    tolerances.slack,
                    b,
                    || self.beside([a, b]),
                );
            if meeting.gap <= tolerances.reach && !over_seam {
                out.push(meeting);
            }
            bodies = [ball.body, other.body];
            law = self.laws.get(ball.material, other.material)?;
            let own = S::unrotate(&self.bodies.rotation[ball.body as usize], &meeting.normal);
            radius = ball.radius_towards(&own, &self.bodies.length);
        } else {
            let piece = &self.shapes.pieces[at(a)];
            own_centre = self.centres[balls + at(a)];
            apart = self.shapes.periodic.shortest(own_centre - centre);
            let roundings = [piece.rounding, other.rounding];
            let cores = [&self.cores[at(a)], &self.cores[k]];
            cores[0].contact_points(cores[1], &apart, roundings, tolerances, out);
            bodies = [piece.body, other.body];
            if !(out.is_empty() || tolerances.held) {
                let motion = self.motion(bodies, [own_centre, centre]);
                keep_apart::<S>(cores, &apart, roundings, tolerances, &motion, out);
                let deepest = DEEPEST * piece.size.min(other.size);
                leave_seam::<S>(
                    cores,
                    &apart,
                    roundings,
                    tolerances,
                    &motion,
                    deepest,
                    || self.beside([a, b]),
                    out,
                );
            }
            law = self.laws.get(piece.material, other.material)?;
            radius = piece.size * other.size / (piece.size + other.size);
        }
        // For the candidate, the antagonist's centre may be a periodic image.
        let [i, j] = bodies.map(of);
        Some(Pair {
            name: (a, b),
            bodies,
            law,
            radius,
            origins: [own_centre - apart - i, centre - j],
        })
    }

    /// Creates contacts from the contact points within the alert distance, with the memory of old
    /// ones.
    fn create_contacts(&self, pair: &Pair<S>, scratch: &mut Scratch<S>, found: &mut Found<S>) {
        let (network, origins) = (self.network, pair.origins);
        let Scratch {
            points,
            matched,
            ways,
            met,
            taken,
            ..
        } = scratch;
        let old = found.old();
        match_old_contacts(old, points, &origins[0], matched, ways);
        met.clear();
        let pairs = points.iter().copied().zip(matched.iter().copied());
        met.extend(
            pairs.filter(|(m, before)| {
                m.gap < network.alert || held(network, before.map(|k| &old[k]))
            }),
        );
        // A face in 3D may lose a corner; a bond there continues at the nearest remaining one.
        for (k, contact) in old.iter().enumerate() {
            if held(network, Some(contact)) && !met.iter().any(|m| m.1 == Some(k)) {
                let at = contact.arms[0] - origins[0];
                let far = |m: &ContactPoint<S::Vector>| (m.on_candidate - at).norm();
                let nearest = points.iter().min_by(|m, n| far(m).total_cmp(&far(n)));
                let feature = contact.key.feature;
                met.extend(nearest.map(|m| (ContactPoint { feature, ..*m }, Some(k))));
            }
        }
        met.sort_by_key(|(m, _)| m.feature);
        taken.clear();
        taken.resize(old.len(), false);
        for (m, before) in met.iter() {
            let touch = Touch {
                key: Key {
                    candidate: pair.name.0,
                    antagonist: pair.name.1,
                    feature: m.feature,
                },
                bodies: pair.bodies,
                law: pair.law,
                central: false,
                vertex_contact: !m.facing,
                geometry: ContactGeometry {
                    gap: m.gap,
                    normal: m.normal,
                    arms: [m.on_candidate + origins[0], m.on_antagonist + origins[1]],
                    radius: if m.share > 0.0 { m.share } else { pair.radius },
                },
            };
            match before {
                Some(k) => {
                    taken[*k] = true;
                    found.renew(self, *k, &touch);
                }
                None => found.add(self, &touch, pair.radius),
            }
        }
        found.drop_others(|k| taken[k]);
    }
}

/// Returns the old contact that each contact point continues: first that of the same corner, then
/// the nearest of those whose corner is no longer found, in order of distance. If one of two old
/// contacts is gone, a new point at the other end of the face must not take over the remaining one.
fn match_old_contacts<S: Space>(
    old: &[Contact<S>],
    contact_points: &[ContactPoint<S::Vector>],
    origin: &S::Vector,
    matched: &mut Vec<Option<usize>>,
    ways: &mut Vec<(f64, usize, usize)>,
) {
    matched.clear();
    for m in contact_points {
        // With a period two points may have the same key.
        let same = |k: &usize| old[*k].key.feature == m.feature;
        let found = (0..old.len()).find(|k| same(k) && !matched.contains(&Some(*k)));
        matched.push(found);
    }
    ways.clear();
    for (k, m) in contact_points.iter().enumerate() {
        for (at, contact) in old.iter().enumerate() {
            if matched[k].is_none() && !matched.contains(&Some(at)) {
                let way = contact.arms[0] - (m.on_candidate + *origin);
                ways.push((way.norm(), k, at));
            }
        }
    }
    ways.sort_by(|x, y| x.0.total_cmp(&y.0));
    for (_, k, at) in ways.iter().copied() {
        if matched[k].is_none() && !matched.contains(&Some(at)) {
            matched[k] = Some(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    fn contact_point(x: f64, feature: u64) -> ContactPoint<Vector2<f64>> {
        let at = Vector2::new(x, 0.0);
        ContactPoint {
            on_candidate: at,
            on_antagonist: at,
            normal: Vector2::new(0.0, 1.0),
            gap: 0.0,
            feature,
            share: 1.0,
            facing: true,
        }
    }

    fn contact(x: f64, feature: u64) -> Contact<Dim2> {
        let arm = Vector2::new(x, 0.0);
        Contact {
            slot: 0,
            ..Contact::new(
                Key {
                    candidate: Key::PIECE,
                    antagonist: Key::PIECE | 1,
                    feature,
                },
                [0, 1],
                0,
                ContactGeometry {
                    gap: 0.0,
                    normal: Vector2::new(0.0, 1.0),
                    arms: [arm, arm],
                    radius: 1.0,
                },
                0.0,
            )
        }
    }

    /// The bond at one end of a face broke and its contact separated; at the other end the corner
    /// got another key.
    #[test]
    fn a_bond_stays_at_its_end_of_the_face_when_names_change() {
        let of = |old: &[Contact<Dim2>], new: &[ContactPoint<Vector2<f64>>]| {
            let (mut matched, mut ways) = (vec![None], Vec::new());
            match_old_contacts(old, new, &Vector2::zeros(), &mut matched, &mut ways);
            matched
        };
        let new = [contact_point(-1.0, 4), contact_point(1.0, 6)];
        assert_eq!(of(&[contact(1.0, 3)], &new), [None, Some(0)]);
        assert_eq!(of(&[contact(-1.0, 3)], &new), [Some(0), None]);
        // Equal keys take precedence over distance; the others continue the nearest remaining
        // contact.
        assert_eq!(
            of(&[contact(0.9, 4), contact(0.8, 3)], &new),
            [Some(0), Some(1)]
        );
        let both = [contact(0.9, 7), contact(-0.5, 9)];
        assert_eq!(of(&both, &new), [Some(1), Some(0)]);
    }
}
