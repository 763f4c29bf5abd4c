//! Temperatures and conductances of contacts in a step.

use crate::bodies::Nodes;
use std::sync::Arc;

/// Nodes at which the heat of a contact enters a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeatSide {
    /// The body is insulated.
    #[default]
    Insulated,
    /// Heat enters at a node.
    Node(u32),
    /// Heat enters at a point between nodes of a mesh: index in [`ContactHeat::between`].
    Between(u32),
}

/// Properties of a pair of materials in contact; the first is the candidate's, the second the
/// antagonist's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialPair {
    /// Thermal conductivity 2 k1 k2/(k1 + k2) (W/(m K)) and electrical resistivity (rho1 + rho2)/2
    /// (ohm m).
    pub material: [f64; 2],
    /// Share of the heat that enters the first material, and its weight in the temperature of the
    /// contact: e1/(e1 + e2) with the effusivities e.
    pub share: f64,
}

/// Temperatures and heat paths of a contact in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTemperature {
    /// Temperatures (K) at the start of the step: of the contact, the candidate and the antagonist.
    pub temperature: [f64; 3],
    /// Nodes at which heat enters the candidate and the antagonist.
    pub sides: [HeatSide; 2],
    /// Index of its materials in [`ContactHeat::pairs`].
    pub pair: u32,
}

/// Temperatures that laws receive at each contact, and conductances that they return, in the order
/// of the contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactHeat {
    /// All pairs of materials.
    pub pairs: Arc<[MaterialPair]>,
    /// Temperatures and heat paths.
    pub temperatures: Vec<ContactTemperature>,
    /// Thermal (W/K; W/(m K) in 2D) and electrical (S; S/m in 2D) conductance, as transport laws
    /// give them; zero without one.
    pub conductance: Vec<[f64; 2]>,
    /// Points of meshes to which [`HeatSide::Between`] refers, as sums of nodes with a temperature.
    pub between: Vec<Nodes>,
    /// Heat put in over the step (J; J/m in 2D): by dissipation, and by current.
    pub source: Vec<f64>,
    /// Whether heat or current flows in this step, so that laws compute conductances.
    pub conducts: bool,
    /// Whether current flows, so that laws are given resistivities.
    pub current: bool,
}

impl ContactHeat {
    /// Returns the nodes of a side with their weights, whose sum is 1; no nodes if the side is
    /// insulated.
    pub fn terms(&self, side: HeatSide) -> impl Iterator<Item = (usize, f64)> + '_ {
        let node = match side {
            HeatSide::Node(node) => Some((node as usize, 1.0)),
            _ => None,
        };
        let between = match side {
            HeatSide::Between(k) => self.between.get(k as usize),
            _ => None,
        };
        let of_mesh = between.into_iter().flat_map(Nodes::terms);
        node.into_iter()
            .chain(of_mesh.map(|(node, weight)| (node as usize, weight)))
    }

    /// Returns the temperature of a side (K), where `of` gives the temperature of a node (K);
    /// `None` if the side is insulated.
    pub fn temperature_of(&self, side: HeatSide, of: impl Fn(usize) -> f64) -> Option<f64> {
        match side {
            HeatSide::Insulated => None,
            HeatSide::Node(node) => Some(of(node as usize)),
            HeatSide::Between(_) => Some(self.terms(side).map(|(n, w)| w * of(n)).sum()),
        }
    }
}
