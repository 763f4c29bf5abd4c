//! Strokes of a fretting patch with the error of its grid.

use crate::fields::{Vector, length};
use crate::fretting::{Amplitude, Fretting, FrettingError, Loop};
use crate::friction::Friction;
use crate::normal::{NormalError, Pressure, normal};
use crate::patch::{Estimate, Patch, coarser};
use crate::surfaces::Surfaces;
use fretwork_elastic::half_space::CellGrid;

/// Strokes to and fro.
#[derive(Clone, Copy)]
pub struct Strokes<'a> {
    /// Law of friction.
    pub law: &'a dyn Friction,
    /// Direction of the motion, of length 1.
    pub along: Vector,
    /// Half of the range.
    pub amplitude: Amplitude,
    /// Steps of a quarter of a cycle.
    pub quarter: usize,
    /// Time of a step (s).
    pub step: f64,
}

/// A cycle on a grid.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// The cells.
    pub grid: CellGrid,
    /// Pressures.
    pub pressure: Pressure,
    /// The first cycle after loading.
    pub cycle: Loop,
    /// About the energy of the slip that the cells miss (J), in a ring thinner than they are.
    pub missed: f64,
}

/// Returns about the energy of a cycle at the edge of the patch (J) where its cells stick, though
/// elastic bodies slip at the edge under the smallest amplitude.
///
/// Near the edge tractions of bodies that stick are as T/sqrt(s), and bounds as K sqrt(s), over the
/// distance s from the edge: slip goes as far as T/K, and its energy per length of the edge is as
/// T³. Of a cell T is known by the share q of its bound g that it carries, so that the energy of a
/// cell of area A and compliance C is as q³ g² C A. With a factor of 1 the energy of a sphere on a
/// flat lies within the error at all small amplitudes (Mindlin, in a test).
fn missed(surfaces: &Surfaces, cycle: &Loop) -> f64 {
    let grid = &surfaces.grid;
    let [from, to] = [0, cycle.traction.len() / 2].map(|k| &cycle.traction[k]);
    let touches = |at: [isize; 2]| {
        let inside = (0..2).all(|k| (0..grid.cells[k] as isize).contains(&at[k]));
        inside && cycle.bound[at[1] as usize * grid.cells[0] + at[0] as usize] > 0.0
    };
    let at_edge = |cell: usize| {
        let [i, j] = grid.place(cell).map(|k| k as isize);
        let across = grid.cells[1] > 1;
        let along = [[i - 1, j], [i + 1, j]];
        let sides = [[i, j - 1], [i, j + 1]];
        !(along.into_iter().all(touches) && (!across || sides.into_iter().all(touches)))
    };
    let cells = (0..grid.len()).filter(|cell| cycle.sticks[*cell] && at_edge(*cell));
    let sum: f64 = cells
        .map(|cell| {
            let range = [0, 1].map(|k| 0.5 * (to[cell][k] - from[cell][k]));
            length(range).powi(3) / cycle.bound[cell]
        })
        .sum();
    sum * surfaces.own_compliance() * grid.area(3)
}

/// A cycle with the error of its grid, the larger difference to two grids of cells twice as large,
/// and of its steps, the difference to half as many on the coarse grid. Force, displacement and
/// energy err to about the second order of the cells, by jumps of the edge of what sticks; the
/// energy also by that of slip in a ring thinner than the cells.
#[derive(Clone, Debug)]
pub struct RefinedStroke {
    /// On the fine grid.
    pub fine: Stroke,
    /// Amplitude of the displacement (m) and of the force (N).
    pub amplitude: [Estimate; 2],
    /// Energy dissipated in the cycle (J).
    pub energy: Estimate,
    /// Half of the width of the loop at no force (m).
    pub opening: Estimate,
    /// Share of the patch that never slips.
    pub stuck: Estimate,
    /// Volume worn in the cycle (m³).
    pub worn: Estimate,
    /// Largest depth worn in the cycle (m).
    pub deepest: Estimate,
}

