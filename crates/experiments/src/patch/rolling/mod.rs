//! Points of steady rolling: forces, wear and temperature at each creepage.

pub mod closed;
pub mod comparison;
pub mod passages;
pub(in crate::patch) mod passages_shown;
pub(in crate::patch) mod pulling;
#[cfg(test)]
mod tests;
pub(in crate::patch) mod wear;

use crate::Error;
use crate::patch::answer::{Band, Motion, Point};
use crate::patch::law::{Passage, PatchLaw};
use crate::patch::method::Rung;
use crate::patch::profiles::Contact;
use crate::patch::setup::Setup;
use crate::patch::spec::{MotionSpec, Numbers, PatchFile, value};
use crate::patch::text::short;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::pull::LARGEST;
use fretwork_rolling::{Creepage, Fastsim, Refined, Rolling};
use fretwork_scene::InputError;

/// Difference of the energies supplied and dissipated over the latter that is no longer small,
/// where pressures resist by more than this share of T gamma.
const BALANCE: f64 = 0.2;
/// Peclet number below which heat flows along the patch too.
const FAST: f64 = 5.0;
/// Error of a number by the grid over it that is no longer small.
const COARSE: f64 = 0.05;

/// Returns the creepages of all points.
///
/// # Errors
/// A number is out of range, or lists differ in length.
pub fn creepages(file: &PatchFile) -> Result<Vec<Creepage>, InputError> {
    let MotionSpec::Rolling {
        along,
        across,
        spin,
    } = &file.spec.motion
    else {
        return Ok(Vec::new());
    };
    let source = &file.source;
    let read = |name: &str, numbers: &Numbers, unit: &str| -> Result<Vec<f64>, InputError> {
        let path = format!("motion.{name}");
        let list = numbers.0.iter().enumerate();
        let list: Vec<f64> = list
            .map(|(k, n)| value(source, &numbers.path(&path, k), n, unit))
            .collect::<Result<_, _>>()?;
        let large = list
            .iter()
            .position(|x| unit.is_empty() && x.abs() > LARGEST);
        if let Some(k) = large {
            // A number without a unit may have been meant in per cent.
            let advice = match numbers.0[k].unit {
                Some(_) => String::new(),
                None => format!("; in per cent write {} %", short(list[k])),
            };
            return Err(source.error_at(
                &numbers.path(&path, k),
                format!(
                    "a creepage of {} is more than {LARGEST}, where bodies slide rather than roll{advice}",
                    short(list[k])
                ),
            ));
        }
        Ok(list)
    };
    let lists = [
        read("along", along, "")?,
        read("across", across, "")?,
        read("spin", spin, "1/m")?,
    ];
    let count = lists.iter().map(Vec::len).max().unwrap_or(0);
    if count == 0 {
        return Err(source.error_at(
            "motion",
            "there is no creepage: give `along`, `across` or `spin`",
        ));
    }
    if let Some(other) = lists.iter().find(|l| l.len() > 1 && l.len() != count) {
        return Err(source.error_at(
            "motion",
            format!(
                "lists of {} and {count} creepages: give lists of one length, or single numbers",
                other.len()
            ),
        ));
    }
    let at = |list: &[f64], k: usize| match list {
        [] => 0.0,
        [one] => *one,
        many => many[k],
    };
    let point = |k| Creepage {
        along: at(&lists[0], k),
        across: at(&lists[1], k),
        spin: at(&lists[2], k),
    };
    Ok((0..count).map(point).collect())
}

/// A solved point with the fields over its cells.
#[derive(Debug)]
pub struct Solved {
    /// The numbers.
    pub point: Point,
    /// The fields.
    pub rolling: Rolling,
    /// What the laws gave in the cells.
    pub passage: Passage,
}

