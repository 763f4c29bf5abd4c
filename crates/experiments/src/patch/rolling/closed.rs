//! Points of rolling in closed form: forces without fields.

use crate::Error;
use crate::patch::answer::{Band, Motion, Point};
use crate::patch::law::PatchLaw;
use crate::patch::method::Rung;
use crate::patch::setup::Setup;
use fretwork_rolling::closed::held;
use fretwork_rolling::fields::length;
use fretwork_rolling::{Creepage, Vector};

/// Error of the force over the force that is no longer small.
const COARSE: f64 = 0.3;

/// Solves a point, with the laws of all members for its band.
///
/// # Errors
/// A law fails.
pub fn point(setup: &Setup, creepage: &Creepage) -> Result<Point, Error> {
    let (force, error) = of_law(setup, creepage, &setup.laws[0])?;
    let others = setup.laws[1..].iter();
    let members = others.map(|law| -> Result<f64, Error> {
        let (force, _) = of_law(setup, creepage, law)?;
        Ok(length(force) / setup.load)
    });
    let members: Vec<f64> = members.collect::<Result<_, Error>>()?;
    let adhesion = length(force) / setup.load;
    let t_gamma = -(force[0] * creepage.along + force[1] * creepage.across);
    let largest = setup.rung.pressed(&setup.grid).map_or(0.0, |p| p[0]);
    let mut notes = setup.notes(largest);
    if error > COARSE * length(force) {
        notes.push(format!(
            "NOT IN RANGE: the closed form is for small spin, and with this one it may be off by {:.0} % of the force: take `Fastsim` or `Exact`",
            100.0 * error / length(force)
        ));
    }
    if creepage.spin != 0.0 {
        notes.push(
            "T gamma is without the work of spin, since the closed form has no moment: take `Fastsim` or `Exact` for it"
                .to_owned(),
        );
    }
    Ok(Point {
        motion: Motion::Rolling(*creepage),
        stroke: None,
        force,
        adhesion,
        adhesion_error: error / setup.load,
        adhesion_band: Band::of(adhesion, &members),
        moment: None,
        t_gamma,
        dissipation: t_gamma,
        resistance: 0.0,
        stuck: None,
        slip_speed: None,
        slip_speed_error: None,
        temperature: None,
        temperature_error: None,
        creepage_error: None,
        wear: Vec::new(),
        iterations: [0; 2],
        unique: true,
        notes,
    })
}

/// Returns the forces with a law along the rolling and across it, and the error of their vector
/// (N).
///
/// # Errors
/// The law fails.
pub(in crate::patch) fn of_law(
    setup: &Setup,
    creepage: &Creepage,
    law: &PatchLaw,
) -> Result<(Vector, f64), Error> {
    let pressed = (setup.load, |place| setup.rung.shape(place));
    let most = held(&setup.grid, pressed, creepage, law, setup.rolling_speed());
    if let Some(error) = law.take_error() {
        return Err(Error::Failed(error.to_string()));
    }
    Ok(match &setup.rung {
        Rung::Ellipse(closed) => closed.forces(creepage, most),
        Rung::Line(_, creep) => {
            let share = creep.share(creepage.along * setup.load / most);
            ([-most * share, 0.0], 0.0)
        }
        Rung::Exact | Rung::Fastsim(_) => ([0.0; 2], 0.0),
    })
}
