//! Strokes of fretting: the loop of force and displacement, and what slips and wears in it.

pub mod cycles;
mod cycles_shown;
pub mod map;
mod map_shown;
pub mod measured_loops;
pub mod spec;
#[cfg(test)]
mod tests;

use crate::Error;
use crate::patch::answer::{Band, Cycle, Motion, Point, Wear};
use crate::patch::fretting::spec::{FrettingSpec, StrokeDrive, drives};
use crate::patch::law::{PatchLaw, outside};
use crate::patch::rolling::{bodies_that_wear, coarse};
use crate::patch::said::Said;
use crate::patch::setup::Setup;
use crate::patch::spec::{MotionSpec, PatchFile};
use fretwork_core::laws::Kind;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::cells::half_width;
use fretwork_rolling::{Amplitude, Estimate, RefinedStroke, Strokes};
use fretwork_scene::InputError;

/// What a file gives for laws that depend on the velocity of slip.
const FREQUENCY: &str = "the `frequency` of the stroke, such as `frequency: 20 Hz`";
/// Force over the load below which it is of the size of the residual of the tractions.
const LEAST: f64 = 1e-5;
/// Energy of the drive over that of slip, less 1, that is no longer small.
const WORK: f64 = 0.1;

/// Returns what the file says of fretting, and its strokes.
///
/// # Errors
/// A number is out of range.
pub fn strokes(file: &PatchFile) -> Result<(Option<&FrettingSpec>, Vec<StrokeDrive>), InputError> {
    match &file.spec.motion {
        MotionSpec::Fretting(spec) => Ok((Some(spec), drives(file, spec)?)),
        _ => Ok((None, Vec::new())),
    }
}

/// A solved stroke.
#[derive(Debug)]
pub struct Stroke {
    /// The numbers.
    pub point: Point,
    /// The loop, and what it is on the fine grid.
    pub found: RefinedStroke,
}

impl Stroke {
    /// Returns displacements (m) and driving forces (N) of the first loading and the cycle.
    pub fn curve(&self) -> Vec<[f64; 2]> {
        let cycle = &self.found.fine.cycle;
        let first = &cycle.loading[..cycle.loading.len().saturating_sub(1)];
        [first, &cycle.points[..]].concat()
    }

    /// Returns the path slipped by each cell in the cycle (m).
    pub fn slip_path(&self) -> Vec<f64> {
        let fine = &self.found.fine;
        let cells = fine.cycle.rubbed.iter().zip(&fine.pressure.pressure);
        cells
            .map(|(r, p)| if *p > 0.0 { r / p } else { 0.0 })
            .collect()
    }
}

/// Solves a stroke: loading, then a full cycle.
///
/// # Errors
/// A law fails, friction does not hold the force, or there is no solution.
pub fn solve(file: &PatchFile, setup: &Setup, drive: &StrokeDrive) -> Result<Stroke, Error> {
    let with = match drive.amplitude {
        Amplitude::Displacement(_) => {
            "`frequency`, or `speed`, the mean speed of the stroke, such as `frequency: 20 Hz`"
        }
        Amplitude::Force(_) => FREQUENCY,
    };
    setup.check_time(file, drive.step, with)?;
    // The law of the file is solved last, so that what stays with its cells is that of the cycle.
    let others = setup.laws[1..].iter();
    let members = others.map(|law| -> Result<f64, Error> {
        Ok(adhesion(setup, &of_law(file, setup, law, drive)?).value)
    });
    let members: Vec<f64> = members.collect::<Result<_, Error>>()?;
    let law = &setup.laws[0];
    let found = of_law(file, setup, law, drive)?;
    if adhesion(setup, &found).value < LEAST {
        let why = format!(
            "a stroke with a force of {} is too small for the precision of tractions under a load of {}: give a larger one",
            quantity(found.amplitude[1].value, "N"),
            quantity(setup.load, "N")
        );
        return Err(file.source.error_at(&drive.path, why).into());
    }
    let point = point(setup, law, drive, &found, &members);
    Ok(Stroke { point, found })
}

fn adhesion(setup: &Setup, found: &RefinedStroke) -> Estimate {
    let force = found.amplitude[1];
    Estimate {
        value: force.value / setup.load,
        error: force.error / setup.load,
    }
}

