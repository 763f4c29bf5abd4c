//! The creepage at which a patch has a force along the rolling.

use crate::Error;
use crate::patch::method::Rung;
use crate::patch::rolling::closed;
use crate::patch::setup::Setup;
use crate::patch::spec::{MotionSpec, PatchFile, value};
use fretwork_observe::quantity::quantity;
use fretwork_rolling::Creepage;
use fretwork_rolling::pull::{self, Pulled};
use fretwork_scene::InputError;

/// Creepage from which the search begins.
const FIRST: f64 = 1e-5;
/// Difference of the force over it at which the creepage is found.
const FOUND: f64 = 1e-5;

/// A force on the first body along the rolling (N), and spin (1/m).
#[derive(Clone, Debug, PartialEq)]
pub(in crate::patch) struct Pull {
    pub force: f64,
    pub spin: f64,
    /// Path of the force in the file.
    path: String,
}

/// Returns the forces of all points.
///
/// # Errors
/// A number is out of range.
pub(in crate::patch) fn forces(file: &PatchFile) -> Result<Vec<Pull>, InputError> {
    let MotionSpec::Pulling { force, spin } = &file.spec.motion else {
        return Ok(Vec::new());
    };
    let source = &file.source;
    let spin = spin.as_ref();
    let spin = spin.map(|s| value(source, "motion.spin", s, "1/m"));
    let spin = spin.transpose()?.unwrap_or(0.0);
    let list = force.0.iter().enumerate();
    let list = list.map(|(k, f)| -> Result<Pull, InputError> {
        let path = force.path("motion.force", k);
        match value(source, &path, f, "N")? {
            0.0 => Err(source.error_at(&path, "forces other than 0 are expected")),
            force => Ok(Pull { force, spin, path }),
        }
    });
    let list: Vec<Pull> = list.collect::<Result<_, _>>()?;
    match list.is_empty() {
        true => Err(source.error_at("motion.force", "there is no force: give one, or a list")),
        false => Ok(list),
    }
}

/// Returns the creepage at which the first body has a force.
///
/// # Errors
/// A law fails, there is no solution, or the patch does not carry the force.
pub(in crate::patch) fn creepage(
    file: &PatchFile,
    setup: &Setup,
    pull: &Pull,
) -> Result<Creepage, Error> {
    let fail = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
    let law = &setup.laws[0];
    // Force opposes creepage.
    let sign = -pull.force.signum();
    let wanted = pull.force.abs();
    let at = |size: f64| Creepage {
        along: sign * size,
        across: 0.0,
        spin: pull.spin,
    };
    let carried = |size: f64| -> Result<f64, Error> {
        if matches!(setup.rung, Rung::Ellipse(_) | Rung::Line(..)) {
            let (force, _) = closed::of_law(setup, &at(size), law)?;
            return Ok(-sign * force[0]);
        }
        let solved = setup.refined(&at(size), law);
        if let Some(error) = law.take_error() {
            return Err(fail(&error));
        }
        let refined = solved.map_err(|e| fail(&e))?;
        Ok(-sign * refined.force[0])
    };
    match pull::creepage(wanted, FIRST, FOUND, carried)? {
        Pulled::At(size) => Ok(at(size)),
        Pulled::Most(most) => {
            let why = format!(
                "the patch does not carry a force of {} along the rolling: with this law it has at most {}; give a smaller `force`",
                quantity(wanted, "N"),
                quantity(most, "N")
            );
            Err(file.source.error_at(&pull.path, why).into())
        }
    }
}