/// Solves a point, with the laws of all members for its band.
///
/// # Errors
/// A law fails, or there is no solution.
pub fn solve(setup: &Setup, creepage: &Creepage) -> Result<Solved, Error> {
    let (refined, passage) = of_law(setup, creepage, &setup.laws[0])?;
    let members = setup.laws[1..].iter().map(|law| -> Result<f64, Error> {
        let (refined, _) = of_law(setup, creepage, law)?;
        Ok(length(refined.force) / setup.load)
    });
    let members: Vec<f64> = members.collect::<Result<_, Error>>()?;
    let speed = setup.rolling_speed();
    let wear = wear::of_passage(setup, &setup.laws[0], &refined, &passage.worn)?;
    let Refined {
        fine,
        force,
        moment,
        error,
        ..
    } = refined;
    let grid = fine.grid;
    let cells = fine.tractions.slip.iter().zip(&fine.pressure.pressure);
    let touching = cells.clone().filter(|(_, p)| **p > 0.0).count();
    let sticks = fine.tractions.sticks.iter().zip(&fine.pressure.pressure);
    let stuck = sticks.filter(|(s, p)| **s && **p > 0.0).count();
    let most = |list: &[f64]| list.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let slips = cells.map(|(s, _)| length(*s));
    let adhesion = length(force) / setup.load;
    let t_gamma =
        -(force[0] * creepage.along + force[1] * creepage.across + moment.value * creepage.spin);
    let mut notes = Vec::new();
    if !fine.tractions.unique {
        notes.push("NOT UNIQUE: friction falls so fast with slip that the patch has another branch of lower friction at this creepage; a law whose friction follows over a length of slip decides between them".to_owned());
    }
    notes.extend(coarse(&[
        ("the force", length(error), length(force)),
        (
            "the wear",
            wear.first().map_or(0.0, |w| w.volume_error),
            wear.first().map_or(0.0, |w| w.volume),
        ),
    ]));
    if let Some(thermal) = setup.laws[0].thermal() {
        let peclet = thermal.peclet(0.5 * grid.extent()[0], speed);
        if peclet < FAST {
            notes.push(format!(
                "NOT IN RANGE: at a Peclet number of {} heat also flows along the patch, and the temperatures are those of heat that flows into the depth alone",
                number(peclet, 2)
            ));
        }
    }
    let supplied = fine.t_gamma + fine.resistance;
    let cancels = fine.resistance.abs() > BALANCE * fine.t_gamma.abs();
    if cancels && (supplied - fine.dissipation).abs() > BALANCE * fine.dissipation {
        notes.push(format!(
            "NOT IN RANGE: T gamma and the work of unlike bodies' pressures, {}, supply {} together, and the slips dissipate {}: slips and temperature are not known better than these differ; take more `cells`",
            quantity(fine.resistance, "J/m"),
            quantity(supplied, "J/m"),
            quantity(fine.dissipation, "J/m")
        ));
    }
    notes.extend(setup.bodies.yields(fine.pressure.largest()));
    notes.extend(setup.bodies.short_line(setup.load));
    notes.extend(setup.contact().iter().flat_map(Contact::notes));
    let mut pressed = fine.pressure.pressure.iter().enumerate();
    let distance = &setup.bodies.distance;
    if pressed.any(|(cell, p)| *p > 0.0 && !distance.knows(grid.middle(cell)[1])) {
        notes.push("NOT IN RANGE: the patch reaches beyond the ends of the table of the distance, where it goes on straight: measure it over a wider range".to_owned());
    }
    let time = touching as f64 * grid.size[0] / speed;
    notes.extend(setup.laws[0].outside(&passage, grid.cells[0], time));
    // The force of full slip is that of the bounds.
    let bounds = fine.tractions.bound.iter().sum::<f64>() * grid.area(3);
    let of_theory = match setup.rung {
        Rung::Fastsim(_) => Fastsim::ERROR[usize::from(creepage.spin != 0.0)] * bounds,
        _ => 0.0,
    };
    let temperature = setup.speed.filter(|_| !passage.temperature.is_empty());
    let point = Point {
        motion: Motion::Rolling(*creepage),
        stroke: None,
        force,
        adhesion,
        adhesion_error: (length(error) + of_theory) / setup.load,
        adhesion_band: Band::of(adhesion, &members),
        moment: Some(moment.value),
        t_gamma,
        dissipation: fine.dissipation,
        resistance: fine.resistance,
        stuck: Some(stuck as f64 / touching as f64),
        slip_speed: setup
            .speed
            .map(|v| slips.fold(0.0, f64::max) * v / grid.size[0]),
        temperature: temperature.map(|_| most(&passage.temperature)),
        wear,
        iterations: fine.tractions.iterations,
        unique: fine.tractions.unique,
        notes,
    };
    Ok(Solved {
        point,
        rolling: fine,
        passage,
    })
}

/// Returns a note where the grid errs by more than a small part of numbers, each with its name and
/// its error.
pub(in crate::patch) fn coarse(numbers: &[(&str, f64, f64)]) -> Option<String> {
    let large = numbers.iter().filter(|(_, error, of)| *error > COARSE * of);
    let parts = large.map(|(name, error, of)| match error < of {
        true => format!("{} % of {name}", number(100.0 * error / of, 2)),
        false => format!("as much as all of {name}"),
    });
    let parts: Vec<String> = parts.collect();
    let all = parts.join(" and ");
    (!parts.is_empty()).then(|| format!("the grid errs by {all}: take more `cells`"))
}

/// Solves a point with a law.
///
/// # Errors
/// The law fails, or there is no solution.
pub(in crate::patch) fn of_law(
    setup: &Setup,
    creepage: &Creepage,
    law: &PatchLaw,
) -> Result<(Refined, Passage), Error> {
    let speed = setup.rolling_speed();
    let solved = setup.refined(creepage, law);
    let fail = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
    if let Some(error) = law.take_error() {
        return Err(fail(&error));
    }
    let refined = solved.map_err(|e| fail(&e))?;
    let fine = &refined.fine;
    let cells = Cells {
        grid: &fine.grid,
        pressure: &fine.pressure.pressure,
        speed,
    };
    let passage = law.passage(cells, &fine.wearing_slip());
    Ok((refined, passage.map_err(|e| fail(&e))?))
}

/// Returns the bodies and their parts in what the wear law gives: by the law and the hardness of
/// each, or of both as `interface` where the law does not tell them apart.
pub(in crate::patch) fn bodies_that_wear(setup: &Setup) -> Vec<(String, f64)> {
    let Some(factors) = factors(setup) else {
        return vec![("interface".to_owned(), 1.0)];
    };
    let bodies = setup.bodies.names.iter().zip(factors);
    let bodies = bodies.filter_map(|(name, factor)| Some((name.clone(), factor?)));
    bodies.collect()
}

/// Returns the depth that each body loses over that of the wear law, where its coefficient follows
/// from the hardness of the softer one: that over its own, if it is known.
pub(in crate::patch) fn factors(setup: &Setup) -> Option<[Option<f64>; 2]> {
    let coefficient = setup.wear_coefficient.as_ref()?;
    let hardness = setup.bodies.hardness();
    Some(hardness.map(|own| own.map(|own| coefficient.hardness / own)))
}
