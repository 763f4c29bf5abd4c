//! The tangential problem: tractions of cells that stick or slip, by Newton's method on the field.
//!
//! The tractions solve p - proj(p - r S(p)) = 0, where proj shortens a vector to the bound g and r
//! is one over the slip of a cell by its own traction. The derivative is applied by convolution,
//! and its equations are solved by generalised minimal residuals, preconditioned with the stiffness
//! of waves in the part that sticks.

use crate::fields::{Field, Vector, add, dot, length};
use crate::friction::{Bound, Cells, Friction};
use crate::gmres;
use crate::motion::{Motion, rigid_slip};
use crate::surfaces::{Passage, Slip, Surfaces};

/// Tractions and slips.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tractions {
    /// Traction on the first body (Pa).
    pub traction: Field,
    /// Slip of the first body in the step (m).
    pub slip: Field,
    /// Largest traction that the law allows (Pa).
    pub bound: Vec<f64>,
    /// Which cells stick.
    pub sticks: Vec<bool>,
    /// Number of Newton's steps, and of iterations of the linear equations.
    pub iterations: [usize; 2],
    /// Largest residual over the largest bound.
    pub residual: f64,
    /// Whether a cell has a branch of lower friction at the same motion: friction falls faster with
    /// slip than the traction of the cell is relieved by it.
    pub unique: bool,
}

/// Reason why there are no tractions.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TangentialError {
    /// Newton's method did not converge.
    #[error(
        "the tractions did not converge in {steps} steps (residual {residual:.1e} of the largest bound)"
    )]
    NotConverged {
        /// Steps made.
        steps: usize,
        /// Largest residual over the largest bound.
        residual: f64,
    },
}

/// Largest number of Newton's steps: grids of 256 x 256 cells take up to 30.
const MOST: usize = 100;
/// Largest number of iterations of the linear equations in a step.
const INNER: usize = 150;
/// Smallest and largest share to which the linear residual is reduced.
const FORCING: [f64; 2] = [1e-4, 1e-2];
/// Number of times that a step is halved.
const HALVINGS: usize = 6;

/// State of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell {
    Free,
    Sticks,
    /// Slips: direction of p - r S, g over its length, direction of slip, dg/d|S|.
    Slips {
        towards: Vector,
        share: f64,
        slip: Vector,
        slope: f64,
    },
}

/// Tractions with all that follows from them.
struct State {
    traction: Field,
    slip: Field,
    bounds: Vec<Bound>,
    residual: Field,
    cells: Vec<Cell>,
    size: f64,
}

struct Problem<'a> {
    slip: Slip<'a>,
    rigid: Field,
    pressure: &'a [f64],
    cells: Cells<'a>,
    law: &'a dyn Friction,
    /// r (Pa/m).
    scale: f64,
    /// Whether the motion is a shift.
    shifts: bool,
}

impl Problem<'_> {
    fn state(&self, traction: Field) -> State {
        let mut slip = self.slip.by(&traction);
        for ((slip, rigid), p) in slip.iter_mut().zip(&self.rigid).zip(self.pressure) {
            *slip = match *p > 0.0 {
                true => [slip[0] + rigid[0], slip[1] + rigid[1]],
                false => [0.0; 2],
            };
        }
        let bounds = self.law.bounds(self.cells, &slip);
        let mut cells = vec![Cell::Free; slip.len()];
        let mut residual = traction.clone();
        for (k, cell) in cells.iter_mut().enumerate() {
            if self.pressure[k] <= 0.0 {
                continue;
            }
            let (p, s, g) = (traction[k], slip[k], bounds[k].traction);
            let trial = [p[0] - self.scale * s[0], p[1] - self.scale * s[1]];
            let size = length(trial);
            // A cell whose slip turns round in a shift sticks before it slips the other way.
            let turns = self.shifts && p[0] * trial[0] + p[1] * trial[1] < 0.0;
            if size <= g || turns {
                *cell = Cell::Sticks;
                residual[k] = s.map(|s| self.scale * s);
                continue;
            }
            let towards = trial.map(|t| t / size);
            residual[k] = [p[0] - g * towards[0], p[1] - g * towards[1]];
            let slid = length(s);
            *cell = Cell::Slips {
                towards,
                share: g / size,
                slip: match slid > 0.0 {
                    true => s.map(|s| s / slid),
                    false => [0.0; 2],
                },
                slope: bounds[k].slope,
            };
        }
        let size = dot(&residual, &residual).sqrt();
        State {
            traction,
            slip,
            bounds,
            residual,
            cells,
            size,
        }
    }

    /// Applies the derivative of the residual.
    fn derivative(&self, state: &State, change: &[Vector]) -> Field {
        let slip = self.slip.by(change);
        let cells = state.cells.iter().zip(change).zip(slip);
        cells
            .map(|((cell, v), s)| match *cell {
                Cell::Free => *v,
                Cell::Sticks => s.map(|s| self.scale * s),
                Cell::Slips {
                    towards: e,
                    share,
                    slip,
                    slope,
                } => {
                    let trial = [v[0] - self.scale * s[0], v[1] - self.scale * s[1]];
                    let along = trial[0] * e[0] + trial[1] * e[1];
                    let bound = slope * (slip[0] * s[0] + slip[1] * s[1]);
                    let part = |k: usize| v[k] - share * (trial[k] - along * e[k]) - bound * e[k];
                    [part(0), part(1)]
                }
            })
            .collect()
    }

    fn change(&self, state: &State, tolerance: f64) -> (Field, usize) {
        let sticks = |k: usize| state.cells[k] == Cell::Sticks;
        let about_inverse = |v: &[Vector]| {
            let scaled = v.iter().enumerate().map(|(k, v)| match sticks(k) {
                true => v.map(|v| v / self.scale),
                false => *v,
            });
            self.slip.about_inverse(&scaled.collect::<Vec<_>>(), sticks)
        };
        let derivative = |v: &[Vector]| self.derivative(state, v);
        gmres::solve(derivative, about_inverse, &state.residual, tolerance, INNER)
    }
}

