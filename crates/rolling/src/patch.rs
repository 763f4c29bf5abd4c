//! A patch from its undeformed distance, load and motion, with the error of its grid.

use crate::fields::{Field, Vector, length};
use crate::friction::Friction;
use crate::motion::{Creepage, Motion};
use crate::normal::{NormalError, Pressure, normal};
use crate::surfaces::Surfaces;
use crate::tangential::{TangentialError, Tractions, tangential};
use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use serde::Serialize;

/// Two bodies that touch.
#[derive(Clone, Copy)]
pub struct Patch<'a> {
    /// Elasticity of both bodies.
    pub bodies: [Elasticity; 2],
    /// Thickness over shear modulus of an elastic layer between them (m/Pa).
    pub layer: f64,
    /// Undeformed distance of the bodies at a place (m).
    pub distance: &'a dyn Fn([f64; 2]) -> f64,
    /// Load (N).
    pub load: f64,
}

/// Steady rolling of a patch.
#[derive(Clone, Debug)]
pub struct Rolling {
    /// The cells.
    pub grid: CellGrid,
    /// Pressures.
    pub pressure: Pressure,
    /// Tractions and slips.
    pub tractions: Tractions,
    /// Forces on the first body along x and y (N).
    pub force: Vector,
    /// Moment on it about the normal through the origin (N m).
    pub moment: f64,
    /// Energy dissipated by slip over the distance rolled (N).
    pub dissipation: f64,
    /// Energy supplied by the creepages over the distance rolled (N), T gamma: -(F_x xi + F_y eta +
    /// M_z phi).
    pub t_gamma: f64,
    /// Force against rolling by pressures that are larger on the side on which material enters (N),
    /// the integral of p dh/dx: none for like bodies. With T gamma it is the dissipation, but for
    /// an error that vanishes with the cells.
    pub resistance: f64,
}

/// Results with the error of the grid, from this grid and two of cells twice as large that are half
/// a cell of theirs apart: the patch has its edge at other places of the cells.
#[derive(Clone, Debug)]
pub struct Refined {
    /// On the fine grid.
    pub fine: Rolling,
    /// On the grids of larger cells.
    pub coarse: [Rolling; 2],
    /// Force extrapolated to cells of no size, to first order; of a line that of the fine grid (N).
    pub force: Vector,
    /// Moment on the first body about the normal through the origin (N m), likewise.
    pub moment: Estimate,
    /// Error of the force of the fine grid (N): its difference to the extrapolated one, and half of
    /// the difference of the coarse grids.
    pub error: Vector,
}

impl Refined {
    /// Returns results on a grid with their error, from those on [`coarser`] ones.
    pub(crate) fn of(fine: Rolling, [coarse, other]: [Rolling; 2]) -> Self {
        // In one row the edges of contact and stick go from cell to cell; many rows average that.
        let estimate = match fine.grid.cells[1] {
            1 => Estimate::by_jumps,
            _ => Estimate::of,
        };
        let [x, y] = [0, 1].map(|k| estimate(fine.force[k], [coarse.force[k], other.force[k]]));
        Self {
            moment: estimate(fine.moment, [coarse.moment, other.moment]),
            force: [x.value, y.value],
            error: [x.error, y.error],
            fine,
            coarse: [coarse, other],
        }
    }
}

/// A number with the error of its grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Error of the grid.
    pub error: f64,
}

impl Estimate {
    /// Returns the number extrapolated to cells of no size, to first order, from a fine grid and
    /// two of cells twice as large, half a cell apart. The error is the difference of the fine grid
    /// to it, and half of that of the coarse grids.
    pub fn of(fine: f64, coarse: [f64; 2]) -> Self {
        let change = fine - 0.5 * (coarse[0] + coarse[1]);
        Self {
            value: fine + change,
            error: change.abs() + 0.5 * (coarse[0] - coarse[1]).abs(),
        }
    }

