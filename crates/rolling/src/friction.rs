//! The law of friction of a patch: the largest traction of each cell.

use crate::fields::{Vector, length};
use fretwork_elastic::half_space::CellGrid;

/// Largest traction of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// g (Pa).
    pub traction: f64,
    /// Its derivative by the slip of the cell, dg/d|S| (Pa/m).
    pub slope: f64,
}

/// Cells of a patch, in rows along the rolling.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// The grid.
    pub grid: &'a CellGrid,
    /// Pressure of each cell (Pa).
    pub pressure: &'a [f64],
    /// Speed of rolling (m/s), with which a slip of S in a passage by a cell has the velocity S
    /// V/dx.
    pub speed: f64,
}

/// A law of friction.
pub trait Friction {
    /// Returns the bounds for slips of the cells in a step (m). Material enters each row at its
    /// last cell.
    fn bounds(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<Bound>;

    /// Returns whether bounds depend on the pressure of a cell alone: not on its slip, nor on what
    /// was before.
    fn constant(&self) -> bool {
        false
    }

    /// Begins with new contacts in a number of cells, where material stays in its cell.
    fn renew(&self, _cells: usize) {}

    /// Ends a step in which the cells slipped (m): what stays with the material of a cell goes on.
    /// Returns the depth worn off each cell (m), or nothing without wear.
    fn passed(&self, _cells: Cells<'_>, _slip: &[Vector]) -> Vec<f64> {
        Vec::new()
    }

    /// Returns what stays with the material, a list of numbers for each cell.
    fn carried(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Goes on from what stays with the material, in the form of [`carried`](Self::carried).
    fn carry(&self, _state: &[Vec<f64>]) {}

    /// Takes the debris between the bodies in each cell, volume over area (m).
    fn cover(&self, _debris: &[f64]) {}
}

/// Coulomb's law, g = mu p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb(
    /// Coefficient of friction.
    pub f64,
);

impl Friction for Coulomb {
    fn bounds(&self, cells: Cells<'_>, _: &[Vector]) -> Vec<Bound> {
        let bound = |p: &f64| Bound {
            traction: self.0 * p,
            slope: 0.0,
        };
        cells.pressure.iter().map(bound).collect()
    }

    fn constant(&self) -> bool {
        true
    }
}

/// Friction that falls with the velocity of slip s, mu = kinetic + (static - kinetic) 2^(-s/half),
/// and follows it over a length of slip (E. A. H. Vollebregt, H. M. Schuttelaars, Journal of Sound
/// and Vibration 331, 2012: without the length a patch may have no solution, or several).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falling {
    /// Coefficient without slip.
    pub at_rest: f64,
    /// Coefficient at high velocity.
    pub kinetic: f64,
    /// Velocity at which half of the difference is left (m/s).
    pub half: f64,
    /// Length of slip over which friction follows (m).
    pub memory: f64,
}

impl Falling {
    /// Returns the coefficient at a velocity, and its derivative.
    fn at(&self, velocity: f64) -> [f64; 2] {
        let part = (self.at_rest - self.kinetic) * (-velocity / self.half).exp2();
        let rate = -std::f64::consts::LN_2 / self.half;
        [self.kinetic + part, rate * part]
    }
}

impl Friction for Falling {
    fn bounds(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<Bound> {
        let columns = cells.grid.cells[0];
        let per_step = cells.speed / cells.grid.size[0];
        let mut out = vec![Bound::default(); slip.len()];
        for start in (0..slip.len()).step_by(columns) {
            let mut mu = self.at_rest;
            for cell in (start..start + columns).rev() {
                let p = cells.pressure[cell];
                if p <= 0.0 {
                    mu = self.at_rest;
                    continue;
                }
                // d mu/d s = (mu(v) - mu)/d over the slip s of the cell, implicit.
                let slipped = length(slip[cell]);
                let [now, rate] = self.at(slipped * per_step);
                let share = slipped / (slipped + self.memory);
                let part = self.memory / (slipped + self.memory).powi(2);
                let slope = part * (now - mu) + share * rate * per_step;
                mu += share * (now - mu);
                out[cell] = Bound {
                    traction: mu * p,
                    slope: slope * p,
                };
            }
        }
        out
    }
}
