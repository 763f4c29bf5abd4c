//! How a simulation is computed: what a case or a program chooses, and no step changes.

use crate::solve;
use serde::{Deserialize, Serialize};

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

/// How a simulation is computed. No step changes it, and checkpoints do not hold it; a resumed
/// simulation is given the same options by its case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The time scheme.
    pub scheme: Scheme,
    /// The solver. Phases may set another tolerance, see [`super::Simulation::solver_in_force`].
    pub solver: solve::Options,
    /// Steps of the case that the step spans in addition to its own; 0 unless it has grown, see
    /// [`super::Simulation::span_steps`].
    pub grown: u32,
    /// Coupling of damage and opening within a step.
    pub coupling: Coupling,
    /// Fraction of a penetration removed per step, 0 to 1: `solver.correction` of a case.
    pub correction: f64,
    /// Penetration, as a fraction of the smaller body's length, beyond which bodies are moved
    /// apart; 0 for never. See `detection/projection.rs`.
    pub projection: f64,
    /// Whether steps write into [`crate::contact::Network::dissipation`] what every contact
    /// dissipated. Once there, the record is continued until it is set to `None`.
    pub record_dissipation: bool,
}

impl Options {
    /// Length of a step that has not grown (s): events are assigned to steps to half of it.
    pub fn event_step(&self) -> f64 {
        self.scheme.h / (1.0 + f64::from(self.grown))
    }
}

/// The coupling of damage and opening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Coupling {
    /// The step is solved with the damage at its start; damage grows at its end. First order in h.
    Explicit,
    /// The step is solved once, with the mean of the damage at its start and of the damage that the
    /// law gives for the opening predicted from the velocity at its start; damage grows at its end.
    /// Second order in h where velocities are smooth.
    #[default]
    Midpoint,
    /// The step is solved repeatedly until the damage used equals the damage that the resulting
    /// openings give. Damage never decreases between iterations, so that the iteration ends.
    Implicit {
        /// Largest change of damage between two iterations at convergence.
        tolerance: f64,
        /// Maximum number of solves in a step; 50 where it is left out.
        #[serde(default = "default_max_iterations")]
        max_iterations: u32,
    },
}

fn default_max_iterations() -> u32 {
    50
}
