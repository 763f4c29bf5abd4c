//! Profiles of both bodies over many passages: what a passage is for each body, how they share the
//! wear, and the course with its errors.

use crate::Error;
use crate::patch::Follow;
use crate::patch::law::PatchLaw;
use crate::patch::rolling::pulling::{self, Pull};
use crate::patch::rolling::wear::Rows;
use crate::patch::rolling::{Solved, coarse as coarse_note, factors};
use crate::patch::said::Said;
use crate::patch::setup::Setup;
use crate::patch::spec::{PatchFile, positive, value};
use fretwork_core::laws::{Kind, LawError};
use fretwork_elastic::half_space::CellGrid;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::friction::Cells;
use fretwork_rolling::passages::{Course, Drive, Jump, Passages, Steps, flat};
use fretwork_rolling::{Creepage, Vector, Wears};
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// Passages of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassagesSpec {
    /// Passages of the patch over each point of the body that is counted: the one that is plane
    /// along the motion, such as a rail, else the second one.
    pub count: f64,
    /// Largest number of passages of a jump.
    #[serde(default)]
    pub jump: Option<f64>,
    /// Largest error of a jump in depth over the depth that it takes.
    #[serde(default)]
    pub error: Option<NumberSpec>,
    /// Passages at which profiles are kept.
    #[serde(default)]
    pub profiles: Vec<f64>,
    /// Length of the track on which the wheels run (m), over which the counted passages are made.
    #[serde(default)]
    pub track: Option<NumberSpec>,
    /// Number of wheels that run over the track.
    #[serde(default)]
    pub wheels: Option<f64>,
    /// Parts of the depth of the wear law that the first and the second body lose.
    #[serde(default)]
    pub shares: Option<(f64, f64)>,
    /// The point that wears, from 1, where the motion has several.
    #[serde(default)]
    pub point: Option<usize>,
}

/// Error of a jump by default.
const SHARE: f64 = 0.05;
/// Number of profiles that are kept by default.
const PROFILES: usize = 8;

/// Passages that can be made.
#[derive(Clone, Debug)]
pub(in crate::patch) struct Plan {
    steps: Steps,
    parts: [f64; 2],
    drive: Drive,
    /// What the answer says of it.
    about: PassageCounts,
}

/// What a passage is for each body.
#[derive(Clone, Debug, Serialize)]
pub struct PassageCounts {
    /// The point of the motion that wears, from 1.
    pub point: usize,
    /// Passages of the points of each body.
    pub passages: [f64; 2],
    /// Parts of the depth of the wear law that the bodies lose in each of their passages.
    pub shares: [f64; 2],
    /// How they follow, as sentences.
    pub why: [String; 2],
}

/// Bodies after their passages.
#[derive(Clone, Debug, Serialize)]
pub struct Worn {
    /// What a passage is.
    pub about: PassageCounts,
    /// New bodies.
    pub start: Jump,
    /// Worn bodies.
    pub end: Jump,
    /// Error of the largest depth of each body by the cells (m), from cells twice as large.
    pub error_of_grid: [f64; 2],
    /// Error of the largest pressure of the worn bodies by the cells (Pa).
    pub pressure_error: f64,
    /// That of the new bodies (Pa).
    pub start_error: f64,
    /// What limits the trust in it.
    pub notes: Vec<String>,
    /// Number of jumps, and of those that were made again.
    pub jumps: [usize; 2],
    /// Difference between the volume that the law took and that which the profiles miss, over the
    /// former.
    pub ledger: f64,
}

/// Share of the time of both courses that the one on the fine grid takes: four times the cells.
const FINE: f64 = 0.8;

/// Fewest cells along a side: half as many still lay a grid around the patch as it widens.
const FEWEST_CELLS: usize = 20;

