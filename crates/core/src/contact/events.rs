//! What happens at contacts and is told once: bonds that broke, and where energy went.

use super::network::Key;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// A bond that broke.
#[derive(Clone, Debug)]
pub struct Break<S: Space> {
    /// The name of its contact at that time.
    pub key: Key,
    /// Bodies: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface law.
    pub law: u16,
    /// Where its contact was (m): the candidate's centre and the arm from it, at q_m of the step.
    pub place: S::Vector,
    /// Normal opening at the end, and norm of the tangential one (m).
    pub opening: [f64; 2],
    /// Area (m^2; m in 2D).
    pub area: f64,
    /// What it still stored where it was torn because its contact left all reach, 0 where damage broke it
    /// (J; J/m in 2D).
    pub torn: f64,
    /// Whether damage broke it; else its contact left all reach, or a body was taken out.
    pub damaged: bool,
    /// What it went through.
    pub life: Life,
}

/// What a bond went through since it was made (J; J/m in 2D): the work done on it is what it stores, what damage
/// released and what its damping took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Life {
    /// Work done on the bond by opening, by sliding, and by turning.
    pub work: [f64; 3],
    /// Released by damage.
    pub fracture: f64,
    /// Taken by damping.
    pub viscous: f64,
    /// Dissipated by friction at the contact while the bond held. A sum of p . u_th, which a step on which the
    /// velocity turns may lower.
    pub friction: f64,
}

impl Life {
    /// Share of sliding in the work of opening and sliding, 0 to 1: 0 is mode I, 1 mode II; what the bond gave
    /// back does not count.
    pub fn mode_mix(&self) -> f64 {
        let [open, slide, _] = self.work.map(|w| w.max(0.0));
        if open + slide > 0.0 {
            slide / (open + slide)
        } else {
            0.0
        }
    }
}

/// What was dissipated at one contact in one step (J; J/m in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactDissipation {
    /// By friction.
    pub friction: f64,
    /// By impact.
    pub impact: f64,
    /// Against cohesion without opening.
    pub adhesion: f64,
    /// Released by damage.
    pub fracture: f64,
    /// By damping of the bond.
    pub viscous: f64,
    /// Given by taking an overlap out, negative: see `solver.correction`.
    pub correction: f64,
}

impl ContactDissipation {
    /// All that was dissipated.
    pub fn total(&self) -> f64 {
        self.friction + self.impact + self.adhesion + self.fracture + self.viscous
    }
}

/// What a wear law took off at one contact in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Place of the contact in [`super::Network::contacts`].
    pub contact: u32,
    /// Volume (m^3; m^3/m in 2D).
    pub volume: f64,
}
