//! Contacts of convex pieces with balls, with each other and with surfaces, several contact points
//! per pair.

use super::narrow::{Narrow, Scratch};
use super::update::{ContactUpdate, DetectedContact};
use super::{CollisionScene, SLACK, held};
use crate::contact::network::{Contact, ContactGeometry, Key, ShapeIndex};
use crate::geometry::convex::passing::{
    PairMotion, keep_apart, keep_apart_from_surface, keep_ball_apart,
};
use crate::geometry::convex::seam::{AdjacentPiece, MAX_SEAM_DEPTH, ball_is_over_seam, leave_seam};
use crate::geometry::convex::{ContactPoint, ContactTolerances, Core, CorePair};
use crate::geometry::space::{Space, VectorLike};

/// Rounding error of the cosine between two directions.
const ROUNDING: f64 = 1e-12;

/// A pair of shapes of which at least one is a convex piece.
struct ShapePair<S: Space> {
    /// Candidate and antagonist, numbered as in a [`Key`].
    name: (u32, u32),
    bodies: [u32; 2],
    law: u16,
    /// Reduced radius of contacts whose point defines none (m).
    radius: f64,
    /// Vectors from the centres of the two bodies to the origin of the contact points (m).
    origins: [S::Vector; 2],
}

impl<S: Space> Narrow<'_, S> {
    /// Updates the contacts of a pair with at least one convex piece.
    pub(super) fn convex_pair(
        &self,
        name: (u32, u32),
        scratch: &mut Scratch<S>,
        update: &mut ContactUpdate<S>,
    ) {
        let held = update.old().iter().any(|c| held(self.network, Some(c)));
        scratch.points.clear();
        let pair = if !held && self.far(name) {
            None
        } else {
            let tolerances = ContactTolerances {
                reach: self.reach(update.old()),
                slack: SLACK * self.network.alert,
                held,
            };
            self.contact_points(name, &tolerances, scratch)
        };
        match pair {
            Some(pair) if !(scratch.points.is_empty() && update.old().is_empty()) => {
                self.create_contacts(&pair, scratch, update);
            }
            _ => update.drop_others(|_| false),
        }
    }

    /// Relative motion of a pair with these centres (m) in a step, at the velocities at its start.
    fn motion(&self, bodies: [u32; 2], centres: [S::Vector; 2]) -> PairMotion<S> {
        let of = |side: usize| {
            let b = bodies[side] as usize;
            let (bodies, h) = (self.placed.scene.bodies, self.placed.h);
            let arm = centres[side] - bodies.position[b];
            let (v, w) = (bodies.velocity[b], bodies.spin[b]);
            ((v + S::spin_velocity(&w, &arm)) * h, w * h)
        };
        let ((shift, turn), (shift_other, turn_other)) = (of(0), of(1));
        PairMotion {
            shift: shift - shift_other,
            turns: [turn, turn_other],
        }
    }

    /// Returns the pieces that may continue either shape of a pair across a seam; the antagonist is
    /// a piece.
    fn adjacent(&self, pair: [u32; 2]) -> Vec<AdjacentPiece<'_, S>> {
        let (shapes, centre) = (self.placed.scene.shapes, |k| self.piece_centre(k));
        self.partners
            .adjacent(self.pairs, shapes, self.cores, centre, pair)
    }

    /// Returns whether the bounding balls of a pair without bonds are too far from each other for
    /// contacts.
    fn far(&self, (a, b): (u32, u32)) -> bool {
        let shapes = self.placed.scene.shapes;
        let ball = |side: u32| {
            let shape = ShapeIndex::of(side);
            let radius = match shape {
                ShapeIndex::Ball(k) => shapes.balls[k].radius,
                ShapeIndex::Piece(k) => shapes.pieces[k].bound,
                ShapeIndex::Surface(_) => return None,
            };
            let place = shape.place(self.placed.scene.counts());
            Some((self.placed.centres[place], radius))
        };
        let (Some((x, r)), Some((y, s))) = (ball(a), ball(b)) else {
            return false;
        };
        let apart = shapes.periodic.shortest(x - y);
        // The limit exceeds the distance at which a corner still counts as lying on a face.
        let limit = r + s + (1.0 + 4.0 * SLACK) * self.network.alert;
        apart.dot(&apart) > limit * limit
    }

    /// Finds the contact points of a pair in world axes. `None` if the pair has no law.
    fn contact_points(
        &self,
        (a, b): (u32, u32),
        tolerances: &ContactTolerances,
        scratch: &mut Scratch<S>,
    ) -> Option<ShapePair<S>> {
        match (ShapeIndex::of(a), ShapeIndex::of(b)) {
            (ShapeIndex::Piece(k), ShapeIndex::Surface(s)) => {
                self.piece_on_surface((a, b), [k, s], tolerances, scratch)
            }
            (ShapeIndex::Ball(k), ShapeIndex::Piece(other)) => {
                self.ball_on_piece((a, b), [k, other], tolerances, &mut scratch.points)
            }
            (ShapeIndex::Piece(k), ShapeIndex::Piece(other)) => {
                self.piece_on_piece((a, b), [k, other], tolerances, &mut scratch.points)
            }
            // A candidate precedes its antagonist in the order balls, pieces, surfaces.
            _ => None,
        }
    }

    /// Centre of a convex piece (m).
    fn piece_centre(&self, piece: usize) -> S::Vector {
        self.placed.centres[self.placed.scene.shapes.balls.len() + piece]
    }

    fn piece_on_surface(
        &self,
        name: (u32, u32),
        [k, s]: [usize; 2],
        tolerances: &ContactTolerances,
        scratch: &mut Scratch<S>,
    ) -> Option<ShapePair<S>> {
        let CollisionScene {
            shapes,
            bodies: state,
            laws,
        } = *self.placed.scene;
        let (piece, surface, centre) =
            (&shapes.pieces[k], &shapes.surfaces[s], self.piece_centre(k));
        let law = laws.get(piece.material, surface.material)?;
        let (bodies, (origin, rotation)) = ([piece.body, surface.body], self.frames[s]);
        let (shape, rounding, out) = (surface.shape.as_ref(), piece.rounding, &mut scratch.points);
        let closed = shape.is_closed();
        let mut apart = centre - origin;
        if closed {
            apart = shapes.periodic.shortest(apart);
        }
        let place = S::unrotate(&rotation, &apart);
        // The core in the surface's axes.
        let own = &self.cores[k];
        let core = scratch.core.get_or_insert_with(|| own.clone());
        own.turn_into(&S::inverse(&rotation), core);
        core.contact_points_with_surface(shape, &place, rounding, tolerances, out);
        if !(out.is_empty() || tolerances.held || shape.deforms()) {
            let motion = self.motion(bodies, [centre, origin]).seen_from(&rotation);
            keep_apart_from_surface::<S>(core, shape, &place, rounding, tolerances, &motion, out);
        }
        for m in out.iter_mut() {
            *m = m.rotated::<S>(&rotation);
            // No bond forms here: the area of a deformable grain is shared among its vertices.
            m.facing &= !closed;
        }
        let [i, j] = bodies.map(|b| state.position[b as usize]);
        Some(ShapePair {
            name,
            bodies,
            law,
            radius: piece.size,
            origins: [centre - apart - i, origin - j],
        })
    }

    fn ball_on_piece(
        &self,
        name: (u32, u32),
        [k, other]: [usize; 2],
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    ) -> Option<ShapePair<S>> {
        let CollisionScene {
            shapes,
            bodies: state,
            laws,
        } = *self.placed.scene;
        let (ball, piece, core) = (&shapes.balls[k], &shapes.pieces[other], &self.cores[other]);
        let (bodies, radius) = ([ball.body, piece.body], ball.radius);
        let centres = [self.placed.centres[k], self.piece_centre(other)];
        let apart = shapes.periodic.shortest(centres[0] - centres[1]);
        let mut point = core.contact_point_with_ball(&apart, radius, piece.rounding);
        if point.gap > 0.0 && !tolerances.held {
            let (sizes, motion) = ([radius, piece.rounding], self.motion(bodies, centres));
            keep_ball_apart::<S>(core, &apart, sizes, tolerances, &motion, &mut point);
        }
        // A contact with the inside of a face, along the normal of the face, is not at a seam.
        let inside = |n: &S::Vector| n.dot(&point.normal) > 1.0 - ROUNDING;
        let adjacent = || self.adjacent([name.0, name.1]);
        let over_seam = point.gap <= tolerances.reach
            && !tolerances.held
            && !core.normals().iter().any(inside)
            && ball_is_over_seam::<S>(&point, &apart, radius, tolerances.slack, name.1, adjacent);
        if point.gap <= tolerances.reach && !over_seam {
            out.push(point);
        }
        let own = S::unrotate(&state.rotation[ball.body as usize], &point.normal);
        Some(ShapePair {
            name,
            bodies,
            law: laws.get(ball.material, piece.material)?,
            radius: ball.radius_towards(&own, &state.length),
            origins: self.origins(bodies, centres, &apart),
        })
    }

    fn piece_on_piece(
        &self,
        name: (u32, u32),
        indices: [usize; 2],
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    ) -> Option<ShapePair<S>> {
        let CollisionScene { shapes, laws, .. } = *self.placed.scene;
        let [one, other] = indices.map(|k| &shapes.pieces[k]);
        let (bodies, centres) = (
            [one.body, other.body],
            indices.map(|k| self.piece_centre(k)),
        );
        let pair = CorePair::<S> {
            cores: indices.map(|k| &self.cores[k]),
            apart: shapes.periodic.shortest(centres[0] - centres[1]),
            roundings: [one.rounding, other.rounding],
            tolerances: *tolerances,
        };
        S::Core::contact_points(&pair, out);
        if !(out.is_empty() || tolerances.held) {
            let motion = self.motion(bodies, centres);
            keep_apart(&pair, &motion, out);
            let deepest = MAX_SEAM_DEPTH * one.size.min(other.size);
            leave_seam(
                &pair,
                &motion,
                deepest,
                || self.adjacent([name.0, name.1]),
                out,
            );
        }
        Some(ShapePair {
            name,
            bodies,
            law: laws.get(one.material, other.material)?,
            radius: one.size * other.size / (one.size + other.size),
            origins: self.origins(bodies, centres, &pair.apart),
        })
    }

    /// Returns [`ShapePair::origins`] of two closed shapes with these centres (m), of which the
    /// candidate's is at `apart` (m) from that of the antagonist or of its nearest periodic image.
    fn origins(
        &self,
        bodies: [u32; 2],
        centres: [S::Vector; 2],
        apart: &S::Vector,
    ) -> [S::Vector; 2] {
        let [i, j] = bodies.map(|b| self.placed.scene.bodies.position[b as usize]);
        [centres[0] - *apart - i, centres[1] - j]
    }

    /// Creates contacts from the contact points within the alert distance, with the memory of old
    /// ones.
    fn create_contacts(
        &self,
        pair: &ShapePair<S>,
        scratch: &mut Scratch<S>,
        update: &mut ContactUpdate<S>,
    ) {
        let (network, origins) = (self.network, pair.origins);
        let Scratch {
            points,
            matched,
            distances,
            selected,
            continued,
            ..
        } = scratch;
        let old = update.old();
        match_old_contacts(old, points, &origins[0], matched, distances);
        selected.clear();
        let pairs = points.iter().copied().zip(matched.iter().copied());
        selected.extend(
            pairs.filter(|(m, before)| {
                m.gap < network.alert || held(network, before.map(|k| &old[k]))
            }),
        );
        // A face in 3D may lose a corner; a bond there continues at the nearest remaining one.
        for (k, contact) in old.iter().enumerate() {
            if held(network, Some(contact)) && !selected.iter().any(|m| m.1 == Some(k)) {
                let at = contact.arms[0] - origins[0];
                let far = |m: &ContactPoint<S::Vector>| (m.on_candidate - at).norm();
                let nearest = points.iter().min_by(|m, n| far(m).total_cmp(&far(n)));
                let feature = contact.key.feature;
                selected.extend(nearest.map(|m| (ContactPoint { feature, ..*m }, Some(k))));
            }
        }
        selected.sort_by_key(|(m, _)| m.feature);
        continued.clear();
        continued.resize(old.len(), false);
        for (m, before) in selected.iter() {
            let found = DetectedContact {
                key: Key::new(pair.name.0, pair.name.1, m.feature),
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
                    continued[*k] = true;
                    update.continue_old(self, *k, &found);
                }
                None => update.add(self, &found, pair.radius),
            }
        }
        update.drop_others(|k| continued[k]);
    }
}