/// Reason why there is no cycle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StrokeError {
    /// The normal problem.
    #[error(transparent)]
    Normal(#[from] NormalError),
    /// The cycle.
    #[error(transparent)]
    Fretting(#[from] FrettingError),
}

impl Patch<'_> {
    /// Returns both surfaces over a grid, and the pressures.
    ///
    /// # Errors
    /// The load is not held.
    pub fn pressed(&self, grid: CellGrid) -> Result<(Surfaces, Pressure), NormalError> {
        let surfaces = Surfaces::new(grid, self.bodies, self.layer);
        let places = (0..grid.len()).map(|cell| grid.middle(cell));
        let distance: Vec<f64> = places.map(|at| (self.distance)(at)).collect();
        let pressure = normal(&surfaces, &distance, self.load, None)?;
        Ok((surfaces, pressure))
    }

    /// Follows the first loading and a cycle over a grid.
    ///
    /// # Errors
    /// The load is not held, a step has no solution, or friction does not hold the force.
    pub fn frets(&self, grid: CellGrid, strokes: &Strokes<'_>) -> Result<Stroke, StrokeError> {
        let (surfaces, pressure) = self.pressed(grid)?;
        let frets = Fretting {
            surfaces: &surfaces,
            pressure: &pressure.pressure,
            law: strokes.law,
            along: strokes.along,
            step: strokes.step,
        };
        let cycle = frets.cycles(strokes.amplitude, strokes.quarter, 1)?;
        let missed = missed(&surfaces, &cycle);
        Ok(Stroke {
            grid,
            pressure,
            cycle,
            missed,
        })
    }

    /// Follows a cycle over a grid and over two of cells twice as large, half a cell apart, on one
    /// of which in half as many steps too.
    ///
    /// # Errors
    /// Those of [`frets`](Self::frets) on one of the grids.
    pub fn frets_refined(
        &self,
        grid: CellGrid,
        strokes: &Strokes<'_>,
    ) -> Result<RefinedStroke, StrokeError> {
        let [coarse, other] = coarser(&grid);
        let coarse = self.frets(coarse, strokes)?;
        let other = self.frets(other, strokes)?;
        // Steps matter to all laws: tractions across the motion, of Poisson's ratio, turn with
        // them.
        let slower = match strokes.quarter < 2 {
            true => None,
            false => {
                let quarter = strokes.quarter / 2;
                let longer = strokes.quarter as f64 / quarter as f64;
                let fewer = Strokes {
                    quarter,
                    step: strokes.step * longer,
                    ..*strokes
                };
                Some(self.frets(coarse.grid, &fewer)?)
            }
        };
        let fine = self.frets(grid, strokes)?;
        type Rule = fn(f64, [f64; 2]) -> Estimate;
        let estimated = |rule: Rule, of: &dyn Fn(&Stroke) -> f64| {
            let mut found = rule(of(&fine), [of(&coarse), of(&other)]);
            let by_steps = slower.as_ref().map(|s| (of(s) - of(&coarse)).abs());
            found.error += by_steps.unwrap_or(0.0);
            found
        };
        let estimate = |of: &dyn Fn(&Stroke) -> f64| estimated(Estimate::beside, of);
        let energy = estimated(Estimate::by_jumps, &|s| s.cycle.energy);
        let volume = |s: &Stroke| s.cycle.worn.iter().sum::<f64>() * s.grid.area(3);
        Ok(RefinedStroke {
            amplitude: [0, 1].map(|k| estimate(&|s| s.cycle.amplitude[k])),
            energy: Estimate {
                value: energy.value.max(0.0),
                error: energy.error + fine.missed,
            },
            opening: estimate(&|s| s.cycle.opening),
            stuck: estimate(&|s| s.cycle.stuck),
            worn: estimate(&volume),
            deepest: estimate(&|s| s.cycle.worn.iter().copied().fold(0.0, f64::max)),
            fine,
        })
    }
}
