//! Temperatures and conductances of contacts in a step.

/// What laws see of heat at each contact, and what they answer, in the order of the contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactHeat {
    /// Temperatures (K) at the start of the step: of the contact, the candidate and the antagonist.
    pub temperature: Vec<[f64; 3]>,
    /// Thermal conductivity 2 k1 k2/(k1 + k2) (W/(m K)) and electrical resistivity (rho1 + rho2)/2 (ohm m) of the pair.
    pub material: Vec<[f64; 2]>,
    /// Thermal (W/K; W/(m K) in 2D) and electrical (S; S/m in 2D) conductance, as transport laws give them; zero without one.
    pub conductance: Vec<[f64; 2]>,
    /// Nodes of candidate and antagonist; `u32::MAX` for an insulated one.
    pub nodes: Vec<[u32; 2]>,
    /// Heat put in over the step (J; J/m in 2D), by dissipation and by current.
    pub source: Vec<f64>,
    /// Whether heat or current flows in this step, so that conductances are asked for.
    pub conducts: bool,
    /// Whether current flows, so that laws are given resistivities.
    pub current: bool,
}