/// Reads the passages of a file, of points with creepages or forces.
///
/// # Errors
/// A number is out of range, or it is not clear which point wears, and how.
pub(in crate::patch) fn plan(
    file: &PatchFile,
    setup: &Setup,
    creepages: &[Creepage],
    pulls: &[Pull],
) -> Result<Option<Plan>, Error> {
    let (spec, source) = (&file.spec, &file.source);
    let Some(given) = &spec.passages else {
        return Ok(None);
    };
    let refuse = |path: &str, why: String| Err(Error::Input(source.error_at(path, why)));
    if setup.laws[0].interface().law(Kind::WEAR).is_none() {
        return refuse(
            "passages",
            "nothing wears: give the interface of the bodies a `wear` law, such as \"archard\""
                .into(),
        );
    }
    if spec.cells < FEWEST_CELLS {
        return refuse(
            "cells",
            format!(
                "{} cells are too few for passages, whose error is from half as many: take {FEWEST_CELLS} or more",
                spec.cells
            ),
        );
    }
    let points = creepages.len() + pulls.len();
    if points == 0 {
        return refuse(
            "passages",
            "passages are those of bodies that roll: take `motion: Rolling(..)` or `Pulling(..)`"
                .into(),
        );
    }
    if setup.bodies.length.is_some() {
        return refuse(
            "passages",
            "profiles are those across the rolling, and a contact along a line of a `length` is the same all along it: give the bodies radii `across`, or leave out `passages`"
                .into(),
        );
    }
    let point = match given.point {
        Some(point) if (1..=points).contains(&point) => point,
        None if points == 1 => 1,
        _ => {
            return refuse(
                "passages.point",
                format!("which point of the motion wears? Give one of 1 to {points}"),
            );
        }
    };
    let above = |name: &str, given: f64, least: f64| match given.is_finite() && given >= least {
        true => Ok(given),
        false => Err(source.error_at(
            &format!("passages.{name}"),
            format!(
                "it is {}, and must be a number of {least} or more",
                number(given, 4)
            ),
        )),
    };
    let count = above("count", given.count, 1.0)?;
    let longest = given.jump.map(|jump| above("jump", jump, 1.0));
    let longest = longest.transpose()?.unwrap_or(f64::INFINITY);
    let share = given.error.as_ref();
    let share = share.map(|e| value(source, "passages.error", e, ""));
    let share = share.transpose()?.unwrap_or(SHARE);
    if !(1e-4..=0.5).contains(&share) {
        return refuse(
            "passages.error",
            format!(
                "it is {} %, and must be between 0.01 % and 50 % of the depth of a jump",
                number(100.0 * share, 4)
            ),
        );
    }
    let mut moments = given.profiles.clone();
    moments.sort_by(f64::total_cmp);
    moments.dedup();
    if let Some(wrong) = moments.iter().find(|m| !(**m > 0.0 && **m <= count)) {
        return refuse(
            "passages.profiles",
            format!(
                "a profile after {} passages is not among the {}",
                number(*wrong, 4),
                number(count, 4)
            ),
        );
    }
    if moments.is_empty() {
        // Profiles deepen about with the root of the passages.
        let of = |k: usize| count * (k as f64 / PROFILES as f64).powi(2);
        moments = (1..=PROFILES).map(of).collect();
    }
    let (passages, why_passages) = passages_of(file, given, count)?;
    let (shares, why_shares) = shares(file, setup, given)?;
    let drive = match creepages.get(point - 1) {
        Some(creepage) => Drive::Creepage(*creepage),
        None => {
            let pull = &pulls[point - 1];
            let start = pulling::creepage(file, setup, pull)?;
            let force = pull.force;
            Drive::Force { force, start }
        }
    };
    Ok(Some(Plan {
        steps: Steps {
            count,
            share,
            longest,
            moments,
        },
        parts: [0, 1].map(|k| shares[k] * passages[k] / count),
        drive,
        about: PassageCounts {
            point,
            passages,
            shares,
            why: [why_passages, why_shares],
        },
    }))
}

