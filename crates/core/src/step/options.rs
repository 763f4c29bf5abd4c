//! Options of the computation, chosen by a case or a program; no step changes them.

use crate::solve;
use serde::{Deserialize, Serialize};

/// The time scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Length of the step (s).
    pub h: f64,
    /// Theta in \[1/2, 1\]: 1/2 conserves energy, 1 damps.
    pub theta: f64,
}

impl Default for Scheme {
    /// Returns a step of 1 ms that conserves energy.
    fn default() -> Self {
        Self {
            h: 1e-3,
            theta: 0.5,
        }
    }
}

/// Options of the computation. No step changes them, and checkpoints do not contain them; a resumed
/// simulation gets the same options from its case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The time scheme.
    pub scheme: Scheme,
    /// The solver. Phases may set another tolerance, see [`super::Simulation::solver_in_force`].
    pub solver: solve::SolverOptions,
    /// Number of steps of the case that a step spans in addition to its own; 0 unless it has grown,
    /// see [`super::Simulation::span_steps`].
    pub grown: u32,
    /// Coupling of damage and opening within a step.
    pub coupling: Coupling,
    /// Fraction of a penetration removed per step, 0 to 1: `solver.correction` of a case.
    pub correction: f64,
    /// Penetration, as a fraction of the smaller body's length, beyond which bodies are moved
    /// apart; 0 for never. See `detection/projection.rs`.
    pub projection: f64,
    /// Whether steps write the energy dissipated by each contact to
    /// [`crate::contact::Network::dissipation`]. Once requested, the record continues until it is
    /// set to `None`.
    pub record_dissipation: bool,
}

impl Options {
    /// Length of a step of the case (s): events belong to the step in whose time, to half a step,
    /// they fall.
    pub fn event_step(&self) -> f64 {
        self.scheme.h / (1.0 + f64::from(self.grown))
    }
}

/// The coupling of damage and opening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
        /// Maximum number of solves in a step; the default is 50.
        #[serde(default = "default_max_iterations")]
        max_iterations: u32,
    },
}

fn default_max_iterations() -> u32 {
    50
}
