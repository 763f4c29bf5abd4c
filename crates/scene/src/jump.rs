//! Validation of a case's jumps over cycles.

use super::case::{BodySpec, Case};
use super::holders;
use super::processes::held;
use super::source::ValidationError;
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_core::laws::Kind;
pub use fretwork_core::process::jump::JumpSpec;

/// Limit on the cycles of a jump, and of its control.
const MAX_CYCLES: u32 = 100_000;

/// Checks the jumps of a case.
///
/// # Errors
/// Returns the first error, with its path.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    let Some(jump) = &case.jump else {
        return Ok(());
    };
    let fault = |path: &str, message: &str| Err(ValidationError::new(path, message));
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
        return Err(ValidationError::new("jump", message));
    }
    repeats(case, jump)?;
    let wears = case.bodies.iter().any(|b| b.wears.is_some())
        || case.elastic.iter().any(|b| b.wears.is_some())
        || case.half_spaces.iter().any(|b| b.wears.is_some());
    let damages = case
        .interfaces
        .iter()
        .any(|i| i.law(Kind::DAMAGE).is_some());
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
        if count > MAX_CYCLES {
            let message = format!("{count} is too many; at most {MAX_CYCLES}");
            return Err(ValidationError::new(format!("jump.{name}"), message));
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
            return Err(ValidationError::new(format!("jump.{name}"), message));
        }
    }
    let steps = period(case).unwrap_or(0.0) / case.time.step;
    if (steps - steps.round()).abs() > 1e-3 || steps < 1.5 {
        let message = format!(
            "a cycle takes {steps} steps, so a jump would not begin and end with a step; choose a time.step that divides the cycle"
        );
        return Err(ValidationError::new("jump", message));
    }
    Ok(())
}

/// Rejects drives, phases and gravity that do not repeat with every cycle: a jump skips cycles
/// without advancing the simulated time.
fn repeats(case: &Case, jump: &JumpSpec) -> Result<(), ValidationError> {
    let (Some(test), Some(cycle)) = (&case.friction, period(case)) else {
        return Ok(());
    };
    if !case.phases.is_empty() {
        let message = "phases follow the simulated time, and a jump skips cycles; make a separate case of the phase that \
                       jumps (grains of the last state by `State`), or leave `jump` out";
        return Err(ValidationError::new("phases", message));
    }
    if case.gravity_drive.is_some() {
        let message = "gravity that changes does not repeat with every cycle; leave `gravity_drive` or `jump` out";
        return Err(ValidationError::new("gravity_drive", message));
    }
    let begins = test.start + f64::from(jump.after) * cycle;
    let check = |path: String, dof: &Dof, translates: bool| {
        let Some(why) = reason_not_periodic(dof, translates, cycle, begins) else {
            return Ok(());
        };
        let message = format!(
            "a jump skips whole cycles of {cycle:e} s from {begins:e} s on, so all drives must repeat with each cycle, \
             but {why}; keep it constant from then on, give it a period that divides the cycle, or leave `jump` out"
        );
        Err(ValidationError::new(path, message))
    };
    let dimension = case.dimension as usize;
    for body in &case.bodies {
        let names = BodySpec::names(dimension);
        for (k, dof) in body.ordered(dimension).iter().enumerate() {
            let path = format!("bodies.{}.dofs.{}", body.name, names[k]);
            check(path, dof, k < dimension)?;
        }
    }
    for (path, _, axes) in holders::own(case) {
        for (axis, dof) in ["x", "y", "z"].iter().zip(axes) {
            if let Some(dof) = dof {
                check(format!("{path}.{axis}"), dof, true)?;
            }
        }
    }
    for (k, body) in case.half_spaces.iter().enumerate() {
        if let Some(rolling) = &body.rolling {
            // Rolling at constant speed is the same in each cycle.
            let path = format!("half_spaces.{k}.rolling");
            check(path, &Dof::Velocity(rolling.clone()), false)?;
        }
    }
    Ok(())
}

/// Returns why a drive does not repeat with every cycle after a time; `None` if it does.
fn reason_not_periodic(dof: &Dof, translates: bool, cycle: f64, begins: f64) -> Option<String> {
    if let Dof::Stages(_) = dof {
        return Some("its drives follow one another in time".into());
    }
    match dof.function()? {
        TimeFunction::Constant(v) => (translates && *v != 0.0 && matches!(dof, Dof::Velocity(_)))
            .then(|| "it continues in one direction".into()),
        TimeFunction::Ramp { end, .. } if *end > begins => {
            Some(format!("its ramp lasts until {end:e} s"))
        }
        TimeFunction::Table(points) if points.last().is_some_and(|p| p.0 > begins) => {
            Some("its table goes on after it".into())
        }
        TimeFunction::Sine {
            frequency, start, ..
        } => {
            let turns = frequency * cycle;
            let whole = (turns - turns.round()).abs() < 1e-6 * turns.max(1.0);
            if *start > begins {
                Some(format!("its sine begins at {start:e} s"))
            } else {
                (!whole).then(|| format!("its sine turns {turns} times in a cycle"))
            }
        }
        TimeFunction::Ramp { .. } | TimeFunction::Table(_) => None,
    }
}

/// Returns the length of a cycle of the friction test (s).
fn period(case: &Case) -> Option<f64> {
    let test = case.friction.as_ref()?;
    let rigid = case.bodies.iter().find(|b| b.name == test.body);
    let dofs = rigid.map(|body| body.ordered(case.dimension as usize));
    let function = match &dofs {
        Some(dofs) => dofs.get(test.along).and_then(Dof::function),
        None => held(case, &test.body, test.along).and_then(|(_, dof)| dof.function()),
    };
    test.period.or(function.and_then(TimeFunction::period))
}
