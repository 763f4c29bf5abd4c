//! Memory of bonded contacts: opening, damage, and the laws' internal variables.

use super::events::BondEnergies;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Serialize};

/// A bond: a contact with an opening and a damage. In two dimensions the data that laws read are in
/// one cache line.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(bound = "")]
#[repr(C, align(64))]
pub struct Bond<S: Space> {
    /// Whether this slot is in use.
    pub live: bool,
    /// Normal elongation (m), integrated with u_th so that its work is exact at theta = 1/2.
    pub opening_n: f64,
    /// Tangential opening (m).
    pub opening_t: S::Tangent,
    /// Rest gap (m), below which the contact is rigid in compression while the bond is intact: the
    /// gap at formation for a law that acts in tension only, zero where springs also push.
    pub gap: f64,
    /// Damage D in \[0, 1\]; 1 is broken.
    pub damage: f64,
    /// Damage used in the step's impulse: D at its start, or the coupling's trial value.
    pub step_damage: f64,
    /// Area (m^2; m in 2D).
    pub area: f64,
    /// Stored energy (J; J/m in 2D).
    pub energy: f64,
    /// Energy history.
    pub energies: BondEnergies,
}

impl<S: Space> Bond<S> {
    /// Returns a slot without a bond, for internal variables only.
    fn none(area: f64) -> Self {
        Self {
            live: true,
            damage: 1.0,
            step_damage: 1.0,
            area,
            ..Self::default()
        }
    }

    /// Returns whether the bond is intact.
    pub fn intact(&self) -> bool {
        self.live && self.damage < 1.0
    }
}

/// How far intact bonds opened or slid per step, over all steps and bonds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SlideStatistics {
    /// Number of steps of bonds.
    pub steps: u64,
    /// Sum of the displacements (m).
    pub sum: f64,
    /// Largest displacement (m).
    pub largest: f64,
    /// Sum of the displacements, each times the energy that damage released in the step (J m; J in
    /// 2D).
    pub by_released: f64,
    /// Sum of the released energies (J; J/m in 2D).
    pub released: f64,
}

impl SlideStatistics {
    /// Adds one step of a bond: its displacement (m), and the energy that damage released (J; J/m
    /// in 2D).
    #[inline]
    pub fn add(&mut self, slide: f64, released: f64) {
        self.steps += 1;
        self.sum += slide;
        self.largest = self.largest.max(slide);
        self.by_released += slide * released;
        self.released += released;
    }

    /// Returns the mean displacement (m).
    pub fn mean(&self) -> Option<f64> {
        (self.steps > 0).then(|| self.sum / self.steps as f64)
    }

    /// Returns the mean displacement weighted by released energy (m).
    pub fn mean_by_released(&self) -> Option<f64> {
        (self.released > 0.0).then(|| self.by_released / self.released)
    }
}

/// The state of the bond of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondState {
    /// There is no bond and never was one.
    None,
    /// The bond is intact.
    Intact {
        /// Damage, 0 to 1.
        damage: f64,
    },
    /// The bond broke.
    Broken,
}

/// The bonds of one interface law and the internal variables of its plugins.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Memory<S: Space> {
    /// Slots; freed slots are reused.
    pub bonds: Vec<Bond<S>>,
    /// Internal variables, one column each, with one value per slot.
    pub variables: Vec<Vec<f64>>,
    /// Whether bonds store their rotation.
    pub rotates: bool,
    /// Whether the contacts of the law are springs, which overlap as they are pressed.
    pub compliant: bool,
    /// Rotations of the bonds (rad), one per slot; empty unless `rotates`.
    pub rotations: Vec<S::Spin>,
    /// Number of bonds formed so far.
    pub made: u64,
    /// Number of bonds broken so far.
    pub broken: u64,
    /// How far bonds opened or slid in a step.
    pub slides: SlideStatistics,
    free: Vec<u32>,
}

impl<S: Space> Memory<S> {
    /// Creates a memory with this number of internal variables.
    pub fn new(variables: usize) -> Self {
        Self {
            variables: vec![Vec::new(); variables],
            ..Self::default()
        }
    }

