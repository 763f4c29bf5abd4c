//! Summary of the cycle jumps of a run: each checked jump, and the states between them.

use serde::{Deserialize, Serialize};

/// A checked jump.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Jump {
    /// Number of cycles before the jump, including skipped ones.
    pub after: u32,
    /// Number of cycles that the computed cycle represents.
    pub cycles: u32,
    /// Error of the jump: the maximum over volumes and damage, relative to their increment, and
    /// over misplaced volume, relative to the scar at the end of the run. See
    /// [`crate::wear::jump`].
    pub error: f64,
    /// Relative difference between the work of the cycles after the jump and that of the cycle
    /// before it.
    pub work_change: f64,
}

/// State at the end of a computed cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpPoint {
    /// Number of cycles, including skipped ones.
    pub cycles: u32,
    /// Number of cycles that the last computed cycle represents.
    pub cycle_multiplier: u32,
    /// Volume worn off first bodies (m^3; m^3/m in 2D).
    pub wear_volume: f64,
    /// Mean damage of the bonds.
    pub mean_damage: f64,
}

/// Summary of the jumps of a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct JumpSummary {
    /// Number of completed computed cycles, including those that represent many.
    pub computed_cycles: u32,
    /// Number of cycles represented by the computed ones.
    pub represented_cycles: u32,
    /// Requested number of cycles.
    pub asked_cycles: Option<u32>,
    /// Target error of a jump.
    pub tolerance: f64,
    /// Estimated total error of all jumps plus the misplaced volume at the end, relative to the
    /// total wear or growth of damage, whichever is worse; `None` where there is no reference
    /// value.
    pub error_estimate: Option<f64>,
    /// Number of cycles of a jump that was not checked before the run ended.
    pub unchecked_cycles: u32,
    /// Internal variables of laws that advance with the computed cycles only.
    pub not_jumped: Vec<String>,
    /// Total volume worn off first bodies over all cycles (m^3; m^3/m in 2D).
    pub wear_volume: f64,
    /// Checked jumps.
    pub jumps: Vec<Jump>,
    /// States after the computed cycles.
    pub points: Vec<JumpPoint>,
}
