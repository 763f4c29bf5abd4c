//! Outputs of the laws for bonds at the end of a step.

use super::interface::Interface;

/// Outputs of the laws for the bonds of a batch at their new openings, in the order of the members.
#[derive(Debug, Default)]
pub(super) struct BondStep {
    /// Energy of the undamaged bond per area at the new opening (J/m^2).
    pub intact: Vec<f64>,
    /// The new damage.
    pub damage: Vec<f64>,
}

impl BondStep {
    /// Returns the energy per area stored at the new opening and damage (J/m^2).
    pub fn stored(&self, law: &Interface, k: usize) -> f64 {
        let m = law.cohesion().map_or(0.0, |c| c.plugin.degradation);
        let share = if law.damages() {
            degradation_factor(self.damage[k], m)
        } else {
            1.0
        };
        share * self.intact[k]
    }
}

/// Returns (1 - D)^m.
pub(super) fn degradation_factor(damage: f64, m: f64) -> f64 {
    let intact = 1.0 - damage;
    if m == 1.0 {
        intact
    } else if m == 2.0 {
        intact * intact
    } else {
        intact.powf(m)
    }
}