/// Returns the passages of the points of both bodies, and why.
fn passages_of(
    file: &PatchFile,
    given: &PassagesSpec,
    count: f64,
) -> Result<([f64; 2], String), InputError> {
    let (spec, source) = (&file.spec, &file.source);
    let bodies = [&spec.bodies.0, &spec.bodies.1];
    let mut radii = [None; 2];
    for (k, body) in bodies.iter().enumerate() {
        let path = format!("bodies.{k}.radius");
        let radius = body.radius.as_ref();
        radii[k] = radius.map(|r| value(source, &path, r, "m")).transpose()?;
    }
    let name = |k: usize| &bodies[k].material;
    let counted = match radii {
        [None, Some(_)] => 0,
        _ => 1,
    };
    let other = 1 - counted;
    let mut all = [count; 2];
    let on_track = given.track.is_some() || given.wheels.is_some();
    let why = match (radii[other], radii[counted]) {
        (Some(radius), None) => {
            let Some(track) = &given.track else {
                if on_track {
                    return Err(source.error_at(
                        "passages.wheels",
                        "give the length of the `track` on which these wheels run",
                    ));
                }
                let all = format!(
                    "each point of {} and of {} passes through the patch as often (no `track`)",
                    name(other),
                    name(counted)
                );
                return Ok(([count; 2], all));
            };
            let track = positive(source, "passages.track", track, "m")?;
            let wheels = given.wheels.unwrap_or(1.0);
            if !(wheels.is_finite() && wheels > 0.0) {
                return Err(source.error_at("passages.wheels", "give a number above 0"));
            }
            let turns = track / (std::f64::consts::TAU * radius.abs());
            all[other] = count * turns / wheels;
            format!(
                "a point of {} passes once for each wheel, a point of {} once a turn: {} turns over the track, shared by {wheels} wheels",
                name(counted),
                name(other),
                number(turns, 4)
            )
        }
        _ if on_track => {
            return Err(source.error_at(
                "passages",
                "a `track` is for a body with a radius along the motion on one that is plane along it",
            ));
        }
        (Some(one), Some(fixed)) => {
            all[other] = count * (fixed / one).abs();
            format!(
                "a point of each body passes once a turn, that of {} {} times as often",
                name(other),
                number(all[other] / count, 4)
            )
        }
        _ => "each point of both bodies passes as often".into(),
    };
    Ok((all, why))
}

/// Returns the parts of the depth of the law that both bodies lose in a passage, and why.
fn shares(
    file: &PatchFile,
    setup: &Setup,
    given: &PassagesSpec,
) -> Result<([f64; 2], String), InputError> {
    let source = &file.source;
    if let Some((one, other)) = given.shares {
        if factors(setup).is_some() {
            return Err(source.error_at(
                "passages.shares",
                "each body wears by `K` over its own hardness: leave `shares` out, or give the coefficient of both together, `k`",
            ));
        }
        return match one >= 0.0 && other >= 0.0 && (one + other - 1.0).abs() < 1e-9 {
            true => Ok(([one, other], "`shares` of the file".into())),
            false => Err(source.error_at(
                "passages.shares",
                "give two numbers of 0 or more that add to 1: the parts of the depth of the law",
            )),
        };
    }
    match factors(setup) {
        None => Ok((
            [0.5; 2],
            "each body loses half of the depth of the law (no `shares`, no `K`)".into(),
        )),
        Some([Some(one), Some(other)]) => Ok((
            [one, other],
            "each body wears by K over its own hardness".into(),
        )),
        Some(_) => Err(source.error_at(
            "passages",
            "`K` needs the hardness of both materials; add it to their files, or give `shares`",
        )),
    }
}

/// Wear by the law of a patch, with its first error.
struct ByLaw<'a> {
    law: &'a PatchLaw,
    error: RefCell<Option<LawError>>,
}

impl Wears for ByLaw<'_> {
    fn worn(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<f64> {
        match self.law.passage(cells, slip) {
            Ok(passage) => passage.worn,
            Err(error) => {
                self.error.borrow_mut().get_or_insert(error);
                vec![0.0; slip.len()]
            }
        }
    }
}

/// Largest half-width of a patch over the relative radius across: a parabola is 6 % off the arc.
const WIDEST: f64 = 0.5;

/// Returns the largest half-width of a patch (m), and the relative radius of the bodies across (m),
/// where they have one.
fn room(setup: &Setup) -> Option<[f64; 2]> {
    let distance = &setup.bodies.distance;
    let radius = 1.0 / distance.curvatures[1];
    distance
        .profile
        .is_none()
        .then_some([WIDEST * radius, radius])
}

