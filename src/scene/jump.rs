//! The words of a case about jumps over cycles.

use super::case::Case;
use super::source::Fault;
use crate::bodies::TimeFunction;
use serde::{Deserialize, Serialize};

/// Jumps over the cycles of a friction test: some computed cycles stand for many, see [`crate::wear::jump`].
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct JumpSpec {
    /// Cycles that are computed one by one before the first jump.
    pub after: u32,
    /// Cycles that one computed cycle stands for, at most.
    pub at_most: u32,
    /// Error of a jump that the length of the next one aims at: of what it adds, in parts of it, and of what it
    /// misplaces, in parts of the scar after `cycles`; of the scar at hand without `cycles`.
    pub tolerance: f64,
    /// Cycles computed one by one after each jump, against which it is checked.
    pub control: u32,
    /// How much the damage of a bond may grow in a jump.
    pub growth: f64,
    /// Cycles after which the run ends, those jumped over included; by default it ends at `time.end`.
    pub cycles: Option<u32>,
}

impl Default for JumpSpec {
    fn default() -> Self {
        Self {
            after: 3,
            at_most: 50,
            tolerance: 0.02,
            control: 1,
            growth: 0.1,
            cycles: None,
        }
    }
}

/// Refuses jumps that mean nothing.
///
/// # Errors
/// The first fault, with its path.
pub(super) fn check(case: &Case) -> Result<(), Fault> {
    let Some(jump) = &case.jump else {
        return Ok(());
    };
    let fault = |path: &str, message: &str| Err(Fault::new(path, message));
    let Some(test) = &case.friction else {
        let message = "a jump goes over cycles, and without `friction` there are none; name the body that rubs in \
                       `friction`, or leave `jump` out";
        return fault("jump", message);
    };
    if period(case).is_none() {
        let message = format!(
            "a jump needs cycles, and the motion of `{}` along its axis has no period; drive it by a Sine, or give \
             friction.period",
            test.body
        );
        return Err(Fault::new("jump", message));
    }
    let wears = case.bodies.iter().any(|b| b.wears.is_some());
    let damages = case.interfaces.iter().any(|i| i.damage.is_some());
    if !wears && !damages {
        let message = "nothing here changes from cycle to cycle that a jump could carry on: no body `wears` and no \
                       interface has a damage law; give one of them, or leave `jump` out";
        return fault("jump", message);
    }
    if case.circuit.is_some() {
        let message = "a circuit counts grains as they come loose, one by one, and a jump would pass over them; leave \
                       one of the two out";
        return fault("jump", message);
    }
    for (name, count) in [("at_most", jump.at_most), ("control", jump.control)] {
        if count == 0 {
            return fault(&format!("jump.{name}"), "must be at least 1");
        }
    }
    if jump.after == 0 {
        let message = "must be at least 1: a jump is checked against the cycle before it";
        return fault("jump.after", message);
    }
    if jump.cycles == Some(0) {
        return fault("jump.cycles", "must be at least 1");
    }
    for (name, value) in [("tolerance", jump.tolerance), ("growth", jump.growth)] {
        if !(value.is_finite() && value > 0.0) {
            let message = format!("must be positive, got {value}");
            return Err(Fault::new(format!("jump.{name}"), message));
        }
    }
    let steps = period(case).unwrap_or(0.0) / case.time.step;
    if (steps - steps.round()).abs() > 1e-3 || steps < 1.5 {
        let message = format!(
            "a cycle takes {steps} steps, and a jump would not begin and end with one; let time.step divide the cycle"
        );
        return Err(Fault::new("jump", message));
    }
    Ok(())
}

/// Length of a cycle of the friction test (s).
fn period(case: &Case) -> Option<f64> {
    let test = case.friction.as_ref()?;
    let body = case.bodies.iter().find(|b| b.name == test.body)?;
    let dofs = body.ordered(case.dimension as usize);
    let function = dofs.get(test.along).and_then(|d| d.function());
    test.period.or(function.and_then(TimeFunction::period))
}
