//! Phases of what holds a deformable body: their drives become stages of its own drive. Where the times of the phases are known before
//! the run, so are those of the stages.

use super::case::Case;
use super::phases::{PhaseSpec, Redriven, in_order};
use super::source::ValidationError;
use fretwork_core::bodies::{Dof, Stage};
use fretwork_core::step::control::Until;

/// The names of the holders in `drives`: a half-space by its name, a part of a body of finite elements as `body.part`.
pub(crate) fn names(case: &Case) -> impl Iterator<Item = String> + Clone + '_ {
    let half_spaces = case.half_spaces.iter().map(|b| b.name.clone());
    let parts = case.elastic.iter().flat_map(|body| {
        let supports = body.supports.iter();
        supports.map(|s| name(&body.name, &s.part))
    });
    half_spaces.chain(parts)
}

/// The name in `drives` of a part of a body of finite elements.
pub fn name(body: &str, part: &str) -> String {
    format!("{body}.{part}")
}

/// Whether a holder has a drive along an axis; `None` if there is no holder of this name.
fn is_held(case: &Case, holder: &str, axis: usize) -> Option<bool> {
    if case.half_spaces.iter().any(|b| b.name == holder) {
        return Some(true);
    }
    let supports = case.elastic.iter().flat_map(|body| {
        let supports = body.supports.iter();
        supports.map(|s| (name(&body.name, &s.part), [&s.x, &s.y, &s.z]))
    });
    let mut found = supports.filter(|s| s.0 == holder).peekable();
    found.peek()?;
    Some(found.any(|s| s.1[axis].is_some()))
}

/// When each phase of a run begins, in its order; none from the first on that ends at a time that is not known before the run.
fn begins(case: &Case) -> Vec<(&PhaseSpec, f64)> {
    let h = case.time.step;
    let mut out = Vec::new();
    let mut begin = 0.0;
    for phase in in_order(case) {
        out.push((phase, begin));
        let end = match phase.until {
            Some(Until::Time(t)) => t,
            Some(Until::After(t)) => begin + t,
            Some(Until::Steps(n)) if case.accuracy.is_none() => begin + n as f64 * h,
            _ => break,
        };
        // A phase ends with a step.
        begin = match case.accuracy {
            None => (end / h).round().max((begin / h).round() + 1.0) * h,
            Some(_) => end,
        };
    }
    out
}

/// Checks the drives of a phase for a holder.
///
/// # Errors
/// What a holder cannot do, with its path in the phase.
pub(super) fn check(
    case: &Case,
    phase: &PhaseSpec,
    holder: &str,
    redriven: &Redriven,
) -> Result<(), ValidationError> {
    let path = format!("drives.{holder}");
    let fail =
        |dof: &str, message: String| Err(ValidationError::new(format!("{path}.{dof}"), message));
    for (dof, _, drive) in redriven.given(case.dimension as usize) {
        let Some(axis) = ["x", "y", "z"].iter().position(|a| *a == dof) else {
            return fail(dof, "what holds a deformable body does not turn".into());
        };
        if drive.drives().any(|d| matches!(d, Dof::Pressure { .. })) {
            return fail(
                dof,
                "a servo of pressure needs rigid walls; give a force".into(),
            );
        }
        if is_held(case, holder, axis) == Some(false) {
            let message = format!(
                "`{holder}` is not held along {dof}, and what is held cannot change within a run; give the support a drive along {dof}, `Free` for none"
            );
            return fail(dof, message);
        }
    }
    if !begins(case).iter().any(|(p, _)| p.name == phase.name) {
        let message = format!(
            "when `{}` begins is not known before the run, as a drive of what holds a deformable body needs; end the phases before it at a `Time` or `After` one",
            phase.name
        );
        return Err(ValidationError::new(path, message));
    }
    Ok(())
}

/// The drive of a holder along an axis over the run: its own, then those of the phases.
pub(crate) fn drive(case: &Case, holder: &str, axis: usize, own: &Dof) -> Dof {
    let mut stages: Vec<Stage> = stages_of(own);
    for (phase, begin) in begins(case) {
        let given = phase.drives.get(holder);
        let Some(next) = given.and_then(|r| [&r.x, &r.y, &r.z][axis].as_ref()) else {
            continue;
        };
        // Stages that would begin later give way.
        let over = stages
            .iter()
            .take_while(|s| s.until.is_some_and(|end| end < begin));
        let kept = over.count() + usize::from(begin > 0.0);
        stages.truncate(kept);
        if let Some(last) = stages.last_mut() {
            last.until = Some(begin);
        }
        stages.extend(stages_of(&next.delayed(begin)));
    }
    match (stages.len(), own) {
        (_, Dof::Stages(_)) | (2.., _) => Dof::Stages(stages),
        _ => stages.pop().map_or(Dof::Fixed, |s| s.drive),
    }
}

/// A drive as stages.
fn stages_of(drive: &Dof) -> Vec<Stage> {
    match drive {
        Dof::Stages(stages) => stages.clone(),
        simple => vec![Stage {
            until: None,
            drive: simple.clone(),
        }],
    }
}
