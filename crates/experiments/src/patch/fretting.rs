//! Strokes of fretting: the loop of force and displacement, and what slips in it.

use super::answer::{Band, Motion, Point, Wear};
use super::law::{Passage, PatchLaw};
use super::setup::Setup;
use super::spec::{MotionSpec, PatchFile, positive};
use crate::Error;
use fretwork_core::laws::Kind;
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::{Field, Motion as Step, Pressure, Surfaces, Tractions, normal, tangential};
use fretwork_scene::InputError;

/// Residual of the tractions over the largest bound.
const TOLERANCE: f64 = 1e-7;

/// Returns the amplitudes of all points (m), and the number of steps of a quarter of a cycle.
///
/// # Errors
/// A number is out of range.
pub fn amplitudes(file: &PatchFile) -> Result<(Vec<f64>, usize), InputError> {
    let MotionSpec::Fretting { amplitude, steps } = &file.spec.motion else {
        return Ok((Vec::new(), 0));
    };
    let source = &file.source;
    let path = "motion.amplitude";
    let list = amplitude.0.iter().map(|n| positive(source, path, n, "m"));
    let list: Vec<f64> = list.collect::<Result<_, _>>()?;
    if list.is_empty() {
        return Err(source.error_at(path, "there is no amplitude"));
    }
    if !(2..=1000).contains(steps) {
        return Err(source.error_at("motion.steps", "2 to 1000 steps are expected"));
    }
    Ok((list, *steps))
}

/// A solved stroke.
#[derive(Debug)]
pub struct Stroke {
    /// The numbers.
    pub point: Point,
    /// Displacement (m) and force on the first body (N) over the first quarter and a cycle.
    pub curve: Vec<[f64; 2]>,
    /// Pressures.
    pub pressure: Pressure,
    /// Tractions at the end of the stroke.
    pub tractions: Tractions,
    /// Path slipped by each cell in a cycle (m).
    pub path: Vec<f64>,
    /// Depth worn off the interface in a cycle (m).
    pub worn: Vec<f64>,
}

/// Solves strokes of an amplitude (m): loading, then a full cycle.
///
/// # Errors
/// A law fails, or there is no solution.
pub fn solve(setup: &mut Setup, amplitude: f64, steps: usize) -> Result<Stroke, Error> {
    let cells = setup.grid.len();
    for law in &mut setup.laws {
        law.stays(cells);
    }
    let setup = &*setup;
    let mut strokes = setup
        .laws
        .iter()
        .map(|law| of_law(setup, law, amplitude, steps));
    let mut first = strokes
        .next()
        .unwrap_or_else(|| Err(Error::Failed("the patch has no law".into())))?;
    let members: Vec<f64> = strokes
        .map(|s| s.map(|s| s.point.adhesion))
        .collect::<Result<_, _>>()?;
    first.point.adhesion_band = Band::of(first.point.adhesion, &members);
    Ok(first)
}

fn of_law(setup: &Setup, law: &PatchLaw, amplitude: f64, steps: usize) -> Result<Stroke, Error> {
    let fail = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
    let grid = setup.grid;
    let surfaces = Surfaces::new(grid, setup.bodies.elasticity, setup.layer);
    let distance: Vec<f64> = (0..grid.len())
        .map(|c| setup.bodies.distance.at(grid.middle(c)))
        .collect();
    let pressure = normal(&surfaces, &distance, setup.load, None).map_err(|e| fail(&e))?;
    let each = amplitude / steps as f64;
    // The speed at which a step takes as long as the passage by a cell.
    let speed = setup.rolling_speed() * grid.size[0] / each;
    let area = grid.area(3);
    let mut traction: Field = vec![[0.0; 2]; grid.len()];
    let mut curve = vec![[0.0; 2]];
    let mut ever = vec![false; grid.len()];
    let (mut path, mut worn) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
    let (mut dissipated, mut iterations, mut unique) = (0.0, [0; 2], true);
    let mut last = Passage::default();
    let mut found = Tractions::default();
    for step in 0..5 * steps {
        let forth = step < steps || step >= 3 * steps;
        let by = [if forth { each } else { -each }, 0.0];
        let motion = Step::Shift {
            by,
            from: std::mem::take(&mut traction),
        };
        let start = match &motion {
            Step::Shift { from, .. } => Some(&from[..]),
            _ => None,
        };
        let p = &pressure.pressure;
        let solved = tangential(&surfaces, p, &motion, (law, speed), start, TOLERANCE);
        if let Some(error) = law.take_error() {
            return Err(fail(&error));
        }
        found = solved.map_err(|e| fail(&e))?;
        let cells = Cells {
            grid: &grid,
            pressure: p,
            speed,
        };
        let passage = law.passage(cells, &found.slip).map_err(|e| fail(&e))?;
        let force: f64 = found.traction.iter().map(|t| t[0]).sum::<f64>() * area;
        let at = curve[curve.len() - 1][0] + by[0];
        curve.push([at, force]);
        iterations[0] += found.iterations[0];
        iterations[1] += found.iterations[1];
        unique &= found.unique;
        if step >= steps {
            for cell in 0..grid.len() {
                if p[cell] > 0.0 && !found.sticks[cell] {
                    ever[cell] = true;
                    let (t, s) = (found.traction[cell], found.slip[cell]);
                    path[cell] += length(s);
                    dissipated -= (t[0] * s[0] + t[1] * s[1]) * area;
                }
                worn[cell] += passage.worn[cell];
            }
        }
        traction.clone_from(&found.traction);
        last = passage;
    }
    let touching = pressure.pressure.iter().filter(|p| **p > 0.0).count();
    let slips = ever.iter().filter(|e| **e).count();
    let closed = curve[steps..].windows(2);
    let supplied = closed.map(|w| -0.5 * (w[0][1] + w[1][1]) * (w[1][0] - w[0][0]));
    let volume = worn.iter().sum::<f64>() * area;
    let wear = setup.laws[0].interface().law(Kind::WEAR).map(|law| Wear {
        body: "interface".into(),
        law: law.plugin.name.clone(),
        volume,
        depth: worn.iter().copied().fold(0.0, f64::max),
        profile: Vec::new(),
    });
    let force = curve[curve.len() - 1][1];
    let mut notes = Vec::new();
    if !unique {
        notes.push("NOT UNIQUE: friction falls so fast with slip that the contact may jump to lower friction within a stroke".to_owned());
    }
    let time = touching as f64 * 5.0 * amplitude / setup.rolling_speed();
    notes.extend(law.outside(&last, 1, time));
    Ok(Stroke {
        point: Point {
            motion: Motion::Fretting(amplitude),
            force: [force, 0.0],
            adhesion: force.abs() / setup.load,
            adhesion_error: 0.0,
            adhesion_band: None,
            moment: 0.0,
            t_gamma: supplied.sum(),
            dissipation: dissipated,
            resistance: 0.0,
            stuck: 1.0 - slips as f64 / touching as f64,
            slip_speed: None,
            temperature: None,
            wear: wear.into_iter().collect(),
            iterations,
            unique,
            notes,
        },
        curve,
        pressure,
        tractions: found,
        path,
        worn,
    })
}
