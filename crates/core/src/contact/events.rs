//! Events and energies of contacts in a step: broken bonds, dissipation, wear.

use super::network::Key;
use serde::{Deserialize, Serialize};

/// A broken bond.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Break {
    /// Key of the bond's contact at that time.
    pub key: Key,
    /// Bodies: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface law.
    pub law: u16,
    /// Position of the contact (m): the candidate's centre plus the lever arm, at q_m of the step.
    /// The third component is zero in the plane.
    pub place: [f64; 3],
    /// Normal opening at failure, and norm of the tangential one (m).
    pub opening: [f64; 2],
    /// Twist and norm of the bending at failure (rad); 0 for a bond that does not resist rotation.
    pub rotation: [f64; 2],
    /// Area (m^2; m in 2D).
    pub area: f64,
    /// Energy still stored when the contact moved out of range, 0 where damage broke the bond (J;
    /// J/m in 2D).
    pub torn: f64,
    /// Whether damage broke the bond; otherwise its contact moved out of range, or a body was
    /// removed.
    pub damaged: bool,
    /// Damage at the start of the step in which the bond broke.
    pub damage_before: f64,
    /// Energy history.
    pub energies: BondEnergies,
}

/// Energy history of a bond since its formation (J; J/m in 2D): the work done on it equals stored
/// energy plus fracture energy plus viscous dissipation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BondEnergies {
    /// Work done on the bond by normal opening, by sliding, and by rotation.
    pub work: [f64; 3],
    /// Fracture energy released by damage, less [`Self::given`].
    pub fracture: f64,
    /// Energy of an opening that was there when the bond formed, and took no work.
    pub given: f64,
    /// Dissipated by damping.
    pub viscous: f64,
    /// Friction work at the contact while the bond was intact: a sum of p . u_th, which may
    /// decrease in a step in which the velocity reverses.
    pub friction: f64,
}

impl BondEnergies {
    /// Returns the fraction of rotation in the work of opening, sliding and rotation; recovered
    /// work does not count.
    pub fn turning(&self) -> f64 {
        let [open, slide, turn] = self.work.map(|w| w.max(0.0));
        let all = open + slide + turn;
        if all > 0.0 { turn / all } else { 0.0 }
    }

    /// Returns the fraction of sliding in the work of opening and sliding, 0 (mode I) to 1 (mode
    /// II); recovered work does not count.
    pub fn mode_mix(&self) -> f64 {
        let [open, slide, _] = self.work.map(|w| w.max(0.0));
        if open + slide > 0.0 {
            slide / (open + slide)
        } else {
            0.0
        }
    }
}

/// Energy dissipated at one contact in one step (J; J/m in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactDissipation {
    /// Energy dissipated by friction.
    pub friction: f64,
    /// Energy dissipated by the impact.
    pub impact: f64,
    /// Work against the strength of a cohesion without opening.
    pub adhesion: f64,
    /// Fracture energy released by damage.
    pub fracture: f64,
    /// Energy dissipated by damping of the bond.
    pub viscous: f64,
    /// Work of removing a penetration, negative: see `solver.correction`.
    pub correction: f64,
}

impl ContactDissipation {
    /// Returns the total dissipation.
    pub fn total(&self) -> f64 {
        self.friction + self.impact + self.adhesion + self.fracture + self.viscous
    }
}

/// Wear at one contact in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactWear {
    /// Index of the contact in [`super::Network::contacts`].
    pub contact: u32,
    /// Volume (m^3; m^3/m in 2D).
    pub volume: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The terms are powers of two, so that the sum shows each of them; the correction is no
    /// dissipation.
    #[test]
    fn a_contact_dissipates_the_sum_of_its_parts() {
        let all = ContactDissipation {
            friction: 1.0,
            impact: 2.0,
            adhesion: 4.0,
            fracture: 8.0,
            viscous: 16.0,
            correction: -32.0,
        };
        assert_eq!(all.total(), 31.0);
    }
}
