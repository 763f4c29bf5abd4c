//! What steps change of heat and current; a checkpoint holds all of it.

use super::circuit::CircuitState;
use super::ledger::HeatLedger;
use fretwork_diffusion::Node;
use serde::{Deserialize, Serialize};

/// Temperatures, the account of heat, and the circuit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// Heat put into each node since the last step of the heat (J; J/m in 2D).
    pub(crate) pending: Vec<f64>,
    /// Thermal time since the last step of the heat (s).
    pub(crate) pending_time: f64,
    /// Steps of the mechanics since then.
    pub(crate) pending_steps: u64,
    /// The account.
    pub ledger: HeatLedger,
    /// Heat that went into each of [`super::Heat::first_bodies`] since the start (J; J/m in 2D): by its contacts, not by its surroundings.
    pub received: Vec<f64>,
    /// Size of each body over that of the case; empty where none expands.
    pub stretch: Vec<f64>,
    /// The circuit in the last step, where there is one.
    pub circuit: CircuitState,
}

impl HeatState {
    /// Nodes at the start, for so many first bodies.
    pub fn new(nodes: Vec<Node>, first_bodies: usize) -> Self {
        Self {
            pending: vec![0.0; nodes.len()],
            nodes,
            received: vec![0.0; first_bodies],
            ..Self::default()
        }
    }
}
