//! What a node stores.

use crate::half_space::HalfSpace;
use serde::{Deserialize, Serialize};

/// Where the heat of a node goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Store {
    /// Its temperature is given; any heat flows in or out.
    Fixed,
    /// A heat capacity (J/K), with one temperature.
    Lumped(f64),
    /// The surface of a half-space.
    HalfSpace(Box<HalfSpace>),
}

/// A node of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Temperature (K); of a half-space that of its surface.
    pub temperature: f64,
    /// What stores its heat.
    pub store: Store,
    /// Conductance to surroundings (W/K), by convection or radiation; zero for none.
    pub surroundings: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
}

impl Node {
    /// A node without surroundings.
    pub fn new(temperature: f64, store: Store) -> Self {
        Self {
            temperature,
            store,
            surroundings: 0.0,
            ambient: temperature,
        }
    }

    /// Heat stored since a reference temperature (J); 0 where the temperature is fixed.
    pub fn heat(&self, reference: f64) -> f64 {
        match &self.store {
            Store::Fixed => 0.0,
            Store::Lumped(capacity) => capacity * (self.temperature - reference),
            Store::HalfSpace(space) => space.heat(reference),
        }
    }
}
