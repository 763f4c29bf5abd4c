//! Course of a run, read back from its `summary.json`.

use crate::quantity::find;
use serde_json::Value;

/// Key of the residual of the energy ledger over the largest energy.
pub const RELATIVE_RESIDUAL: &str = "energy_residual_relative";

/// Course of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// Number of completed steps; `None` where there is no summary.
    pub steps: Option<f64>,
    /// Number of steps that missed the tolerance of the solver.
    pub unconverged: f64,
    /// Number of steps that missed the tolerance of the damage coupling.
    pub uncoupled: f64,
    /// Energy that no entry of the ledger explains, over the largest energy; `None` where it is not
    /// finite.
    pub residual: Option<f64>,
    /// Processor time (s).
    pub cpu_seconds: Option<f64>,
    /// Reasons why the run is not trustworthy.
    pub reasons: Vec<String>,
}

impl Course {
    /// Reads the course of the run of a summary.
    pub fn of(summary: &Value) -> Self {
        let number = |path: &str| find(summary, path).and_then(Value::as_f64);
        let reasons = summary["reasons"].as_array().into_iter().flatten();
        let reasons = reasons.filter_map(Value::as_str);
        Self {
            steps: number("steps"),
            unconverged: number("solver.unconverged_steps").unwrap_or(0.0),
            uncoupled: number("solver.uncoupled_steps").unwrap_or(0.0),
            residual: number(RELATIVE_RESIDUAL),
            cpu_seconds: number("cpu_seconds"),
            reasons: reasons.map(str::to_owned).collect(),
        }
    }
}

/// Returns whether a quantity is a residual, which is zero without errors; and whether it is a pure
/// number.
pub fn residual(path: &str) -> Option<bool> {
    match path {
        RELATIVE_RESIDUAL => Some(true),
        "energy.residual" => Some(false),
        _ => None,
    }
}
