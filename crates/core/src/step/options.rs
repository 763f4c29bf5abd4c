//! How a simulation is computed: what a case or a program chooses, and no step changes.

use super::coupling::Coupling;
use crate::solve;

/// The time scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Step (s).
    pub h: f64,
    /// Theta in \[1/2, 1\]: 1/2 conserves energy, 1 damps.
    pub theta: f64,
}

impl Default for Scheme {
    /// A step of 1 ms that conserves energy.
    fn default() -> Self {
        Self {
            h: 1e-3,
            theta: 0.5,
        }
    }
}

/// How a simulation is computed. No step changes it, and checkpoints do not hold it; a resumed simulation is given the same
/// options by its case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The time scheme.
    pub scheme: Scheme,
    /// The solver. Phases may set another tolerance, see [`super::Simulation::solver_in_force`].
    pub solver: solve::Options,
    /// Steps of the case that the step spans in addition to its own; 0 unless it has grown, see [`super::Simulation::span_steps`].
    pub grown: u32,
    /// Coupling of damage and opening within a step.
    pub coupling: Coupling,
    /// Fraction of a penetration removed per step, 0 to 1: `solver.correction` of a case.
    pub correction: f64,
    /// Penetration, as a fraction of the smaller body's length, beyond which bodies are moved apart; 0 for
    /// never. See [`super::projection`].
    pub projection: f64,
    /// Whether steps write into [`crate::contact::Network::dissipation`] what every contact dissipated. Once there, the record is
    /// continued until it is set to `None`.
    pub record_dissipation: bool,
}

impl Options {
    /// Length of a step that has not grown (s): events are assigned to steps to half of it.
    pub fn event_step(&self) -> f64 {
        self.scheme.h / (1.0 + f64::from(self.grown))
    }
}