    /// Returns the number extrapolated likewise, with the whole difference of the coarse grids in
    /// its error: for sums whose parts may cancel, in which more is left to chance, and the
    /// extrapolation doubles it.
    pub fn of_sum(fine: f64, coarse: [f64; 2]) -> Self {
        let found = Self::of(fine, coarse);
        Self {
            error: found.error + 0.5 * (coarse[0] - coarse[1]).abs(),
            ..found
        }
    }

    /// Returns the number of a fine grid as it is, with its larger difference to those of two grids
    /// of cells twice as large, half a cell apart, half as large again, and half of that of these:
    /// for numbers of which one of the three may be right by chance, and two may be wrong alike.
    pub fn by_jumps(fine: f64, coarse: [f64; 2]) -> Self {
        let found = Self::beside(fine, coarse);
        Self {
            error: 1.5 * found.error + 0.5 * (coarse[0] - coarse[1]).abs(),
            ..found
        }
    }

    /// Returns the number of a fine grid as it is, with its larger difference to those of two grids
    /// of cells twice as large, half a cell apart, as its error. For numbers that fall faster than
    /// to first order, but by jumps, since the edge of what sticks goes from cell to cell: an
    /// extrapolation would double what is left to chance.
    pub fn beside(fine: f64, coarse: [f64; 2]) -> Self {
        let off = coarse.map(|c| (fine - c).abs());
        Self {
            value: fine,
            error: off[0].max(off[1]),
        }
    }
}

/// Reason why a patch has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// The normal problem.
    #[error(transparent)]
    Normal(#[from] NormalError),
    /// The tangential problem.
    #[error(transparent)]
    Tangential(#[from] TangentialError),
    /// Pressures and tractions of unlike bodies do not settle.
    #[error("pressures and tractions of unlike bodies did not settle in {0} rounds")]
    Coupled(usize),
    /// The law of friction carries less than a force.
    #[error("the patch carries at most {most:.4e} N along the rolling, less than {wanted:.4e} N")]
    Force {
        /// The force (N).
        wanted: f64,
        /// The largest force (N).
        most: f64,
    },
    /// The bodies wear so much that their distance is not known as widely as they touch.
    #[error(
        "after {passages:.3e} passages the patch is {width:.3e} m wide, too much for the shape of the bodies"
    )]
    Wide {
        /// Passages so far.
        passages: f64,
        /// Width of the patch (m).
        width: f64,
    },
    /// The bodies wear so much that the patch leaves every grid.
    #[error(
        "after {0:.3e} passages the patch leaves every grid that is laid around it: the bodies have worn to fit each other"
    )]
    Spread(f64),
}

/// Residual of the tangential problem over the largest bound.
const TOLERANCE: f64 = 1e-7;
/// Largest number of rounds between pressures and tractions, and the change of the pressures over
/// the largest one at which they end.
const ROUNDS: (usize, f64) = (50, 1e-7);
/// Number of cells along a side above which a coarser grid is solved first.
const COARSEST: usize = 24;

