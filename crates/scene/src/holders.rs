//! Holders of deformable bodies: their names, their own drives, and the drives set by phases.

use super::case::Case;
use super::phases::Redriven;
use super::source::ValidationError;
use fretwork_core::bodies::{Dof, HeldAxis};
use fretwork_core::view::RunView;
use fretwork_elastic::half_space::HOLDER;

/// Returns the names of the holders in `drives`: a half-space by its name, a part of a body of
/// finite elements as `body.part`.
pub(crate) fn names(case: &Case) -> impl Iterator<Item = String> {
    own(case).map(|(_, name, _)| name)
}

/// The name in `drives` of a part of a body of finite elements.
pub fn name(body: &str, part: &str) -> String {
    format!("{body}.{part}")
}

/// Checks the drives of a phase for a holder.
///
/// # Errors
/// Returns the first drive that holders do not support, with its path in the phase.
pub(super) fn check(case: &Case, holder: &str, redriven: &Redriven) -> Result<(), ValidationError> {
    let path = format!("drives.{holder}");
    let fail =
        |dof: &str, message: String| Err(ValidationError::new(format!("{path}.{dof}"), message));
    for (dof, _, drive) in redriven.given(case.dimension as usize) {
        let Some(axis) = ["x", "y", "z"].iter().position(|a| *a == dof) else {
            return fail(dof, "the holder of a deformable body does not turn".into());
        };
        let of = own(case).filter(|(_, name, _)| name == holder);
        let of = of.filter_map(|(_, _, axes)| axes[axis].clone());
        let half_space = case.half_spaces.iter().any(|b| b.name == holder);
        let Some(own) = of.last().or_else(|| half_space.then_some(Dof::Fixed)) else {
            let message = format!(
                "`{holder}` is not held along {dof}, and held axes cannot change within a run; give the support a drive along {dof}, `Free` for none"
            );
            return fail(dof, message);
        };
        if (own.imposes() && drive.yields()) || (own.yields() && drive.imposes()) {
            let message = format!(
                "with its own drive, the holder of `{holder}` along {dof} imposes motion at one time and a force at another, which cannot change within a run; give both a force (`Force`, `Pressure`, `Free`), or both a motion"
            );
            return fail(dof, message);
        }
    }
    Ok(())
}

/// Returns the drives that phases give a holder, in the order of the phases: index of the phase,
/// axis, drive.
pub(crate) fn later(case: &Case, holder: &str) -> Vec<(usize, usize, Dof)> {
    let given = case.phases.iter().enumerate().filter_map(|(k, phase)| {
        let redriven = phase.drives.get(holder)?;
        Some((k, [&redriven.x, &redriven.y, &redriven.z]))
    });
    given
        .flat_map(|(k, axes)| {
            let axes = axes.into_iter().enumerate();
            axes.filter_map(move |(axis, drive)| Some((k, axis, drive.clone()?)))
        })
        .collect()
}

/// Returns the holder of a deformable body with a name in `drives`; `None` if there is no such
/// holder.
pub(crate) fn find(case: &Case, s: &dyn RunView, holder: &str, axis: usize) -> Option<HeldAxis> {
    let half_spaces = case.half_spaces.iter();
    let mut half_spaces = half_spaces.map(|b| (&b.name, b.name.clone(), HOLDER));
    let parts = case.elastic.iter().flat_map(|body| {
        let supports = body.supports.iter();
        supports.map(|s| (&body.name, name(&body.name, &s.part), s.part.as_str()))
    });
    let (body, _, part) = half_spaces
        .by_ref()
        .chain(parts)
        .find(|(_, name, _)| name == holder)?;
    Some(HeldAxis {
        system: s.system_named(body)?,
        part: part.to_owned(),
        axis,
    })
}

/// Returns all holders with their own drives along each axis: path, name in `drives`, drives.
pub(crate) fn own(case: &Case) -> impl Iterator<Item = (String, String, [&Option<Dof>; 3])> {
    let half_spaces = case.half_spaces.iter().enumerate().map(|(k, b)| {
        let axes = [&b.dofs.x, &b.dofs.y, &b.dofs.z];
        (format!("half_spaces.{k}.dofs"), b.name.clone(), axes)
    });
    let parts = case.elastic.iter().enumerate().flat_map(|(k, body)| {
        let supports = body.supports.iter().enumerate();
        supports.map(move |(j, s)| {
            let path = format!("elastic.{k}.supports.{j}");
            (path, name(&body.name, &s.part), [&s.x, &s.y, &s.z])
        })
    });
    half_spaces.chain(parts)
}