/// Returns the tractions in a motion, under pressures (Pa) and a law of friction, at a speed of
/// rolling (m/s); `start` has tractions to begin with. The residual is at most `tolerance` of the
/// largest bound.
///
/// # Errors
/// Newton's method does not converge.
pub fn tangential(
    surfaces: &Surfaces,
    pressure: &[f64],
    motion: &Motion,
    (law, speed): (&dyn Friction, f64),
    start: Option<&[Vector]>,
    tolerance: f64,
) -> Result<Tractions, TangentialError> {
    let slip = surfaces.slip(motion.passage());
    let less = |mut rigid: Field, moved: &[Vector]| {
        add(&mut rigid, -1.0, moved);
        rigid
    };
    let mut rigid = match motion {
        Motion::Steady(creepage) => rigid_slip(&surfaces.grid, creepage),
        Motion::Transient { creepage, from } => less(
            rigid_slip(&surfaces.grid, creepage),
            &surfaces.displacement(from, true),
        ),
        Motion::Shift { by, from } => less(
            vec![*by; pressure.len()],
            &surfaces.displacement(from, false),
        ),
    };
    if surfaces.couple() {
        let moved = surfaces.slip_by_pressure(pressure, motion);
        add(&mut rigid, 1.0, &moved);
    }
    let scale = 1.0 / slip.own;
    let problem = Problem {
        slip,
        rigid,
        pressure,
        cells: Cells {
            grid: &surfaces.grid,
            pressure,
            speed,
        },
        law,
        scale,
        shifts: motion.passage() == Passage::Shift,
    };
    problem.solve(start, tolerance)
}

impl Problem<'_> {
    fn solve(
        &self,
        start: Option<&[Vector]>,
        tolerance: f64,
    ) -> Result<Tractions, TangentialError> {
        let start = match start {
            Some(start) => start.to_vec(),
            None => vec![[0.0; 2]; self.pressure.len()],
        };
        let mut state = self.state(start);
        let mut inner = 0;
        let mut worst = f64::INFINITY;
        for steps in 0..MOST {
            let largest = state.bounds.iter().map(|b| b.traction).fold(0.0, f64::max);
            let residuals = state.residual.iter().map(|r| length(*r));
            worst = match residuals.fold(0.0, f64::max) {
                0.0 => 0.0,
                r => r / largest,
            };
            if worst <= tolerance {
                return Ok(self.done(state, [steps, inner], worst));
            }
            let forcing = (0.3 * worst).clamp(FORCING[0], FORCING[1]);
            let (change, iterations) = self.change(&state, forcing);
            inner += iterations;
            state = self.descend(state, &change);
        }
        Err(TangentialError::NotConverged {
            steps: MOST,
            residual: worst,
        })
    }

    /// Takes the step, halved until the residual decreases; the whole step where it never does.
    fn descend(&self, state: State, change: &[Vector]) -> State {
        let moved = |part: f64| {
            let mut traction = state.traction.clone();
            add(&mut traction, -part, change);
            self.state(traction)
        };
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let next = moved(part);
            if next.size < (1.0 - 1e-4 * part) * state.size {
                return next;
            }
            part *= 0.5;
        }
        moved(1.0)
    }

    fn done(&self, state: State, iterations: [usize; 2], residual: f64) -> Tractions {
        let steep = |k: usize| match state.cells[k] {
            Cell::Slips { slope, .. } => slope * self.slip.own < -1.0,
            _ => false,
        };
        Tractions {
            unique: !(0..state.cells.len()).any(steep),
            bound: state.bounds.iter().map(|b| b.traction).collect(),
            sticks: state.cells.iter().map(|c| *c == Cell::Sticks).collect(),
            traction: state.traction,
            slip: state.slip,
            iterations,
            residual,
        }
    }
}
