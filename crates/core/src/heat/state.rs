//! What steps change of heat and current; a checkpoint holds all of it.

use super::circuit::CircuitState;
use super::ledger::HeatLedger;
use fretwork_math::diffusion::Node;
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
    /// Temperature of each node that its body has expanded to (K); empty where no body of finite elements expands.
    pub expanded: Vec<f64>,
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

    /// Whether it is a later state of the same nodes.
    pub(crate) fn fits(&self, first: &Self) -> bool {
        let nodes = self.nodes.iter().zip(&first.nodes);
        let lengths = |s: &Self| {
            [
                s.nodes.len(),
                s.pending.len(),
                s.received.len(),
                s.stretch.len(),
                s.expanded.len(),
            ]
        };
        lengths(self) == lengths(first) && nodes.into_iter().all(|(a, b)| a.fits(b))
    }

    /// In how many steps of the mechanics, this one included, bodies come to the size of their temperature.
    pub(crate) fn parts(&self, every: u64) -> f64 {
        every.saturating_sub(self.pending_steps).max(1) as f64
    }

    /// Takes work of expansion (J) from the heat of a node.
    pub(crate) fn pay_for_expansion(&mut self, node: usize, work: f64) {
        self.pending[node] -= work;
        self.ledger.pending -= work;
        self.ledger.expansion += work;
    }
}
