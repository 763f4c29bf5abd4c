//! Solver statistics of a run.

use super::choice::SolverStats;
use serde::{Deserialize, Serialize};

/// Solver statistics over the steps of a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SolverSummary {
    /// Mean number of iterations per step.
    pub iterations_mean: f64,
    /// Largest number of iterations in a step.
    pub iterations_max: u32,
    /// Largest error at the end of a step.
    pub error_max: f64,
    /// Steps that did not reach the tolerance.
    pub unconverged_steps: u64,
    /// Steps in which damage and opening did not reach the coupling's tolerance.
    pub uncoupled_steps: u64,
    /// Mean number of solves per step with implicit coupling; 0 for explicit coupling.
    pub coupling_iterations_mean: f64,
    /// First unconverged step; 0 if there is none.
    pub first_unconverged: u64,
    /// Steps in which penetrations were removed by projection.
    pub projected_steps: u64,
    /// Largest penetration before a projection, as a fraction of the smaller body's length.
    pub overlap_before: f64,
    /// Largest penetration after a projection, as a fraction of the smaller body's length.
    pub overlap_after: f64,
    /// Tolerance.
    pub tolerance: f64,
    /// Formula of the error.
    pub error_formula: String,
    /// Requested solver.
    pub method: String,
    /// Number of steps by the solver that converged.
    pub steps_by_method: std::collections::BTreeMap<String, u64>,
    /// Reason for the choice, as a sentence.
    pub why: String,
    /// Statistics of the solvers that `auto` chose.
    pub choice: SolverStats,
    /// Steps written as FCLIB problems.
    pub fclib_written: u64,
    /// Steps that could not be written as FCLIB problems, since the format cannot represent them.
    pub fclib_skipped: u64,
}