/// Refuses passages that wear bodies, at the rate of the new ones, wider than their shape is known.
fn check_count(
    file: &PatchFile,
    setup: &Setup,
    plan: &Plan,
    new: &Solved,
) -> Result<(), InputError> {
    let Some([widest, radius]) = room(setup) else {
        return Ok(());
    };
    let each = Rows::of(&new.rolling, &new.passage.worn).volume();
    let each = each * plan.parts.iter().sum::<f64>();
    let half = flat(each * plan.steps.count, radius);
    if half <= widest {
        return Ok(());
    }
    let most = plan.steps.count * (widest / half).powi(3);
    let why = format!(
        "{} passages wear the bodies over some {} to each side, where the arcs of their radii, {} together, are no parabola: give a `count` below {}",
        number(plan.steps.count, 4),
        quantity(half, "m"),
        quantity(radius, "m"),
        number(most, 2)
    );
    Err(file.source.error_at("passages.count", why))
}

/// Makes all passages; `solved` has the points of the new bodies.
///
/// # Errors
/// A law fails, or there is no solution.
pub(in crate::patch) fn wear(
    file: &PatchFile,
    setup: &Setup,
    plan: &Plan,
    solved: &[Solved],
    follow: &mut Follow<'_>,
) -> Result<(Worn, Course), Error> {
    if let Some(new) = solved.get(plan.about.point - 1) {
        check_count(file, setup, plan, new)?;
    }
    let cells = setup.grid.cells;
    let all = plan.steps.count;
    let course = course(setup, plan, &setup.grid, &mut |jump| {
        follow("passages", FINE * jump.passages / all);
    })?;
    let coarse = CellGrid {
        size: [0, 1].map(|k| setup.grid.extent()[k] / (cells[k] / 2) as f64),
        cells: cells.map(|n| n / 2),
        ..setup.grid
    };
    let rough = self::course(setup, plan, &coarse, &mut |jump| {
        follow("passages", FINE + (1.0 - FINE) * jump.passages / all);
    })?;
    let ends = |course: &Course| {
        let [first, last] = [course.jumps.first(), course.jumps.last()];
        [first, last].map(|jump| jump.copied().unwrap_or_default())
    };
    let ([start, end], [rough_start, rough_end]) = (ends(&course), ends(&rough));
    let error_of_grid = [0, 1].map(|k| (end.depth[k] - rough_end.depth[k]).abs());
    let pressure_error = (end.pressure - rough_end.pressure).abs();
    let start_error = (start.pressure - rough_start.pressure).abs();
    let deepest = usize::from(end.depth[1] > end.depth[0]);
    let notes = coarse_note(&[
        (
            "the pressure of the new bodies",
            start_error,
            start.pressure,
        ),
        ("that of the worn ones", pressure_error, end.pressure),
        ("the depth", error_of_grid[deepest], end.depth[deepest]),
    ]);
    let worn = Worn {
        about: plan.about.clone(),
        start,
        end,
        error_of_grid,
        pressure_error,
        start_error,
        notes: notes.into_iter().collect(),
        jumps: [course.jumps.len() - 1, course.repeated],
        ledger: course.ledger(),
    };
    Ok((worn, course))
}

fn course(
    setup: &Setup,
    plan: &Plan,
    grid: &CellGrid,
    follow: &mut dyn FnMut(&Jump),
) -> Result<Course, Error> {
    let law = &setup.laws[0];
    let wears = ByLaw {
        law,
        error: RefCell::new(None),
    };
    let made = setup.with_patch(|patch| {
        let passages = Passages {
            patch: *patch,
            drive: plan.drive,
            law,
            speed: setup.rolling_speed(),
            wears: &wears,
            parts: plan.parts,
            widest: room(setup).map_or(f64::INFINITY, |[widest, _]| 2.0 * widest),
        };
        passages.wear(grid, &plan.steps, follow)
    });
    let error = law.take_error().or_else(|| wears.error.take());
    if let Some(error) = error {
        return Err(Error::Failed(error.to_string()));
    }
    made.map_err(|e| Error::Failed(e.said()))
}