/// Turns an error of a layer below into one of the command.
pub(in crate::patch) fn fail(error: &dyn std::fmt::Display) -> Error {
    Error::Failed(error.to_string())
}

fn of_law(
    file: &PatchFile,
    setup: &Setup,
    law: &PatchLaw,
    drive: &StrokeDrive,
) -> Result<RefinedStroke, Error> {
    let strokes = Strokes {
        law,
        along: [1.0, 0.0],
        amplitude: drive.amplitude,
        quarter: drive.steps,
        step: drive.step.unwrap_or(1.0),
    };
    let solved = setup.with_patch(|patch| patch.frets_refined(setup.grid, &strokes));
    match law.take_error() {
        Some(error) => Err(fail(&error)),
        None => solved.map_err(|e| file.source.error_at(&drive.path, e.said()).into()),
    }
}

fn point(
    setup: &Setup,
    law: &PatchLaw,
    drive: &StrokeDrive,
    found: &RefinedStroke,
    members: &[f64],
) -> Point {
    let cycle = &found.fine.cycle;
    let adhesion = adhesion(setup, found);
    let mut notes = Vec::new();
    if !cycle.unique {
        notes.push("NOT UNIQUE: friction falls so fast with slip that the contact may jump to lower friction within a stroke".to_owned());
    }
    let half = half_width(&found.fine.grid, &found.fine.pressure.pressure, [1.0, 0.0]);
    if found.amplitude[0].value > half {
        notes.push(format!(
            "NOT IN RANGE: the stroke moves the bodies by {} to each side, more than half of the width of the patch, {}: fields are those of a patch that stays in place",
            quantity(found.amplitude[0].value, "m"),
            quantity(half, "m")
        ));
    }
    notes.extend(setup.notes(found.fine.pressure.largest()));
    let force = found.amplitude[1];
    let slips = found.energy.value > 1e-3 * cycle.amplitude[0] * cycle.amplitude[1];
    let energy = if slips {
        found.energy
    } else {
        Estimate::default()
    };
    notes.extend(coarse(&[
        ("the force", force.error, force.value),
        ("the energy", energy.error, energy.value),
    ]));
    if slips && (cycle.work() / cycle.energy - 1.0).abs() > WORK {
        notes.push(format!(
            "the work of the drive is {} % of the energy of slip: take more `steps`",
            number(100.0 * cycle.work() / cycle.energy, 3)
        ));
    }
    notes.extend(
        law.left()
            .iter()
            .map(|(table, share)| outside(table, *share)),
    );
    let wears = law.interface().law(Kind::WEAR);
    let wear = wears.map(|wear| {
        let bodies = bodies_that_wear(setup).into_iter();
        let of = bodies.map(|(body, factor)| Wear {
            body,
            law: wear.plugin.name.clone(),
            volume: factor * found.worn.value,
            volume_error: factor * found.worn.error,
            depth: factor * found.deepest.value,
            depth_error: factor * found.deepest.error,
            profile: Vec::new(),
            half_width: None,
        });
        of.collect::<Vec<_>>()
    });
    Point {
        motion: Motion::Fretting(found.amplitude[0].value),
        stroke: Some(Cycle {
            by_force: matches!(drive.amplitude, Amplitude::Force(_)),
            displacement: found.amplitude[0],
            force,
            energy: found.energy,
            stuck: found.stuck,
            energy_ratio: cycle.energy_ratio(),
            slip_ratio: cycle.slip_ratio(),
            worn: found.worn,
        }),
        force: [-cycle.amplitude[1], 0.0],
        adhesion: adhesion.value,
        adhesion_error: adhesion.error,
        adhesion_band: Band::of(adhesion.value, members),
        moment: Some(0.0),
        t_gamma: cycle.work(),
        dissipation: cycle.energy,
        resistance: 0.0,
        stuck: Some(cycle.stuck),
        slip_speed: drive.step.map(|s| cycle.fastest / s),
        slip_speed_error: None,
        temperature: None,
        temperature_error: None,
        creepage_error: None,
        wear: wear.unwrap_or_default(),
        iterations: cycle.iterations,
        unique: cycle.unique,
        notes,
    }
}
