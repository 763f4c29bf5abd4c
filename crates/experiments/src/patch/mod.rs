//! A contact patch by the laws of an interface: from load, bodies and motion to adhesion, wear and
//! temperature, with fields over the patch.
//!
//! ```text
//! file (RON, as a case)        spec
//!       ▼
//! bodies, grid, laws, rung     bodies, profiles, setup, law, method
//!       ▼
//! points: creepages, strokes   rolling, fretting               (fretwork_rolling)
//!       ▲▼
//! runs of a window             third_body
//!       ▼
//! profiles over passages       rolling::passages
//! maps, many cycles            fretting::{map, cycles}
//! other curves, measurements   rolling::comparison
//! numbers, curves, fields      answer, text, files, page
//! methods and grids compared   trade
//! ```

mod answer;
mod bodies;
mod columns;
pub mod files;
pub mod fretting;
pub mod law;
pub mod loads;
pub mod method;
#[cfg(test)]
mod method_tests;
mod page;
pub mod profiles;
pub mod rolling;
mod said;
mod setup;
pub mod spec;
#[cfg(test)]
pub(crate) mod tests;
mod text;
pub mod third_body;
pub mod trade;

pub use answer::{Answer, Band, Motion, Point, Wear};
pub use bodies::{Bodies, Distance};
pub use profiles::Contact;
pub use setup::Setup;
pub use spec::{PatchFile, PatchSpec};

use crate::Error;
use crate::folder::Owner;
use crate::limits::Traction;
use fretting::Stroke;
use fretwork_core::laws::SearchPath;
use fretwork_observe::quantity::quantity;
use fretwork_rolling::{Course, Creepage, Pressure};
use law::PatchLaw;
use method::{Method, Rung};
use rolling::pulling::Pull;
use rolling::{Solved, comparison, passages, pulling};
use spec::one_load;

/// Owner of the folders of patches.
pub const OWNER: Owner = Owner {
    command: "fretwork patch",
    lock_file: "patch.lock",
    files: &["patch.json"],
};

/// All points of a patch.
#[derive(Debug)]
pub struct Outcome {
    /// The numbers.
    pub answer: Answer,
    /// The patch.
    pub setup: Setup,
    /// Fields of points of rolling.
    pub rolled: Vec<Solved>,
    /// Curves and fields of strokes.
    pub strokes: Vec<Stroke>,
    /// The bodies over their passages.
    pub course: Option<Course>,
}

/// Gets the name of the part of a patch that is being solved, and the share of it that is done.
pub type Follow<'a> = dyn FnMut(&str, f64) + 'a;

/// Solves a patch under each of its loads, see [`solve`].
///
/// # Errors
/// As of [`solve`].
pub fn solve_loads(
    file: &PatchFile,
    search: &SearchPath,
    follow: &mut Follow<'_>,
) -> Result<Vec<Outcome>, Error> {
    let all = spec::loads(file)?;
    let many = all.len() > 1;
    let each = all.into_iter().map(|load| {
        let mut under = |part: &str, done: f64| match many {
            true => follow(&format!("{}, {part}", quantity(load, "N")), done),
            false => follow(part, done),
        };
        solve_under(file, load, search, &mut under)
    });
    each.collect()
}

/// Solves a patch under one load: all points, then passages, cycles and map, each of which is
/// followed.
///
/// # Errors
/// The file names what does not exist or has several loads, a law cannot act in a patch or fails,
/// or a point has no solution.
pub fn solve(
    file: &PatchFile,
    search: &SearchPath,
    follow: &mut Follow<'_>,
) -> Result<Outcome, Error> {
    solve_under(file, one_load(file, "this patch")?, search, follow)
}

