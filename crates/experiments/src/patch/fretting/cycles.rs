//! Many cycles of a stroke: scars, debris and friction over the cycles.

use crate::Error;
use crate::patch::Follow;
use crate::patch::answer::{Motion, Point};
use crate::patch::fretting::spec::{CyclesSpec, FrettingSpec, StrokeDrive};
use crate::patch::fretting::{FREQUENCY, fail};
use crate::patch::law::{DEBRIS, outside};
use crate::patch::said::Said;
use crate::patch::setup::Setup;
use crate::patch::spec::{PatchFile, positive};
use fretwork_core::laws::Kind;
use fretwork_elastic::half_space::CellGrid;
use fretwork_observe::quantity::number;
use fretwork_rolling::patch::coarser;
use fretwork_rolling::{Cycles, NormalError, Scar, StrokeError, Surfaces};
use serde::Serialize;

/// Growth of the grid where the scar reaches its border, and how often it grows.
const GROWTH: (f64, usize) = (1.35, 8);

/// A stroke over many cycles.
#[derive(Debug, Serialize)]
pub struct History {
    /// The motion.
    pub motion: Motion,
    /// The cells, which hold the scar.
    #[serde(skip)]
    pub grid: CellGrid,
    /// The contact after each jump, the last one at the end.
    pub scars: Vec<Scar>,
    /// Errors by the grid, from one of cells twice as large: of the volume worn (m³), of the
    /// largest depth (m) and of the amplitude of the force (N).
    pub error_of_grid: [f64; 3],
    /// What limits the trust in it.
    pub notes: Vec<String>,
}

impl History {
    /// Returns the contact at the end.
    pub fn end(&self) -> &Scar {
        &self.scars[self.scars.len() - 1]
    }
}

/// Follows the strokes of a file over their cycles.
///
/// # Errors
/// A number is out of range, a law fails, or a cycle has no solution.
pub fn solve(
    file: &PatchFile,
    setup: &Setup,
    spec: &FrettingSpec,
    (drives, points): (&[StrokeDrive], &[Point]),
    follow: &mut Follow<'_>,
) -> Result<Vec<History>, Error> {
    let Some(cycles) = &spec.cycles else {
        return Ok(Vec::new());
    };
    let source = &file.source;
    if !(cycles.count >= 1.0 && cycles.count <= 1e12) {
        let text = format!("{} cycles: 1 to 1e12 are expected", number(cycles.count, 4));
        return Err(source.error_at("motion.cycles.count", text).into());
    }
    if !(1e-5..=0.5).contains(&cycles.error) {
        let text = "an error from 1e-5 to 0.5 of what a jump changes is expected";
        return Err(source.error_at("motion.cycles.error", text).into());
    }
    let ejection = cycles.ejection.as_ref();
    let ejection = ejection.map(|e| positive(source, "motion.cycles.ejection", e, "m"));
    let ejection = ejection.transpose()?;
    let law = &setup.laws[0];
    let wears = law.interface().law(Kind::WEAR).is_some();
    if !wears && law.is_constant() {
        let text = "nothing changes over the cycles: give the interface a wear law, or a contact law whose friction changes";
        return Err(source.error_at("motion.cycles", text).into());
    }
    if ejection.is_some() && !wears {
        let text = "without a wear law there is no debris that could leave";
        return Err(source.error_at("motion.cycles.ejection", text).into());
    }
    let mut out = Vec::new();
    for (drive, point) in drives.iter().zip(points) {
        setup.check_time(file, drive.step, FREQUENCY)?;
        let count = out.len();
        let mut history = of_drive(setup, drive, cycles, ejection, &mut |part| {
            follow("cycles", (count as f64 + part) / drives.len() as f64);
        })?;
        history.motion = point.motion;
        out.push(history);
    }
    Ok(out)
}

