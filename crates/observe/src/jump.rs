//! What a run says of its jumps over cycles.

use super::warning::{NOT_REACHED, Warning};
use serde::{Deserialize, Serialize};

/// A jump that was checked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Jump {
    /// Cycles before it, those jumped over included.
    pub after: u32,
    /// Cycles that its one computed cycle stood for.
    pub cycles: u32,
    /// By how much it is off: the worst of volumes and damage, in parts of what it added, and of what is misplaced
    /// after it, in parts of the scar at the end of the run. See [`fretwork_core::wear::jump`].
    pub error: f64,
    /// By how much the work of the cycles after it differs from that of the cycle before it, in parts of it.
    pub work_change: f64,
}

/// A jump over which the work of a cycle changes by more than this has led, or passed, into another state.
const CHANGED: f64 = 0.2;

/// The state at the end of a computed cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Cycles, those jumped over included.
    pub cycles: u32,
    /// Cycles that the last one stood for.
    pub stands_for: u32,
    /// Volume worn off first bodies (m^3; m^3/m in 2D).
    pub wear_volume: f64,
    /// Mean damage of the bonds.
    pub mean_damage: f64,
}

/// The jumps of a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct JumpSummary {
    /// Cycles that were computed to their end, those that stand for many included.
    pub computed_cycles: u32,
    /// Cycles that they stand for.
    pub represented_cycles: u32,
    /// Cycles that were asked for.
    pub asked_cycles: Option<u32>,
    /// Error of a jump that was aimed at.
    pub tolerance: f64,
    /// What all jumps were off by and what is misplaced at the end, in parts of all wear, or of all growth of damage:
    /// the worst; none where what jumps were off by has nothing to be set against.
    pub error_estimate: Option<f64>,
    /// Cycles of a jump that the run ended before it was checked.
    pub unchecked_cycles: u32,
    /// Internal variables of laws, which go on by the cycle that is computed only: they do not jump.
    pub not_jumped: Vec<String>,
    /// Volume worn off first bodies, in all cycles (m^3; m^3/m in 2D).
    pub wear_volume: f64,
    /// Jumps that were checked.
    pub jumps: Vec<Jump>,
    /// Computed cycles.
    pub points: Vec<Point>,
}

impl JumpSummary {
    /// Lines for a terminal.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let longest = self.jumps.iter().map(|j| j.cycles).max().unwrap_or(0);
        vec![(
            "cycle jump",
            format!(
                "{} cycles by {} computed ones, {} jumps of at most {longest}; {}",
                self.represented_cycles,
                self.computed_cycles,
                self.jumps.len(),
                match self.error_estimate {
                    Some(e) => format!("off by some {:.1} %", 100.0 * e),
                    None => "how far off is not known".to_owned(),
                }
            ),
        )]
    }

    /// What the estimate of what jumps were off by does not hold for.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut list = Vec::new();
        if !self.not_jumped.is_empty() {
            let text = format!(
                "{} stay as the computed cycles leave them; compare with a run of smaller jump.at_most",
                self.not_jumped.join(", ")
            );
            list.push(Warning::note("NOT JUMPED", text));
        }
        if self.error_estimate.is_none() && !self.jumps.is_empty() {
            let text = "what jumps were off by has no growth to be set against; compare with a run of smaller jump.at_most";
            list.push(Warning::serious("JUMPS NOT JUDGED", text));
        }
        if self.unchecked_cycles > 0 {
            let text = format!(
                "the run ended in or just after a jump of {} cycles, which is not checked",
                self.unchecked_cycles
            );
            list.push(Warning::serious("NOT CHECKED", text));
        }
        let changed = self.jumps.iter().filter(|j| j.work_change > CHANGED);
        if let Some(worst) = changed
            .clone()
            .max_by(|a, b| a.work_change.total_cmp(&b.work_change))
        {
            let text = format!(
                "over {} jumps the work of a cycle changes by more than {:.0} %, over that after cycle {} by {:.0} %: the estimate does \
                 not hold; make jump.at_most smaller, and see whether the change stays",
                changed.count(),
                100.0 * CHANGED,
                worst.after,
                100.0 * worst.work_change
            );
            list.push(Warning::serious("CYCLES CHANGE", text));
        }
        let far = |j: &&Jump| j.error > 2.0 * self.tolerance;
        if let Some(worst) = self
            .jumps
            .iter()
            .filter(far)
            .max_by(|a, b| a.error.total_cmp(&b.error))
        {
            let count = self.jumps.iter().filter(far).count();
            let text = format!(
                "{count} jumps are off by more than twice jump.tolerance, the one of {} cycles after cycle {} by {:.1} %; \
                 make jump.at_most smaller, or jump.after larger",
                worst.cycles,
                worst.after,
                100.0 * worst.error
            );
            list.push(Warning::serious("JUMPS TOO LONG", text));
        }
        if let Some(asked) = self.asked_cycles.filter(|n| *n > self.represented_cycles) {
            let text = format!(
                "the run ended at cycle {} of {asked}; let it run longer (time.end)",
                self.represented_cycles
            );
            list.push(Warning::serious(NOT_REACHED, text));
        }
        list
    }
}
