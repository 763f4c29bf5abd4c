//! Checks that contacts read from a file belong to a scene: every index is in range, every column
//! has the right length, every number is finite. Detection and laws rely on it.

use super::memory::Memory;
use super::network::{Contact, Key, Network, ShapeIndex};
use crate::bodies::Bodies;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};

impl<S: Space> Network<S> {
    /// Returns whether this is a network of these shapes and bodies, with memory like that of
    /// `built`.
    pub(crate) fn fits(&self, built: &Self, shapes: &Shapes<S>, bodies: &Bodies<S>) -> bool {
        let below = |two: &[u32; 2]| two.iter().all(|b| (*b as usize) < bodies.len());
        let law = |law: u16| usize::from(law) < self.memory.len();
        let broken = self
            .bond_breaks
            .iter()
            .all(|b| below(&b.bodies) && law(b.law));
        let formed = self.bonds_formed.iter().all(|(b, l)| below(b) && law(*l));
        let pair = |(a, b): &(u32, u32)| {
            let two = [
                ShapeIndex::of(*a).body(shapes),
                ShapeIndex::of(*b).body(shapes),
            ];
            *a & Key::SURFACE == 0 && two.iter().all(Option::is_some) && two[0] != two[1]
        };
        let surface = |k: &usize| *k < shapes.surfaces.len();
        let memory = self.memory.iter().zip(&built.memory);
        // Detection searches contacts by pair.
        self.contacts.is_sorted_by_key(|c| c.key.pair())
            && self.contacts.iter().all(|c| self.has(c, shapes))
            && self.candidates.iter().all(pair)
            && self.memory.len() == built.memory.len()
            && memory.into_iter().all(|(m, built)| m.fits(built))
            && broken
            && formed
            && self.worn.keys().all(surface)
            && self.of_grains == built.of_grains
            && [self.alert, self.skin, self.fast].iter().all(|x| *x >= 0.0)
            && self.seen_at.iter().all(VectorLike::is_finite)
    }

    /// Returns whether a contact is between contactors of these shapes.
    fn has(&self, c: &Contact<S>, shapes: &Shapes<S>) -> bool {
        let bodies =
            [c.key.candidate, c.key.antagonist].map(|side| ShapeIndex::of(side).body(shapes));
        let vectors = [c.normal, c.arms[0], c.arms[1], c.impulse];
        let memory = self.memory.get(usize::from(c.law));
        bodies == c.bodies.map(Some)
            && bodies[0] != bodies[1]
            && c.key.candidate & Key::SURFACE == 0
            && memory.is_some_and(|m| c.memory().is_none_or(|slot| slot < m.bonds.len()))
            && vectors.iter().all(VectorLike::is_finite)
            && c.gap.is_finite()
    }
}

impl<S: Space> Memory<S> {
    /// Returns whether all columns have one value per slot, and are the columns of the same laws.
    fn fits(&self, built: &Self) -> bool {
        let slots = self.bonds.len();
        let rotations = if self.rotates { slots } else { 0 };
        self.variables.len() == built.variables.len()
            && self.variables.iter().all(|column| column.len() == slots)
            && (self.rotates, self.compliant) == (built.rotates, built.compliant)
            && self.rotations.len() == rotations
            && self
                .free_slots()
                .iter()
                .all(|slot| (*slot as usize) < slots)
    }
}
