//! An electric circuit through the contacts of a scene: a supply between two first bodies.

use serde::{Deserialize, Serialize};

/// The source of the current.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Supply {
    /// A voltage (V).
    Voltage(f64),
    /// A current (A; A/m in 2D) with a limit of the voltage (V), as in laboratory measurements of
    /// contact resistance: the voltage of an open contact is the limit.
    Current {
        /// Current (A; A/m in 2D).
        current: f64,
        /// Largest voltage (V).
        limit: f64,
    },
}

/// A supply between two bodies. Bodies conduct far better than contacts: each has one potential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circuit {
    /// Body into which the current flows.
    pub from: u32,
    /// Body out of which the current flows, with potential 0.
    pub to: u32,
    /// Source.
    pub supply: Supply,
}

impl Circuit {
    /// Returns the voltage (V) if the conductance between the bodies is `conductance` (S).
    pub fn voltage(&self, conductance: f64) -> f64 {
        match self.supply {
            Supply::Voltage(voltage) => voltage,
            Supply::Current { current, limit } if conductance > 0.0 => {
                (current / conductance).clamp(-limit, limit)
            }
            Supply::Current { current: 0.0, .. } => 0.0,
            Supply::Current { current, limit } => limit * current.signum(),
        }
    }
}

/// The circuit in the last step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CircuitState {
    /// Voltage between the bodies (V).
    pub voltage: f64,
    /// Current (A; A/m in 2D).
    pub current: f64,
    /// Conductance between the bodies (S; S/m in 2D); 0 if no path connects them. The resistance is
    /// its inverse.
    pub conductance: f64,
    /// Potential of each body (V); 0 without a path to it.
    pub potential: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_supply_of_current_is_bounded_by_its_voltage() {
        let circuit = |supply| Circuit {
            from: 0,
            to: 1,
            supply,
        };
        let supply = circuit(Supply::Current {
            current: -0.1,
            limit: 5.0,
        });
        assert_eq!(supply.voltage(0.5), -0.2);
        assert_eq!(supply.voltage(1e-3), -5.0);
        assert_eq!(supply.voltage(0.0), -5.0);
        assert_eq!(circuit(Supply::Voltage(2.0)).voltage(0.0), 2.0);
    }
}