impl Patch<'_> {
    /// Solves steady rolling over a grid, at a speed (m/s); grids of many cells begin with the
    /// tractions of a coarser one.
    ///
    /// # Errors
    /// The patch has no solution on this grid.
    pub fn rolls(
        &self,
        grid: CellGrid,
        creepage: &Creepage,
        law: &dyn Friction,
        speed: f64,
    ) -> Result<Rolling, PatchError> {
        let start = match halved(&grid) {
            Some(coarse) => Some(self.rolls(coarse, creepage, law, speed)?),
            None => None,
        };
        self.rolls_from(grid, start.as_ref(), creepage, law, speed)
    }

    /// Solves steady rolling over a grid and over one of cells twice as large.
    ///
    /// # Errors
    /// The patch has no solution on one of the grids, or the number of cells is not even.
    pub fn refined(
        &self,
        grid: CellGrid,
        creepage: &Creepage,
        law: &dyn Friction,
        speed: f64,
    ) -> Result<Refined, PatchError> {
        let [coarse, other] = coarser(&grid);
        let coarse = self.rolls(coarse, creepage, law, speed)?;
        let other = self.rolls_from(other, None, creepage, law, speed)?;
        let fine = self.rolls_from(grid, Some(&coarse), creepage, law, speed)?;
        Ok(Refined::of(fine, [coarse, other]))
    }

    fn rolls_from(
        &self,
        grid: CellGrid,
        coarse: Option<&Rolling>,
        creepage: &Creepage,
        law: &dyn Friction,
        speed: f64,
    ) -> Result<Rolling, PatchError> {
        let surfaces = Surfaces::new(grid, self.bodies, self.layer);
        let distance: Vec<f64> = (0..grid.len())
            .map(|cell| (self.distance)(grid.middle(cell)))
            .collect();
        let start = coarse.map(|c| {
            let pressure = prolonged(&c.pressure.pressure, &grid);
            (pressure, prolonged(&c.tractions.traction, &grid))
        });
        let start = start.as_ref().map(|(p, t)| (&p[..], &t[..]));
        let friction = (law, speed);
        let (pressure, tractions) =
            self.steady(&surfaces, &distance, start, creepage, friction, TOLERANCE)?;
        let mut rolling = Rolling::new(grid, pressure, tractions, creepage);
        rolling.resistance = self.resistance(&surfaces, &rolling.pressure.pressure);
        Ok(rolling)
    }

    /// Returns the force against rolling by pressures on the surfaces, the integral of p dh/dx (N).
    /// It is 0 for like bodies, whose pressures follow the distance alone: the sum over cells would
    /// have the error of the grid.
    pub(crate) fn resistance(&self, surfaces: &Surfaces, pressure: &[f64]) -> f64 {
        if !surfaces.couple() {
            return 0.0;
        }
        let grid = &surfaces.grid;
        let half = 0.5 * grid.size[0];
        let slope = |[x, y]: [f64; 2]| {
            ((self.distance)([x + half, y]) - (self.distance)([x - half, y])) / (2.0 * half)
        };
        let cells = pressure.iter().enumerate();
        let sum: f64 = cells.map(|(cell, p)| p * slope(grid.middle(cell))).sum();
        sum * grid.area(3)
    }

    /// Solves steady rolling of surfaces at a distance (m), with pressures and tractions to begin
    /// with, under a law of friction at a speed (m/s), to a residual of the tangential problem.
    ///
    /// # Errors
    /// There is no solution.
    pub(crate) fn steady(
        &self,
        surfaces: &Surfaces,
        distance: &[f64],
        start: Option<(&[f64], &[Vector])>,
        creepage: &Creepage,
        law: (&dyn Friction, f64),
        tolerance: f64,
    ) -> Result<(Pressure, Tractions), PatchError> {
        let mut pressure = normal(surfaces, distance, self.load, start.map(|s| s.0))?;
        let motion = Motion::Steady(*creepage);
        let solve = |pressure: &Pressure, start: Option<&[Vector]>| {
            let p = &pressure.pressure;
            tangential(surfaces, p, &motion, law, start, tolerance)
        };
        let mut tractions = solve(&pressure, start.map(|s| s.1))?;
        if !surfaces.couple() {
            return Ok((pressure, tractions));
        }
        for _ in 0..ROUNDS.0 {
            let opened = surfaces.normal_by_traction(&tractions.traction);
            let gap: Vec<f64> = distance.iter().zip(opened).map(|(h, u)| h + u).collect();
            let next = normal(surfaces, &gap, self.load, Some(&pressure.pressure))?;
            let pairs = next.pressure.iter().zip(&pressure.pressure);
            let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            pressure = next;
            tractions = solve(&pressure, Some(&tractions.traction))?;
            if change <= ROUNDS.1.max(tolerance) * pressure.largest() {
                return Ok((pressure, tractions));
            }
        }
        Err(PatchError::Coupled(ROUNDS.0))
    }
}

