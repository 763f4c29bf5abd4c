//! The creepage at which a patch has a force along the rolling.

use crate::Error;
use crate::patch::answer::{Motion, Point};
use crate::patch::method::Rung;
use crate::patch::rolling::closed;
use crate::patch::setup::Setup;
use crate::patch::spec::{MotionSpec, PatchFile, value};
use fretwork_observe::quantity::{DETERMINED, number, quantity};
use fretwork_rolling::Creepage;
use fretwork_rolling::pull::{self, LARGEST, Pulled};
use fretwork_scene::InputError;

/// Creepage from which the search begins.
const FIRST: f64 = 1e-5;
/// Digits of forces that differ by less than this share.
const DIGITS: i32 = 6;
const CLOSE: f64 = 1e-3;
/// Difference of the force over it at which the creepage is found.
const FOUND: f64 = 1e-5;
/// Size of a second creepage over that which was found, from which the slope follows.
const NEARBY: f64 = 1.05;

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

/// Returns the creepage of a size that has a force of the sign of the wanted one.
fn creeps(pull: &Pull, size: f64) -> Creepage {
    Creepage {
        // Force opposes creepage.
        along: -pull.force.signum() * size,
        across: 0.0,
        spin: pull.spin,
    }
}

/// Returns the part of the force along the wanted one (N) at a size of the creepage.
///
/// # Errors
/// A law fails, or there is no solution.
fn carried(setup: &Setup, pull: &Pull, size: f64) -> Result<f64, Error> {
    let fail = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
    let law = &setup.laws[0];
    let creepage = creeps(pull, size);
    let force = match setup.rung {
        Rung::Ellipse(_) | Rung::Line(..) => closed::of_law(setup, &creepage, law)?.0,
        Rung::Exact | Rung::Fastsim(_) => {
            let solved = setup.refined(&creepage, law);
            if let Some(error) = law.take_error() {
                return Err(fail(&error));
            }
            solved.map_err(|e| fail(&e))?.force
        }
    };
    Ok(pull.force.signum() * force[0])
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
    let wanted = pull.force.abs();
    match pull::creepage(wanted, FIRST, FOUND, |size| carried(setup, pull, size))? {
        Pulled::At(size) => Ok(creeps(pull, size)),
        Pulled::Most(most) => {
            let shown = |force: f64| match (wanted / most - 1.0).abs() < CLOSE {
                true => format!("{} N", number(force, DIGITS)),
                false => quantity(force, "N"),
            };
            let why = format!(
                "the patch does not carry a force of {} along the rolling: with this law it has at most {}, and no creepage follows from as much or more; give a smaller `force`, or creepages",
                shown(wanted),
                shown(most)
            );
            Err(file.source.error_at(&pull.path, why).into())
        }
    }
}

/// Adds to a point the error of its creepage, and says where the force does not determine it.
///
/// # Errors
/// A law fails, or there is no solution.
pub(in crate::patch) fn determine(
    setup: &Setup,
    pull: &Pull,
    point: &mut Point,
) -> Result<(), Error> {
    let Motion::Rolling(Creepage { along, .. }) = point.motion else {
        return Ok(());
    };
    let (size, force) = (along.abs(), point.force[0].abs());
    let next = (NEARBY * size).min(LARGEST);
    let more = match next > size {
        true => carried(setup, pull, next)? - force,
        false => 0.0,
    };
    let error_of_force = point.adhesion_error * setup.load;
    let error = match more > 0.0 {
        true => error_of_force * (next - size) / more,
        false => f64::INFINITY,
    };
    if more <= FOUND * force {
        point.notes.push(format!(
            "AT THE LIMIT: a force of {} is the largest that this patch carries with this law, and larger creepages have no larger one: the wheel slips away, and no creepage follows from the force; give a smaller `force`, or creepages",
            quantity(force, "N")
        ));
    } else if error > DETERMINED * size {
        point.notes.push(format!(
            "NOT DETERMINED: near full slip the force hardly depends on the creepage, and its error of {} leaves the creepage open by {} %: take more `cells`, or give creepages",
            quantity(error_of_force, "N"),
            number(100.0 * error / size, 2)
        ));
    }
    point.creepage_error = Some(match more <= FOUND * force {
        true => f64::INFINITY,
        false => error,
    });
    Ok(())
}