fn solve_under(
    file: &PatchFile,
    load: f64,
    search: &SearchPath,
    follow: &mut Follow<'_>,
) -> Result<Outcome, Error> {
    if file.spec.third_body.is_some() {
        let why = "the runs of a `third_body` are made by the command `fretwork patch`";
        return Err(file.source.error_at("third_body", why).into());
    }
    let mut creepages = rolling::creepages(file)?;
    let (frets, drives) = fretting::strokes(file)?;
    let loops = fretting::measured_loops::read(file)?;
    if frets.is_none() && !loops.is_empty() {
        let why = "measured loops stand beside strokes: `motion: Fretting(...)`";
        return Err(file.source.error_at("loops", why).into());
    }
    let map = frets.and_then(|spec| Some((spec, spec.map.as_ref()?)));
    if map.is_some() {
        one_load(file, "a patch with a `map` over loads of its own")?;
    }
    let mut pulls = pulling::forces(file)?;
    let setup = Setup::new(file, load, search)?;
    let spin = setup.added_spin();
    creepages.iter_mut().for_each(|c| c.spin += spin);
    pulls.iter_mut().for_each(|p| p.spin += spin);
    let plan = passages::plan(file, &setup, &creepages, &pulls)?;
    let count = (creepages.len() + pulls.len() + drives.len()) as f64;
    let (mut rolled, mut strokes) = (Vec::new(), Vec::new());
    let closed = matches!(setup.rung, Rung::Ellipse(_) | Rung::Line(..));
    let mut points: Vec<Point> = Vec::new();
    let mut roll = |creepage: &Creepage, pull: Option<&Pull>| -> Result<(), Error> {
        let mut point = match closed {
            true => rolling::closed::point(&setup, creepage)?,
            false => {
                let solved = rolling::solve(&setup, creepage)?;
                let point = solved.point.clone();
                rolled.push(solved);
                point
            }
        };
        if let Some(pull) = pull {
            pulling::determine(&setup, pull, &mut point)?;
        }
        points.push(point);
        follow("points", points.len() as f64 / count);
        Ok(())
    };
    for creepage in &creepages {
        roll(creepage, None)?;
    }
    for pull in &pulls {
        roll(&pulling::creepage(file, &setup, pull)?, Some(pull))?;
    }
    for drive in &drives {
        strokes.push(fretting::solve(file, &setup, drive)?);
        follow("points", strokes.len() as f64 / count);
    }
    let worn = plan.map(|plan| passages::wear(file, &setup, &plan, &rolled, follow));
    let worn = worn.transpose()?;
    let pressures = rolled.iter().map(|s| &s.rolling.pressure);
    let mut pressures = pressures.chain(strokes.iter().map(|s| &s.found.fine.pressure));
    let first = match pressures.next() {
        Some(pressure) => pressure.clone(),
        None if closed => Pressure::default(),
        None => {
            let pressed = setup.with_patch(|patch| patch.pressed(setup.grid));
            pressed.map_err(|e| fretting::fail(&e))?.1
        }
    };
    points.extend(strokes.iter().map(|s| s.point.clone()));
    let comparisons = comparison::comparisons(file, &setup, &points)?;
    let mut answer = numbers(file, &setup, &first, points);
    answer.comparisons = comparisons;
    answer.loops = loops;
    let (worn, course) = worn.unzip();
    answer.passages = worn;
    if let Some(spec) = frets {
        let strokes = (&drives[..], &answer.points[..]);
        answer.cycles = fretting::cycles::solve(file, &setup, spec, strokes, follow)?;
    }
    if let Some((spec, map)) = map {
        answer.map = Some(fretting::map::solve(file, &setup, spec, map, follow)?);
    }
    Ok(Outcome {
        answer,
        setup,
        rolled,
        strokes,
        course,
    })
}

fn numbers(file: &PatchFile, setup: &Setup, pressure: &Pressure, points: Vec<Point>) -> Answer {
    let loaded = setup.laws[0].interface().loaded();
    let touching = pressure.pressure.iter().filter(|p| **p > 0.0).count();
    let area = touching as f64 * setup.grid.area(3);
    let of_cells = || [pressure.largest(), pressure.approach, area];
    let [largest, approach, area] = setup.rung.pressed(&setup.grid).unwrap_or_else(of_cells);
    let coulomb = setup.laws.iter().all(PatchLaw::is_constant);
    let ratio = points.iter().map(|p| p.adhesion).reduce(f64::max);
    let traction = ratio.map(|ratio| Traction { ratio, asked: true });
    Answer {
        notes: setup.bodies.limits(setup.load),
        strength: traction.and_then(|t| setup.bodies.strength(Some(t))),
        name: file.spec.name.clone(),
        bodies: setup.bodies.names.each_ref().map(|n| {
            let from = file.spec.materials.get(n);
            from.unwrap_or(n).clone()
        }),
        names: setup.bodies.names.clone(),
        load: setup.load,
        speed: setup.speed,
        laws: loaded
            .map(|l| (l.plugin.kind.to_string(), l.plugin.name.clone()))
            .collect(),
        method: file.spec.method,
        about_method: setup.rung.about(coulomb),
        errors: match (file.spec.method, coulomb) {
            (Method::Exact, _) | (_, true) => file.spec.method.error_of().to_owned(),
            (other, false) => format!("{} under Coulomb's law", other.error_of()),
        },
        cells: setup.grid.cells,
        cell: setup.grid.size,
        pressure: largest,
        approach,
        area,
        contact: setup.contact(),
        third_body: None,
        points,
        comparisons: Vec::new(),
        loops: Vec::new(),
        passages: None,
        cycles: Vec::new(),
        map: None,
    }
}