impl Rolling {
    pub(crate) fn new(
        grid: CellGrid,
        pressure: Pressure,
        tractions: Tractions,
        creepage: &Creepage,
    ) -> Self {
        let area = grid.area(3);
        let (mut force, mut moment, mut dissipation) = ([0.0; 2], 0.0, 0.0);
        for (cell, (p, s)) in tractions.traction.iter().zip(&tractions.slip).enumerate() {
            let [x, y] = grid.middle(cell);
            force = [force[0] + p[0] * area, force[1] + p[1] * area];
            moment += (x * p[1] - y * p[0]) * area;
            dissipation -= (p[0] * s[0] + p[1] * s[1]) * area / grid.size[0];
        }
        let t_gamma =
            -(force[0] * creepage.along + force[1] * creepage.across + moment * creepage.spin);
        Self {
            grid,
            pressure,
            tractions,
            force,
            moment,
            dissipation,
            t_gamma,
            resistance: 0.0,
        }
    }

    /// Returns the slips with which the cells dissipate what creepages and resistance supply (m).
    /// Slip is largest at the trailing edge, where pressures end within a cell: what the cells
    /// dissipate by themselves misses a part of the first order of their size, more than a third of
    /// it where nearly all sticks.
    pub fn wearing_slip(&self) -> Field {
        let supplied = self.t_gamma + self.resistance;
        balanced(&self.tractions.slip, supplied, self.dissipation)
    }

    /// Returns the adhesion: the force over the load.
    pub fn adhesion(&self) -> f64 {
        let load = self.pressure.pressure.iter().sum::<f64>() * self.grid.area(3);
        length(self.force) / load
    }
}

/// Returns slips by a factor with which they dissipate what is supplied (N).
pub(crate) fn balanced(slip: &[Vector], supplied: f64, dissipated: f64) -> Field {
    let factor = match supplied > 0.0 && dissipated > 0.0 {
        true => supplied / dissipated,
        false => 1.0,
    };
    slip.iter().map(|s| s.map(|s| factor * s)).collect()
}

/// Returns a grid of cells twice as large, for even numbers of cells that are not few.
fn halved(grid: &CellGrid) -> Option<CellGrid> {
    let sides = || grid.cells.iter().filter(|n| **n > 1);
    let even = sides().all(|n| n.is_multiple_of(2));
    let many = sides().all(|n| *n >= 2 * COARSEST) && sides().next().is_some();
    (even && many).then(|| twice(grid))
}

/// Returns two grids of cells twice as large, half a cell of theirs apart, for the error of a grid.
pub fn coarser(grid: &CellGrid) -> [CellGrid; 2] {
    let coarse = twice(grid);
    [coarse, displaced(&coarse)]
}

/// Returns a grid of the same extent with half the number of cells along each side, rounded up.
fn twice(grid: &CellGrid) -> CellGrid {
    let cells = grid.cells.map(|n| n.div_ceil(2));
    CellGrid {
        from: grid.from,
        size: [0, 1].map(|k| grid.extent()[k] / cells[k] as f64),
        cells,
    }
}

/// Returns a grid that begins half a cell before another one, and is a cell larger, along each side
/// of more than one cell.
fn displaced(grid: &CellGrid) -> CellGrid {
    let more = grid.cells.map(|n| usize::from(n > 1));
    CellGrid {
        from: [0, 1].map(|k| grid.from[k] - 0.5 * more[k] as f64 * grid.size[k]),
        size: grid.size,
        cells: [0, 1].map(|k| grid.cells[k] + more[k]),
    }
}

/// Returns the values of a coarser grid of the same extent at the cells of a grid.
fn prolonged<T: Copy>(values: &[T], grid: &CellGrid) -> Vec<T> {
    let coarse = twice(grid).cells;
    (0..grid.len())
        .map(|cell| {
            let place = grid.place(cell);
            let [i, j] = [0, 1].map(|k| place[k] * coarse[k] / grid.cells[k]);
            values[j * coarse[0] + i]
        })
        .collect()
}
