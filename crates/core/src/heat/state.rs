//! The state of heat and current: changed by steps, and stored in checkpoints.

use super::circuit::CircuitState;
use super::ledger::HeatLedger;
use fretwork_math::diffusion::{Node, Store};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Temperatures, the account of heat, and the circuit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// Heat supplied to each node since the last step of the heat (J; J/m in 2D).
    pub(crate) pending: Vec<f64>,
    /// Thermal time since the last step of the heat (s).
    pub(crate) pending_time: f64,
    /// Number of steps of the mechanics since the last step of the heat.
    pub(crate) pending_steps: u64,
    /// The account.
    pub ledger: HeatLedger,
    /// Heat that entered each of [`super::Heat::first_bodies`] since the start (J; J/m in 2D):
    /// through its contacts, not from its surroundings.
    pub received: Vec<f64>,
    /// Size of each body over that of the case; empty where none expands.
    pub stretch: Vec<f64>,
    /// Temperature of each node to which its body has expanded (K); empty where no body of finite
    /// elements expands.
    pub expanded: Vec<f64>,
    /// State of the circuit in the last step, if there is one.
    pub circuit: CircuitState,
}

impl HeatState {
    /// Creates the state of these nodes at the start, for a number of first bodies.
    pub fn new(nodes: Vec<Node>, first_bodies: usize) -> Self {
        Self {
            pending: vec![0.0; nodes.len()],
            nodes,
            received: vec![0.0; first_bodies],
            ..Self::default()
        }
    }

    /// Returns the mean temperature of some nodes (K), weighted by capacity where they have one;
    /// `None` without nodes.
    pub fn mean_temperature(&self, nodes: Range<usize>) -> Option<f64> {
        let nodes = self.nodes.get(nodes)?;
        if let [node] = nodes {
            return Some(node.temperature);
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for node in nodes {
            let weight = match &node.store {
                Store::Lumped(capacity) => *capacity,
                Store::HalfSpace(_) => 1.0,
                // A held part of a mesh counts only if all of the mesh is held.
                Store::Fixed => 1e-300,
            };
            sum += weight * node.temperature;
            weights += weight;
        }
        (!nodes.is_empty()).then(|| sum / weights)
    }

    /// Returns whether this is a later state of the same nodes.
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

    /// Returns the number of steps of the mechanics, including this one, in which bodies reach the
    /// size that belongs to their temperature.
    pub(crate) fn parts(&self, every: u64) -> f64 {
        every.saturating_sub(self.pending_steps).max(1) as f64
    }

    /// Subtracts work of thermal expansion (J) from the heat of a node.
    pub(crate) fn take_expansion_work(&mut self, node: usize, work: f64) {
        self.pending[node] -= work;
        self.ledger.pending -= work;
        self.ledger.expansion += work;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_math::diffusion::Node;

    /// The mean is weighted by capacity; nodes of fixed temperature, whose capacity is unbounded,
    /// count only where there are no others.
    #[test]
    fn the_mean_temperature_is_that_of_the_heat_that_is_stored() {
        let lumped = |t, c| Node::new(t, Store::Lumped(c));
        let fixed = |t| Node::new(t, Store::Fixed);
        let nodes = vec![
            fixed(900.0),
            fixed(100.0),
            lumped(300.0, 1.0),
            lumped(400.0, 3.0),
        ];
        let state = HeatState::new(nodes, 0);
        let mean = |range| state.mean_temperature(range);
        assert_eq!(mean(2..4), Some(375.0));
        assert_eq!(mean(1..3), Some(300.0));
        assert_eq!(mean(0..4), Some(375.0));
        assert!((mean(0..2).unwrap() - 500.0).abs() < 1e-9);
        assert_eq!(mean(0..1), Some(900.0));
        assert_eq!((mean(1..1), mean(3..5)), (None, None));
    }
}