    /// Allocates a slot for a contact with the given initial variables; if `bonded`, with an intact
    /// bond of rest gap `gap` (m) and `area` (m^2; m in 2D).
    pub fn allocate(&mut self, bonded: bool, gap: f64, area: f64, initial: &[f64]) -> u32 {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.bonds.push(Bond::none(area));
            self.variables.iter_mut().for_each(|c| c.push(0.0));
            if self.rotates {
                self.rotations.push(S::Spin::zero());
            }
            (self.bonds.len() - 1) as u32
        });
        self.bonds[slot as usize] = Bond::none(area);
        self.reset(slot as usize, initial);
        if bonded {
            self.bond(slot as usize, gap, area);
        }
        slot
    }

    fn reset(&mut self, slot: usize, initial: &[f64]) {
        for (column, value) in self.variables.iter_mut().zip(initial) {
            column[slot] = *value;
        }
        if self.rotates {
            self.rotations[slot] = S::Spin::zero();
        }
    }

    /// Forms an intact bond in a slot without a bond or with a broken one; its internal variables
    /// are kept.
    pub fn bond(&mut self, slot: usize, gap: f64, area: f64) {
        self.bonds[slot] = Bond {
            gap,
            damage: 0.0,
            step_damage: 0.0,
            ..Bond::none(area)
        };
        if self.rotates {
            self.rotations[slot] = S::Spin::zero();
        }
        self.made += 1;
    }

    /// Returns the slots that are not in use.
    pub(super) fn free_slots(&self) -> &[u32] {
        &self.free
    }

    /// Frees a slot.
    pub fn release(&mut self, slot: u32) {
        self.bonds[slot as usize].live = false;
        self.free.push(slot);
    }

    /// Returns the sum of the damage of the intact bonds.
    pub fn intact_damage(&self) -> f64 {
        self.bonds
            .iter()
            .filter(|b| b.intact())
            .map(|b| b.damage)
            .sum()
    }

    /// Returns the stored energy of the intact bonds (J; J/m in 2D).
    pub fn energy(&self) -> f64 {
        self.bonds
            .iter()
            .filter(|b| b.intact())
            .map(|b| b.energy)
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of 1, 2 and 6 m that release 3, 0 and 1 J: 3 m on average, and (3 + 6)/4 m by energy.
    #[test]
    fn slides_have_a_mean_by_steps_and_one_by_energy() {
        let mut slides = SlideStatistics::default();
        slides.add(2.0, 0.0);
        assert_eq!(
            (slides.mean(), slides.mean_by_released()),
            (Some(2.0), None)
        );
        slides.add(1.0, 3.0);
        slides.add(6.0, 1.0);
        assert_eq!(
            (slides.mean(), slides.mean_by_released()),
            (Some(3.0), Some(2.25))
        );
        assert_eq!((slides.steps, slides.largest), (3, 6.0));
        assert_eq!(SlideStatistics::default().mean(), None);
    }

    /// A released slot is the next one that is allocated, with a new bond.
    #[test]
    fn slots_are_used_again() {
        let mut network =
            crate::contact::Network::<crate::geometry::space::Dim2>::new(1.0, 1.0, &[0]);
        let memory = &mut network.memory[0];
        let [first, second] = [1.0, 2.0].map(|area| memory.allocate(true, 0.0, area, &[]));
        assert_ne!(first, second);
        memory.bonds[first as usize].damage = 0.5;
        memory.release(first);
        assert!(!memory.bonds[first as usize].intact() && memory.bonds[second as usize].intact());
        assert_eq!(memory.intact_damage(), 0.0);
        assert_eq!(memory.free_slots(), [first]);
        assert_eq!(memory.allocate(true, 0.0, 3.0, &[]), first);
        let again = &memory.bonds[first as usize];
        assert!(again.intact() && again.damage == 0.0 && again.area == 3.0);
        assert!(memory.free_slots().is_empty());
    }
}
