//! The normal problem: pressures that keep two surfaces from overlapping.

use crate::surfaces::Surfaces;
use serde::Serialize;

/// Pressures over the cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Pressure {
    /// Pressure of each cell (Pa), 0 without contact.
    pub pressure: Vec<f64>,
    /// Approach of distant points of the bodies (m).
    pub approach: f64,
    /// Number of iterations.
    pub iterations: usize,
}

impl Pressure {
    /// Returns the load (N).
    pub fn load(&self, surfaces: &Surfaces) -> f64 {
        self.pressure.iter().sum::<f64>() * surfaces.grid.area(3)
    }

    /// Returns the largest pressure (Pa).
    pub fn largest(&self) -> f64 {
        self.pressure.iter().copied().fold(0.0, f64::max)
    }
}

/// Reason why there are no pressures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NormalError {
    /// The load is not positive.
    #[error("the load must be positive and finite, got {0} N")]
    Load(f64),
    /// A distance is not a number.
    #[error("the distance of the bodies is not a number in cell {0}")]
    Distance(usize),
    /// The patch touches the border of the grid.
    #[error("the contact reaches the border of the grid: take a larger grid")]
    Border,
    /// The iteration did not end.
    #[error(
        "the pressures did not converge in {iterations} iterations (change {change:.1e}): the distance of the bodies may be rougher than the cells resolve"
    )]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// Relative change of the pressures in the last one.
        change: f64,
    },
}

/// Largest number of iterations: a smooth patch takes 30 to 100.
const MOST: usize = 2000;
/// Relative change of the pressures at which the iteration ends.
const TOLERANCE: f64 = 1e-10;

/// Returns the pressures under a load (N) of bodies at an undeformed distance (m), one number per
/// cell; `start` has pressures to begin with.
///
/// # Errors
/// The load is not positive, a distance is not a number, the patch reaches the border of the grid,
/// or there is no convergence.
pub fn normal(
    surfaces: &Surfaces,
    distance: &[f64],
    load: f64,
    start: Option<&[f64]>,
) -> Result<Pressure, NormalError> {
    wearing(surfaces, distance, load, None, start)
}

/// Returns the pressures of bodies that wear under them: `worn` has, for each row of cells, the
/// depth that goes by one pascal in one of its cells (m/Pa), which adds to the distance of the
/// whole row. By conjugate gradients (I. A. Polonsky, L. M. Keer, Wear 231, 1999), which begin anew
/// where a cell comes into contact.
///
/// # Errors
/// Those of [`normal`].
pub fn wearing(
    surfaces: &Surfaces,
    distance: &[f64],
    load: f64,
    worn: Option<&[f64]>,
    start: Option<&[f64]>,
) -> Result<Pressure, NormalError> {
    let displacement = |pressure: &[f64]| {
        let mut moved = surfaces.normal(pressure);
        let columns = surfaces.grid.cells[0];
        for (row, depth) in worn.into_iter().flatten().enumerate() {
            let cells = row * columns..(row + 1) * columns;
            let sum: f64 = pressure[cells.clone()].iter().sum();
            moved[cells].iter_mut().for_each(|u| *u += depth * sum);
        }
        moved
    };
    solve(surfaces, distance, load, &displacement, start)
}

/// Returns the pressures of bodies that wear under them where they are: `worn` has the depth that
/// goes by one pascal in each cell (m/Pa).
///
/// # Errors
/// Those of [`normal`].
pub fn wearing_in_place(
    surfaces: &Surfaces,
    distance: &[f64],
    load: f64,
    worn: &[f64],
    start: Option<&[f64]>,
) -> Result<Pressure, NormalError> {
    let displacement = |pressure: &[f64]| {
        let mut moved = surfaces.normal(pressure);
        let cells = moved.iter_mut().zip(worn.iter().zip(pressure));
        cells.for_each(|(u, (depth, p))| *u += depth * p);
        moved
    };
    solve(surfaces, distance, load, &displacement, start)
}

fn solve(
    surfaces: &Surfaces,
    distance: &[f64],
    load: f64,
    displacement: &dyn Fn(&[f64]) -> Vec<f64>,
    start: Option<&[f64]>,
) -> Result<Pressure, NormalError> {
    if !(load > 0.0 && load.is_finite()) {
        return Err(NormalError::Load(load));
    }
    if let Some(cell) = distance.iter().position(|h| !h.is_finite()) {
        return Err(NormalError::Distance(cell));
    }
    let (n, area) = (distance.len(), surfaces.grid.area(3));
    let scale = |p: &mut [f64]| {
        let factor = load / (p.iter().sum::<f64>() * area);
        p.iter_mut().for_each(|p| *p *= factor);
    };
    let mut p = match start {
        Some(start) if start.iter().any(|p| *p > 0.0) => start.to_vec(),
        _ => vec![1.0; n],
    };
    scale(&mut p);
    let mut direction = vec![0.0; n];
    let (mut before, mut restart) = (1.0, true);
    let mut change = f64::INFINITY;
    for iterations in 1..=MOST {
        let touches: Vec<bool> = p.iter().map(|p| *p > 0.0).collect();
        // The gap over the touching cells, less its mean, the approach.
        let level = |values: &mut [f64]| {
            let touching = || touches.iter().zip(&*values).filter(|(t, _)| **t);
            let mean = touching().map(|(_, v)| v).sum::<f64>() / touching().count().max(1) as f64;
            values.iter_mut().for_each(|v| *v -= mean);
            mean
        };
        let mut gap = displacement(&p);
        gap.iter_mut().zip(distance).for_each(|(g, h)| *g += h);
        let approach = level(&mut gap);
        let over = |a: &[f64], b: &[f64]| -> f64 {
            let cells = touches.iter().zip(a.iter().zip(b));
            cells.filter(|(t, _)| **t).map(|(_, (a, b))| a * b).sum()
        };
        let now = over(&gap, &gap);
        let conjugate = if restart { 0.0 } else { now / before };
        before = now;
        for cell in 0..n {
            direction[cell] = match touches[cell] {
                true => gap[cell] + conjugate * direction[cell],
                false => 0.0,
            };
        }
        let mut moved = displacement(&direction);
        level(&mut moved);
        let curvature = over(&moved, &direction);
        let length = match curvature > 0.0 {
            true => over(&gap, &direction) / curvature,
            false => 0.0,
        };
        let old = p.clone();
        restart = false;
        for cell in 0..n {
            p[cell] = (p[cell] - length * direction[cell]).max(0.0);
            if p[cell] == 0.0 && gap[cell] < 0.0 {
                p[cell] = -length * gap[cell];
                restart = true;
            }
        }
        scale(&mut p);
        change = p.iter().zip(&old).map(|(a, b)| (a - b).abs()).sum::<f64>() * area / load;
        if change < TOLERANCE {
            if surfaces.grid.on_border(&p) {
                return Err(NormalError::Border);
            }
            return Ok(Pressure {
                pressure: p,
                approach,
                iterations,
            });
        }
    }
    Err(NormalError::NotConverged {
        iterations: MOST,
        change,
    })
}
