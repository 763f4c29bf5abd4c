//! Names of contacts that do not depend on the order of bodies in memory: identities of the bodies,
//! numbers of their contactors, and the touched feature.
//!
//! A [`Key`] numbers the contactors of one scene as they are listed; it sorts the contacts of a
//! step, and is compared often. A [`ContactId`] names the same contact in another listing of the
//! same bodies, such as a resumed run, a scene from which other bodies were removed, or a part of
//! the scene on another machine. [`ContactNames`] translates between them.

use super::network::{Contact, Key, Network, ShapeIndex};
use crate::bodies::Bodies;
use crate::geometry::convex::Core;
use crate::geometry::shape::Shapes;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Kind of a contactor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ContactorKind {
    /// A disk or sphere.
    Ball,
    /// A convex piece.
    ConvexCollider,
    /// A surface of a first body.
    Surface,
}

/// A part of a body that can touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ContactorId {
    /// Kind.
    pub kind: ContactorKind,
    /// Identity of the body, [`Bodies::id`].
    pub body: u64,
    /// Number among the body's contactors of this kind, from 0.
    pub number: u32,
}

/// Name of a contact: both contactors in ascending order, and the touched feature, 0 between balls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ContactId {
    /// The contactors, the smaller first; either may be the candidate of detection.
    pub sides: [ContactorId; 2],
    /// The feature as [`Key::feature`], with the first side as the candidate.
    pub feature: u64,
}

/// The contactors of a scene by their numbers in keys.
#[derive(Clone, Debug, Default)]
pub struct ContactNames {
    balls: Vec<ContactorId>,
    pieces: Vec<ContactorId>,
    surfaces: Vec<ContactorId>,
}

impl ContactNames {
    /// Names the contactors of these shapes and bodies. Valid as long as neither list changes.
    pub fn of<S: Space>(shapes: &Shapes<S>, bodies: &Bodies<S>) -> Self {
        let numbered = |kind: ContactorKind, count: usize, shape: fn(usize) -> ShapeIndex| {
            let mut next = vec![0u32; bodies.len()];
            let contactor = |k: usize| {
                let body = shape(k).body(shapes)? as usize;
                let number = next[body];
                next[body] += 1;
                let body = bodies.id[body];
                Some(ContactorId { kind, body, number })
            };
            (0..count).filter_map(contactor).collect()
        };
        let (pieces, surfaces) = (shapes.pieces.len(), shapes.surfaces.len());
        Self {
            balls: numbered(ContactorKind::Ball, shapes.balls.len(), ShapeIndex::Ball),
            pieces: numbered(ContactorKind::ConvexCollider, pieces, ShapeIndex::Piece),
            surfaces: numbered(ContactorKind::Surface, surfaces, ShapeIndex::Surface),
        }
    }

    /// Returns the contactor of a part of a key.
    fn contactor(&self, part: u32) -> Option<ContactorId> {
        match ShapeIndex::of(part) {
            ShapeIndex::Ball(k) => self.balls.get(k),
            ShapeIndex::Piece(k) => self.pieces.get(k),
            ShapeIndex::Surface(k) => self.surfaces.get(k),
        }
        .copied()
    }

    /// Returns the contactors of a key, the candidate first; `None` if the scene has no such
    /// contactors.
    pub fn sides(&self, key: &Key) -> Option<[ContactorId; 2]> {
        Some([
            self.contactor(key.candidate)?,
            self.contactor(key.antagonist)?,
        ])
    }

    /// Returns the name of the contact with a key; `None` where the scene has no such contactors.
    pub fn id<S: Space>(&self, key: &Key) -> Option<ContactId> {
        let sides = self.sides(key)?;
        if sides[0] <= sides[1] {
            let feature = key.feature;
            return Some(ContactId { sides, feature });
        }
        let both = sides
            .iter()
            .all(|s| s.kind == ContactorKind::ConvexCollider);
        let feature = if both {
            S::Core::feature_from_other_side(key.feature)
        } else {
            key.feature
        };
        let sides = [sides[1], sides[0]];
        Some(ContactId { sides, feature })
    }

    /// Returns all contacts of a network by name, as indices in [`Network::contacts`].
    pub fn places<S: Space>(&self, network: &Network<S>) -> BTreeMap<ContactId, usize> {
        let contacts = network.contacts.iter().enumerate();
        contacts
            .filter_map(|(k, c)| Some((self.id::<S>(&c.key)?, k)))
            .collect()
    }

