//! Coupling of damage and opening within a step.

use serde::{Deserialize, Serialize};

/// The coupling of damage and opening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Coupling {
    /// The step is solved with the damage at its start; damage grows at its end. First order in h.
    Explicit,
    /// The step is solved once, with the mean of the damage at its start and of the damage that the law gives for the
    /// opening predicted from the velocity at its start; damage grows at its end. Second order in h where velocities are
    /// smooth.
    #[default]
    Midpoint,
    /// The step is solved repeatedly until the damage used equals the damage that the resulting openings
    /// give. Damage never decreases between iterations, so that the iteration ends.
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

/// Report of the coupling in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CouplingReport {
    /// Number of solves; zero where the coupling is explicit.
    pub iterations: u32,
    /// Largest change of damage in the last iteration.
    pub change: f64,
    /// Whether the iteration ended without reaching the tolerance.
    pub missed: bool,
}

/// The fixed-point iteration of a step.
#[derive(Debug)]
pub(super) struct Progress {
    tolerance: f64,
    most: u32,
    report: CouplingReport,
}

impl Progress {
    pub fn new(coupling: &Coupling) -> Self {
        let (tolerance, most) = match coupling {
            Coupling::Explicit | Coupling::Midpoint => (0.0, 1),
            Coupling::Implicit {
                tolerance,
                max_iterations,
            } => (*tolerance, *max_iterations),
        };
        Self {
            tolerance,
            most,
            report: CouplingReport {
                change: f64::INFINITY,
                ..CouplingReport::default()
            },
        }
    }

    /// Records the change of damage of an iteration; returns whether to stop.
    pub fn ends(&mut self, change: f64) -> bool {
        self.report.iterations += 1;
        self.report.change = change;
        self.report.missed = change > self.tolerance;
        !self.report.missed || self.report.iterations >= self.most
    }

    pub fn report(&self) -> CouplingReport {
        self.report
    }
}
