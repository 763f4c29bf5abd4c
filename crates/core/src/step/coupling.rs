//! How damage and opening are brought together within a step.

use serde::{Deserialize, Serialize};

/// The coupling of damage and opening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Coupling {
    /// The step is done with the damage at its start; damage grows at its end. First order in h.
    #[default]
    Explicit,
    /// The step is solved again until its damage is the one that its openings give, or more: within a step
    /// too damage only grows, so that the solves end.
    Implicit {
        /// Largest change of a damage between two solves that ends it.
        tolerance: f64,
        /// Solves at most in a step.
        max_iterations: u32,
    },
}

/// How the coupling went in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CouplingReport {
    /// Solves; zero where the coupling is explicit.
    pub iterations: u32,
    /// Largest change of a damage in the last.
    pub change: f64,
    /// Whether the tolerance was missed.
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
            Coupling::Explicit => (0.0, 1),
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

    /// Takes in the change of a solve; says whether it was the last.
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
