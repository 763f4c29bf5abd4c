//! The account of heat.

use crate::energy::{LedgerEntry, entries};
use fretwork_math::diffusion::Balance;
use serde::{Deserialize, Serialize};

/// Heat since the start (J; per metre of depth in 2D):
/// dissipated + joule + imposed + surroundings - expansion = stored + fixed + pending + residual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatLedger {
    /// Heat from mechanical dissipation: the shares that the case gives of the entries of
    /// [`crate::energy::Energy`].
    pub dissipated: f64,
    /// Heat from electric current.
    pub joule: f64,
    /// Heat flows that the case imposes on bodies.
    pub imposed: f64,
    /// Heat from surroundings.
    pub surroundings: f64,
    /// Heat converted to work by thermal expansion.
    pub expansion: f64,
    /// Heat stored in grains and first bodies.
    pub stored: f64,
    /// Heat received by bodies of fixed temperature, and dissipated at contacts of two insulated
    /// bodies.
    pub fixed: f64,
    /// Heat that is not yet part of a step of the heat, where one spans several steps of the
    /// mechanics.
    pub pending: f64,
    /// Residual of the balance.
    pub residual: f64,
    /// Largest heat supplied, stored, received by a first body, or exchanged through all contacts
    /// in one step, so far.
    pub scale: f64,
}

impl HeatLedger {
    /// Adds the flows of a step of the heat, in which `exchanged` passed through contacts (J).
    pub(crate) fn add_step(&mut self, balance: &Balance, exchanged: f64) {
        self.scale = self.scale.max(exchanged);
        self.surroundings += balance.surroundings;
        self.stored += balance.stored;
        self.fixed += balance.fixed;
        self.pending = 0.0;
    }

    /// Computes the residual and the scale.
    pub(crate) fn close(&mut self, received: &[f64]) {
        let put_in =
            self.dissipated + self.joule + self.imposed + self.surroundings - self.expansion;
        let found = self.stored + self.fixed + self.pending;
        self.residual = put_in - found;
        let seen = [
            self.dissipated,
            self.joule,
            self.imposed,
            self.surroundings,
            self.expansion,
            self.stored,
            self.fixed,
        ];
        let all = seen.iter().chain(received);
        self.scale = all.fold(self.scale, |m, x| m.max(x.abs()));
    }

    /// Returns the residual over the largest heat so far; 0 where none flowed.
    pub fn relative_residual(&self) -> f64 {
        if self.scale > 0.0 {
            self.residual.abs() / self.scale
        } else {
            0.0
        }
    }

    /// Returns every entry: name, description, value (J; J/m in 2D).
    pub fn entries(&self) -> [LedgerEntry; 9] {
        entries!(self, scale;
            dissipated: "heat that mechanical dissipation put in",
            joule: "heat that electric current put in",
            imposed: "heat imposed on bodies",
            surroundings: "heat taken in from surroundings, negative where they cool",
            expansion: "heat turned into work by thermal expansion",
            stored: "heat stored in grains and first bodies",
            fixed: "heat gone into bodies of fixed temperature",
            pending: "heat put in since the last step of the heat",
            residual: "what does not add up: the first four entries less expansion, stored, fixed and pending",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Supplied heat is stored, has entered bodies of fixed temperature, or is pending; the scale
    /// is the largest of all, and does not decrease.
    #[test]
    fn heat_that_is_accounted_for_leaves_no_residual() {
        let mut ledger = HeatLedger {
            dissipated: 3.0,
            joule: 2.0,
            imposed: 1.0,
            expansion: 0.5,
            pending: 5.5,
            ..HeatLedger::default()
        };
        ledger.close(&[]);
        assert_eq!((ledger.residual, ledger.scale), (0.0, 3.0));
        let balance = Balance {
            surroundings: -1.5,
            stored: 1.0,
            fixed: 3.0,
            ..Balance::default()
        };
        ledger.add_step(&balance, 7.0);
        ledger.close(&[]);
        assert_eq!((ledger.pending, ledger.residual), (0.0, 0.0));
        assert_eq!(ledger.scale, 7.0);
        ledger.close(&[1.0, -8.0]);
        ledger.close(&[]);
        assert_eq!(ledger.scale, 8.0);
        ledger.residual = -2.0;
        assert_eq!(ledger.relative_residual(), 0.25);
        assert_eq!(HeatLedger::default().relative_residual(), 0.0);
    }
}
