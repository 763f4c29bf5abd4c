//! Storage of heat in a node.

use crate::diffusion::half_space::HalfSpace;
use serde::{Deserialize, Serialize};

/// Store of the heat of a node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Store {
    /// The temperature of the node is given; any heat flows in or out.
    Fixed,
    /// A heat capacity (J/K), with one temperature.
    Lumped(f64),
    /// The surface of a half-space.
    HalfSpace(Box<HalfSpace>),
}

/// A node of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Temperature (K); for a half-space that of its surface.
    pub temperature: f64,
    /// Store of its heat.
    pub store: Store,
    /// Conductance to surroundings (W/K), by convection or radiation; zero for none.
    pub surroundings: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
    /// Rounding error of the temperature so far (K), so that many small changes add up.
    pub(crate) lost: f64,
    /// Change of the temperature in the last step (K/s), the initial guess for the next step.
    pub(crate) rate: f64,
}

impl Node {
    /// A node without surroundings.
    pub fn new(temperature: f64, store: Store) -> Self {
        Self {
            temperature,
            store,
            surroundings: 0.0,
            ambient: temperature,
            lost: 0.0,
            rate: 0.0,
        }
    }

    /// Returns whether this is a later state of a node: with the same kind of store, and a finite
    /// temperature.
    pub fn fits(&self, first: &Self) -> bool {
        let store = match (&self.store, &first.store) {
            (Store::Fixed, Store::Fixed) | (Store::Lumped(_), Store::Lumped(_)) => true,
            (Store::HalfSpace(a), Store::HalfSpace(b)) => a.fits(b),
            _ => false,
        };
        store && self.temperature.is_finite()
    }

    /// Adds a change of temperature (K).
    pub(crate) fn change(&mut self, by: f64) {
        add(&mut self.temperature, &mut self.lost, by);
    }

    /// Returns the heat stored relative to a reference temperature (J); 0 where the temperature is
    /// fixed.
    pub fn heat(&self, reference: f64) -> f64 {
        match &self.store {
            Store::Fixed => 0.0,
            Store::Lumped(capacity) => capacity * (self.temperature - reference),
            Store::HalfSpace(space) => space.heat(reference),
        }
    }
}

/// Adds to a sum with compensation of rounding (W. Kahan, Commun. ACM 8 (1965) 40).
pub(crate) fn add(sum: &mut f64, lost: &mut f64, by: f64) {
    let by = by + *lost;
    let new = *sum + by;
    *lost = by - (new - *sum);
    *sum = new;
}
