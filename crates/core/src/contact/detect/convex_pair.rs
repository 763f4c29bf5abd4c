//! Contacts of convex pieces with balls, with each other and with surfaces, several contact points per pair.

use super::narrow::Narrow;
use super::{SLACK, drop_contact, frame, held};
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::convex::{ContactPoint, ContactTolerances, Core};
use crate::geometry::space::{Space, VectorLike};

/// The pair: bodies, materials, and the size used where the contact point defines none (m).
pub(super) struct Pair<S: Space> {
    name: (u32, u32),
    bodies: [u32; 2],
    law: u16,
    radius: f64,
    /// Vectors from the centres of the two bodies to the origin of the contact points (m).
    origins: [S::Vector; 2],
}

/// Contact points of pairs with at least one convex piece.
pub(super) struct PairPoints<S: Space> {
    /// Each pair, `None` if it has no law, and the end of its points.
    pairs: Vec<(Option<Pair<S>>, usize)>,
    points: Vec<ContactPoint<S::Vector>>,
}

impl<S: Space> PairPoints<S> {
    /// Iterates over the pairs and their points.
    pub(super) fn iter(
        &self,
    ) -> impl Iterator<Item = (&Option<Pair<S>>, &[ContactPoint<S::Vector>])> {
        let mut from = 0;
        self.pairs.iter().map(move |(pair, end)| {
            let points = &self.points[from..*end];
            from = *end;
            (pair, points)
        })
    }
}

impl<S: Space> Narrow<'_, S> {
    /// Finds the contact points of those pairs that have a convex piece.
    pub(super) fn find_points(&self, network: &Network<S>, pairs: &[(u32, u32)]) -> PairPoints<S> {
        let mut found = PairPoints {
            pairs: Vec::new(),
            points: Vec::new(),
        };
        let old = &network.old;
        // Pairs and contacts are sorted.
        let mut at = pairs
            .first()
            .map_or(0, |first| old.partition_point(|c| c.key.pair() < *first));
        let mut points = Vec::new();
        for &(a, b) in pairs.iter().filter(|(a, b)| (a | b) & Key::PIECE != 0) {
            while old.get(at).is_some_and(|c| c.key.pair() < (a, b)) {
                at += 1;
            }
            let of_pair = old[at..].iter().take_while(|c| c.key.pair() == (a, b));
            let old = at..at + of_pair.count();
            at = old.end;
            let tolerances = ContactTolerances {
                reach: self.reach(network, old.clone()),
                slack: SLACK * network.alert,
                held: old.clone().any(|k| held(network, Some(k))),
            };
            points.clear();
            let pair = self.contact_points(a, b, &tolerances, &mut points);
            found.points.append(&mut points);
            found.pairs.push((pair, found.points.len()));
        }
        found
    }

    /// Updates the contacts of a pair with at least one convex piece.
    pub(super) fn convex_pair(
        &mut self,
        network: &mut Network<S>,
        name: (u32, u32),
        pair: &Option<Pair<S>>,
        points: &[ContactPoint<S::Vector>],
    ) {
        let old = self.old_contacts_of(network, name);
        match pair {
            Some(pair) => self.create_contacts(network, pair, points, old),
            None => old.for_each(|k| drop_contact(network, k)),
        }
    }

    /// Finds the contact points of a pair in world axes. `None` if the pair has no law.
    fn contact_points(
        &self,
        a: u32,
        b: u32,
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    ) -> Option<Pair<S>> {
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
            let (origin, rotation) = frame(surface.body, &surface.offset, self.bodies);
            let closed = surface.shape.is_closed();
            let mut apart = self.centres[balls + k] - origin;
            if closed {
                apart = self.shapes.periodic.shortest(apart);
            }
            let place = S::unrotate(&rotation, &apart);
            // The core in the surface's axes.
            let core = self.cores[k].turned(&S::inverse(&rotation));
            core.contact_points_with_surface(
                surface.shape.as_ref(),
                &place,
                piece.rounding,
                tolerances,
                out,
            );
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
            let meeting =
                self.cores[k].contact_point_with_ball(&apart, ball.radius, other.rounding);
            if meeting.gap <= tolerances.reach {
                out.push(meeting);
            }
            bodies = [ball.body, other.body];
            law = self.laws.get(ball.material, other.material)?;
            let own = S::unrotate(&self.bodies.rotation[ball.body as usize], &meeting.normal);
            radius = ball.size_towards(&own, &self.bodies.length);
        } else {
            let piece = &self.shapes.pieces[at(a)];
            own_centre = self.centres[balls + at(a)];
            apart = self.shapes.periodic.shortest(own_centre - centre);
            let roundings = [piece.rounding, other.rounding];
            self.cores[at(a)].contact_points(&self.cores[k], &apart, roundings, tolerances, out);
            bodies = [piece.body, other.body];
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

    /// Creates contacts from the contact points within the alert distance, with the memory of old ones.
    fn create_contacts(
        &mut self,
        network: &mut Network<S>,
        pair: &Pair<S>,
        contact_points: &[ContactPoint<S::Vector>],
        old: std::ops::Range<usize>,
    ) {
        let origins = pair.origins;
        let matched = match_old_contacts(&network.old, contact_points, old.clone(), &origins[0]);
        let pairs = contact_points.iter().copied().zip(matched);
        let mut met: Vec<_> = pairs
            .filter(|(m, before)| m.gap < network.alert || held(network, *before))
            .collect();
        // A face in 3D may lose a corner; a bond there continues at the nearest remaining one.
        for k in old.clone() {
            if held(network, Some(k)) && !met.iter().any(|m| m.1 == Some(k)) {
                let at = network.old[k].arms[0] - origins[0];
                let far = |m: &ContactPoint<S::Vector>| (m.on_candidate - at).norm();
                let nearest = contact_points
                    .iter()
                    .min_by(|m, n| far(m).total_cmp(&far(n)));
                let feature = network.old[k].key.feature;
                met.extend(nearest.map(|m| (ContactPoint { feature, ..*m }, Some(k))));
            }
        }
        met.sort_by_key(|(m, _)| m.feature);
        let taken: Vec<usize> = met.iter().filter_map(|m| m.1).collect();
        for (m, before) in met {
            let found = Contact {
                vertex_contact: !m.facing,
                ..Contact::new(
                    Key {
                        candidate: pair.name.0,
                        antagonist: pair.name.1,
                        feature: m.feature,
                    },
                    pair.bodies,
                    pair.law,
                    ContactGeometry {
                        gap: m.gap,
                        normal: m.normal,
                        arms: [m.on_candidate + origins[0], m.on_antagonist + origins[1]],
                        radius: if m.share > 0.0 { m.share } else { pair.radius },
                    },
                    self.time,
                )
            };
            self.add_contact(network, found, before, pair.radius);
        }
        for k in old {
            if !taken.contains(&k) {
                drop_contact(network, k);
            }
        }
    }
}