/// Returns the old contact that each contact point continues: first that of the same corner, then
/// the nearest of those whose corner is no longer found, in order of distance. If one of two old
/// contacts no longer exists, a new point at the other end of the face must not take over the
/// remaining one.
fn match_old_contacts<S: Space>(
    old: &[Contact<S>],
    contact_points: &[ContactPoint<S::Vector>],
    origin: &S::Vector,
    matched: &mut Vec<Option<usize>>,
    distances: &mut Vec<(f64, usize, usize)>,
) {
    matched.clear();
    for m in contact_points {
        // With a period two points may have the same key.
        let same = |k: &usize| old[*k].key.feature == m.feature;
        let found = (0..old.len()).find(|k| same(k) && !matched.contains(&Some(*k)));
        matched.push(found);
    }
    distances.clear();
    for (k, m) in contact_points.iter().enumerate() {
        for (at, contact) in old.iter().enumerate() {
            if matched[k].is_none() && !matched.contains(&Some(at)) {
                let apart = contact.arms[0] - (m.on_candidate + *origin);
                distances.push((apart.norm(), k, at));
            }
        }
    }
    distances.sort_by(|x, y| x.0.total_cmp(&y.0));
    for (_, k, at) in distances.iter().copied() {
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
                Key::new(Key::PIECE, Key::PIECE | 1, feature),
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
            let (mut matched, mut distances) = (vec![None], Vec::new());
            match_old_contacts(old, new, &Vector2::zeros(), &mut matched, &mut distances);
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