    /// Returns the pairs of contacts of two networks that have the same name, in the order of the
    /// names. `other` names the contacts of the second network.
    pub fn matched<'a, S: Space>(
        &self,
        network: &'a Network<S>,
        other: &Self,
        second: &'a Network<S>,
    ) -> Vec<(&'a Contact<S>, &'a Contact<S>)> {
        let theirs = other.places(second);
        let ours = self.places(network).into_iter();
        ours.filter_map(|(id, k)| {
            let at = theirs.get(&id)?;
            Some((&network.contacts[k], &second.contacts[*at]))
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polyline::Polyline;
    use crate::geometry::space::Dim2;
    use crate::laws::sample_laws::interface;
    use crate::step::Simulation;
    use nalgebra::Vector2;

    /// Contacts of disks of the bodies 0, 1 and 0 and a surface of the body 2 have the same names
    /// when bodies and shapes are listed in reverse order.
    #[test]
    fn names_do_not_depend_on_the_order_of_the_shapes() {
        let mut s = Simulation::<Dim2>::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)]);
        let again = s.shapes.balls[0].clone();
        s.shapes.balls.push(again);
        let chain = [-1.0, 1.0].map(|x| Vector2::new(x, 0.0)).to_vec();
        s.add_surface(Polyline::new(chain, None).unwrap());
        let names = ContactNames::of(&s.shapes, &s.state.bodies);
        s.shapes.balls.swap(0, 1);
        let swapped = ContactNames::of(&s.shapes, &s.state.bodies);
        let key = |candidate, antagonist| Key::new(candidate, antagonist, 3);
        let name = |kind, body, number| ContactorId { kind, body, number };
        let [ball, second, other] =
            [(0, 0), (0, 1), (1, 0)].map(|(b, n)| name(ContactorKind::Ball, b, n));
        let surface = name(ContactorKind::Surface, 2, 0);
        let on_surface = Key::SURFACE;
        for (mine, theirs, sides) in [
            (key(0, 1), key(0, 1), [ball, other]),
            (key(0, 2), key(1, 2), [ball, second]),
            (key(1, 2), key(0, 2), [second, other]),
            (key(1, on_surface), key(0, on_surface), [other, surface]),
        ] {
            let id = ContactId { sides, feature: 3 };
            assert_eq!(names.id::<Dim2>(&mine), Some(id));
            assert_eq!(swapped.id::<Dim2>(&theirs), Some(id));
        }
        assert_eq!(names.sides(&key(1, 0)), Some([other, ball]));
        for missing in [3, Key::PIECE, Key::SURFACE | 1] {
            assert_eq!(names.id::<Dim2>(&key(0, missing)), None);
        }
    }

    /// Three disks in a row have the order 0, 1, 2 in one scene, and 2, 1, 0 in another: both
    /// contacts have partners. In a scene without the last disk one contact has a partner.
    #[test]
    fn contacts_of_one_name_are_matched() {
        let scene = |order: &[u32]| {
            let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5), ([2.0, 0.0], 0.5)];
            let mut s = Simulation::<Dim2>::of_disks(&disks);
            let balls = &s.shapes.balls;
            s.shapes.balls = order.iter().map(|k| balls[*k as usize].clone()).collect();
            let names = ContactNames::of(&s.shapes, &s.state.bodies);
            let mut s = s.with_law(interface([]));
            s.step().unwrap();
            (names, s)
        };
        let (names, s) = scene(&[0, 1, 2]);
        let pairs = |other: &(ContactNames, Simulation<Dim2>)| -> Vec<[[u32; 2]; 2]> {
            let network = &other.1.state.network;
            let matched = names.matched(&s.state.network, &other.0, network);
            let bodies = |c: &Contact<Dim2>| {
                let [a, b] = c.bodies;
                [a.min(b), a.max(b)]
            };
            matched
                .iter()
                .map(|(a, b)| [bodies(a), bodies(b)])
                .collect()
        };
        let [one, two] = [[0, 1], [1, 2]];
        assert_eq!(pairs(&scene(&[2, 1, 0])), [[one, one], [two, two]]);
        assert_eq!(pairs(&scene(&[1, 0])), [[one, one]]);
    }
}
