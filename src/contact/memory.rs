//! What bonded contacts remember: the opening, the damage, and the laws' internal variables.

use crate::geometry::space::{Space, VectorLike};

/// A bond: a contact with an opening and a damage.
#[derive(Clone, Debug)]
pub struct Bond<S: Space> {
    /// Normal elongation (m), integrated with u_th so that its work is exact at theta = 1/2.
    pub opening_n: f64,
    /// Tangential opening (m).
    pub opening_t: S::Tangent,
    /// Gap at which the bond was made (m): the bond fills it, so it carries compression there.
    pub gap: f64,
    /// Damage D in \[0, 1\]; 1 is broken.
    pub damage: f64,
    /// Area (m^2).
    pub area: f64,
    /// Energy stored (J).
    pub energy: f64,
    /// Whether this slot is in use.
    pub live: bool,
}

impl<S: Space> Bond<S> {
    /// Whether it still holds.
    pub fn intact(&self) -> bool {
        self.live && self.damage < 1.0
    }
}

/// The bonds of one interface law and the internal variables of its plugins.
#[derive(Clone, Debug)]
pub struct Memory<S: Space> {
    /// Slots; a freed slot is used again.
    pub bonds: Vec<Bond<S>>,
    /// Internal variables, one column each, one value a slot.
    pub variables: Vec<Vec<f64>>,
    /// Bonds ever made.
    pub made: u64,
    /// Bonds that broke.
    pub broken: u64,
    free: Vec<u32>,
}

impl<S: Space> Memory<S> {
    /// A memory with so many internal variables.
    pub fn new(variables: usize) -> Self {
        Self {
            bonds: Vec::new(),
            variables: vec![Vec::new(); variables],
            made: 0,
            broken: 0,
            free: Vec::new(),
        }
    }

    /// A slot for a contact with the given initial variables; an intact bond when `bonded`.
    pub fn allocate(&mut self, bonded: bool, gap: f64, area: f64, initial: &[f64]) -> u32 {
        let bond = Bond {
            opening_n: 0.0,
            opening_t: S::Tangent::null(),
            gap: if bonded { gap } else { 0.0 },
            damage: if bonded { 0.0 } else { 1.0 },
            area,
            energy: 0.0,
            live: true,
        };
        self.made += u64::from(bonded);
        if let Some(slot) = self.free.pop() {
            let k = slot as usize;
            self.bonds[k] = bond;
            for (column, value) in self.variables.iter_mut().zip(initial) {
                column[k] = *value;
            }
            return slot;
        }
        self.bonds.push(bond);
        for (column, value) in self.variables.iter_mut().zip(initial) {
            column.push(*value);
        }
        (self.bonds.len() - 1) as u32
    }

    /// Gives a slot back.
    pub fn release(&mut self, slot: u32) {
        self.bonds[slot as usize].live = false;
        self.free.push(slot);
    }

    /// Sum of the damage of the bonds that hold.
    pub fn intact_damage(&self) -> f64 {
        self.bonds
            .iter()
            .filter(|b| b.intact())
            .map(|b| b.damage)
            .sum()
    }

    /// Energy stored (J).
    pub fn energy(&self) -> f64 {
        self.bonds
            .iter()
            .filter(|b| b.intact())
            .map(|b| b.energy)
            .sum()
    }
}
