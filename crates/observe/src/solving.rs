//! What a run says of its solver.

use super::choice::Choice;
use serde::{Deserialize, Serialize};

/// What the solver did.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SolverSummary {
    /// Mean sweeps a step.
    pub iterations_mean: f64,
    /// Most sweeps in a step.
    pub iterations_max: u32,
    /// Largest error at the end of a step.
    pub error_max: f64,
    /// Steps that did not reach the tolerance.
    pub unconverged_steps: u64,
    /// Steps whose damage and opening did not agree to the coupling's tolerance.
    pub uncoupled_steps: u64,
    /// Solves a step, on average, of an implicit coupling; 0 for an explicit one.
    pub coupling_iterations_mean: f64,
    /// The first of them, 0 if none.
    pub first_unconverged: u64,
    /// Steps that took overlaps out by moving bodies.
    pub projected_steps: u64,
    /// Deepest overlap that such a step found, in parts of the smaller body's length.
    pub overlap_before: f64,
    /// Deepest overlap that such a step left.
    pub overlap_after: f64,
    /// Tolerance.
    pub tolerance: f64,
    /// How the error is formed.
    pub error_formula: String,
    /// The method asked for.
    pub method: String,
    /// Steps by the method that ended them.
    pub steps_by_method: std::collections::BTreeMap<String, u64>,
    /// What was chosen and why, in a sentence.
    pub why: String,
    /// What `auto` chose.
    pub choice: Choice,
    /// Steps written as FCLIB problems.
    pub fclib_written: u64,
    /// Steps that were to be written and hold what that form does not.
    pub fclib_skipped: u64,
}
