//! Points of steady rolling: forces, wear and temperature at each creepage.

pub mod closed;
pub mod comparison;
pub mod passages;
pub(in crate::patch) mod passages_shown;
pub(in crate::patch) mod pulling;
#[cfg(test)]
mod tests;
mod theory;
pub(in crate::patch) mod wear;

use crate::Error;
use crate::amounts::short;
use crate::patch::answer::{Band, Motion, Point};
use crate::patch::law::{Passage, PatchLaw};
use crate::patch::method::Rung;
use crate::patch::setup::Setup;
use crate::patch::spec::{MotionSpec, Numbers, PatchFile, value};
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::pull::LARGEST;
use fretwork_rolling::{Creepage, Estimate, Fastsim, Refined, Rolling};
use fretwork_scene::InputError;
use theory::TheoryError;

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
        for (k, value) in list.iter().enumerate().filter(|_| unit.is_empty()) {
            if let Some(why) = too_large(*value, numbers.0[k].unit.is_none()) {
                return Err(source.error_at(&numbers.path(&path, k), why));
            }
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

/// Returns why a creepage is too large; one that is `bare` of a unit may have been meant in per
/// cent.
pub(crate) fn too_large(creepage: f64, bare: bool) -> Option<String> {
    let shown = short(creepage);
    let advice = match bare {
        true => format!("; in per cent write {shown} %"),
        false => String::new(),
    };
    (creepage.abs() > LARGEST).then(|| {
        format!("a creepage of {shown} is more than {LARGEST}, where bodies slide rather than roll{advice}")
    })
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
    let law = &setup.laws[0];
    let [one, other] = &refined.coarse;
    let passages = [passage_of(setup, one, law)?, passage_of(setup, other, law)?];
    let mut wear = wear::of_passage(setup, law, &refined, (&passage, &passages));
    let of_grid = wear
        .first()
        .map_or([0.0; 2], |w| [w.volume_error, w.volume]);
    let theory = TheoryError::of(setup, law, creepage, &refined.fine)?;
    let parts = bodies_that_wear(setup).into_iter();
    for (wear, (_, part)) in wear.iter_mut().zip(parts) {
        wear.volume_error += part * theory.volume;
        wear.depth_error += part * theory.depth;
    }
    let slip = largest(
        fastest(&refined.fine),
        [fastest(one), fastest(other)],
        theory.slip,
    );
    let heats = setup.speed.is_some() && !passage.temperature.is_empty();
    let temperature = heats.then(|| {
        let coarse = passages.each_ref().map(hottest);
        largest(hottest(&passage), coarse, theory.temperature)
    });
    let Refined {
        fine,
        force,
        moment,
        error,
        ..
    } = refined;
    let grid = fine.grid;
    let touching = fine.pressure.pressure.iter().filter(|p| **p > 0.0).count();
    let sticks = fine.tractions.sticks.iter().zip(&fine.pressure.pressure);
    let stuck = sticks.filter(|(s, p)| **s && **p > 0.0).count();
    let adhesion = length(force) / setup.load;
    let t_gamma =
        -(force[0] * creepage.along + force[1] * creepage.across + moment.value * creepage.spin);
    let mut notes = Vec::new();
    if !fine.tractions.unique {
        notes.push("NOT UNIQUE: friction falls so fast with slip that the patch has another branch of lower friction at this creepage; a law whose friction follows over a length of slip decides between them".to_owned());
    }
    notes.extend(coarse(&[
        ("the force", length(error), length(force)),
        ("the wear", of_grid[0], of_grid[1]),
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
    notes.extend(setup.notes(fine.pressure.largest()));
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
    notes.extend(temperature.and_then(|t| setup.bodies.melts(t.value)));
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
        slip_speed: setup.speed.map(|v| v * slip.value),
        slip_speed_error: setup.speed.map(|v| v * slip.error),
        temperature: temperature.map(|t| t.value),
        temperature_error: temperature.map(|t| t.error),
        creepage_error: None,
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

/// Returns the largest slip over the distance rolled.
fn fastest(rolling: &Rolling) -> f64 {
    let slips = rolling.tractions.slip.iter().map(|s| length(*s));
    slips.fold(0.0, f64::max) / rolling.grid.size[0]
}

/// Returns the highest temperature of a passage (K).
fn hottest(passage: &Passage) -> f64 {
    let cells = passage.temperature.iter().copied();
    cells.fold(f64::NEG_INFINITY, f64::max)
}

/// Returns a largest number of a grid with its error: the larger difference to coarse grids, and
/// that of the theory. The place of a largest number jumps from cell to cell, so that it is not
/// extrapolated.
fn largest(fine: f64, coarse: [f64; 2], theory: f64) -> Estimate {
    let away = coarse.map(|c| (fine - c).abs());
    Estimate {
        value: fine,
        error: away[0].max(away[1]) + theory,
    }
}

/// Returns what a law gives in the cells of a solved patch.
///
/// # Errors
/// The law fails.
fn passage_of(setup: &Setup, rolling: &Rolling, law: &PatchLaw) -> Result<Passage, Error> {
    let cells = Cells {
        grid: &rolling.grid,
        pressure: &rolling.pressure.pressure,
        speed: setup.rolling_speed(),
    };
    let passage = law.passage(cells, &rolling.wearing_slip());
    passage.map_err(|e| Error::Failed(e.to_string()))
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
    let solved = setup.refined(creepage, law);
    let fail = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
    if let Some(error) = law.take_error() {
        return Err(fail(&error));
    }
    let refined = solved.map_err(|e| fail(&e))?;
    let passage = passage_of(setup, &refined.fine, law)?;
    Ok((refined, passage))
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