/// Returns the old contact that each contact point continues: first that of the same corner, then the
/// nearest of those whose corner is no longer found, in order of distance. If one of two old contacts is
/// gone, a new point at the other end of the face must not take over the remaining one.
fn match_old_contacts<S: Space>(
    contacts: &[Contact<S>],
    contact_points: &[ContactPoint<S::Vector>],
    old: std::ops::Range<usize>,
    origin: &S::Vector,
) -> Vec<Option<usize>> {
    let mut matched: Vec<Option<usize>> = Vec::with_capacity(contact_points.len());
    for m in contact_points {
        // With a period two points may have the same key.
        let same = |k: &usize| contacts[*k].key.feature == m.feature;
        let found = old
            .clone()
            .find(|k| same(k) && !matched.contains(&Some(*k)));
        matched.push(found);
    }
    let mut ways = Vec::new();
    for (k, m) in contact_points.iter().enumerate() {
        for at in old.clone() {
            if matched[k].is_none() && !matched.contains(&Some(at)) {
                let way = contacts[at].arms[0] - (m.on_candidate + *origin);
                ways.push((way.norm(), k, at));
            }
        }
    }
    ways.sort_by(|x, y| x.0.total_cmp(&y.0));
    for (_, k, at) in ways {
        if matched[k].is_none() && !matched.contains(&Some(at)) {
            matched[k] = Some(at);
        }
    }
    matched
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

    /// The bond at one end of a face broke and its contact separated; at the other end the corner got
    /// another key.
    #[test]
    fn a_bond_stays_at_its_end_of_the_face_when_names_change() {
        let of = |old: &[Contact<Dim2>], new: &[ContactPoint<Vector2<f64>>]| {
            match_old_contacts(old, new, 0..old.len(), &Vector2::zeros())
        };
        let new = [contact_point(-1.0, 4), contact_point(1.0, 6)];
        assert_eq!(of(&[contact(1.0, 3)], &new), [None, Some(0)]);
        assert_eq!(of(&[contact(-1.0, 3)], &new), [Some(0), None]);
        // Equal keys take precedence over distance; the others continue the nearest remaining contact.
        assert_eq!(
            of(&[contact(0.9, 4), contact(0.8, 3)], &new),
            [Some(0), Some(1)]
        );
        let both = [contact(0.9, 7), contact(-0.5, 9)];
        assert_eq!(of(&both, &new), [Some(1), Some(0)]);
    }
}