fn of_drive(
    setup: &Setup,
    drive: &StrokeDrive,
    cycles: &CyclesSpec,
    ejection: Option<f64>,
    follow: &mut dyn FnMut(f64),
) -> Result<History, Error> {
    let mut grid = setup.grid;
    for _ in 0..GROWTH.1 {
        let mut scars = Vec::new();
        let found = on_grid(setup, drive, cycles, ejection, grid, &mut |scar| {
            follow(scar.cycles / cycles.count);
            scars.push(scar.clone());
        });
        match found {
            Ok(_) => return finished(setup, drive, cycles, ejection, grid, scars),
            Err(Failed::Border) => grid = grown(&grid),
            Err(Failed::Other(error)) => {
                // Friction that no longer holds the force ends the story, not the command.
                let Some(last) = scars.last().filter(|s| s.cycles > 0.0) else {
                    return Err(error);
                };
                let count = number(last.cycles, 4);
                let mut notes = vec![format!("ends after {count} cycles: {error}")];
                notes.extend(left(setup));
                return Ok(History {
                    motion: Motion::Fretting(last.amplitude[0]),
                    grid,
                    scars,
                    error_of_grid: [f64::NAN; 3],
                    notes,
                });
            }
        }
    }
    Err(Error::Failed(
        "the scar grows beyond the grid again and again: take fewer `cycles`".into(),
    ))
}

fn finished(
    setup: &Setup,
    drive: &StrokeDrive,
    cycles: &CyclesSpec,
    ejection: Option<f64>,
    grid: CellGrid,
    scars: Vec<Scar>,
) -> Result<History, Error> {
    // Those of the fine grid, on which the cycles were followed last.
    let mut notes = left(setup);
    let [coarse, _] = coarser(&grid);
    let rough = on_grid(setup, drive, cycles, ejection, coarse, &mut |_| ());
    let end = &scars[scars.len() - 1];
    let error_of_grid = match rough {
        Ok(rough) => [
            (rough.volume - end.volume).abs(),
            (rough.deepest - end.deepest).abs(),
            (rough.amplitude[1] - end.amplitude[1]).abs(),
        ],
        Err(_) => [f64::NAN; 3],
    };
    if setup.laws[0].debris().is_none() && ejection.is_some() {
        notes.push(format!(
            "no law reads the debris: its friction has no internal variable `{DEBRIS}`, as that of debris-friction"
        ));
    }
    let reach = end.amplitude[0] / (0.5 * grid.extent()[0]);
    if reach > 0.2 && end.volume > 0.0 {
        notes.push(format!(
            "NOT IN RANGE: the amplitude is {} % of half of the grid; wear is that of cells that stay in place, for amplitudes that are small against the patch",
            number(100.0 * reach, 3)
        ));
    }
    Ok(History {
        motion: Motion::Fretting(end.amplitude[0]),
        grid,
        error_of_grid,
        notes,
        scars,
    })
}

/// Returns notes on the tables that the contacts have left over the cycles.
fn left(setup: &Setup) -> Vec<String> {
    let tables = setup.laws[0].left();
    tables
        .iter()
        .map(|(table, share)| outside(table, *share))
        .collect()
}

/// Why cycles end early.
enum Failed {
    /// The scar reaches the border of the grid.
    Border,
    Other(Error),
}

fn on_grid(
    setup: &Setup,
    drive: &StrokeDrive,
    cycles: &CyclesSpec,
    ejection: Option<f64>,
    grid: CellGrid,
    follow: &mut dyn FnMut(&Scar),
) -> Result<Scar, Failed> {
    let surfaces = Surfaces::new(grid, setup.bodies.elasticity, setup.layer);
    let places = (0..grid.len()).map(|cell| grid.middle(cell));
    let distance: Vec<f64> = places.map(|at| setup.bodies.distance.at(at)).collect();
    let law = &setup.laws[0];
    let course = Cycles {
        surfaces: &surfaces,
        distance: &distance,
        load: setup.load,
        law,
        along: [1.0, 0.0],
        amplitude: drive.amplitude,
        quarter: drive.steps,
        step: drive.step.unwrap_or(1.0),
        ejection,
    };
    let found = course.follow(cycles.count, cycles.error, follow);
    match (law.take_error(), found) {
        (Some(error), _) => Err(Failed::Other(fail(&error))),
        (None, Ok(scar)) => Ok(scar),
        (None, Err(StrokeError::Normal(NormalError::Border))) => Err(Failed::Border),
        (None, Err(error)) => Err(Failed::Other(Error::Failed(error.said()))),
    }
}

/// Returns a larger grid of as many cells.
fn grown(grid: &CellGrid) -> CellGrid {
    let by = [0, 1].map(|k| if grid.cells[k] > 1 { GROWTH.0 } else { 1.0 });
    let middle = [0, 1].map(|k| grid.from[k] + 0.5 * grid.extent()[k]);
    let size = [0, 1].map(|k| grid.size[k] * by[k]);
    CellGrid {
        from: [0, 1].map(|k| middle[k] - 0.5 * size[k] * grid.cells[k] as f64),
        size,
        cells: grid.cells,
    }
}
