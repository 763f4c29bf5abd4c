//! Stress below a patch: sums over its cells at some depths, by convolution.

use crate::convolution::{Convolution, Spectrum};
use crate::fields::{Field, Vector};
use crate::stress::{Stress, rectangle};
use fretwork_elastic::half_space::{CellGrid, Complex64};

/// A body below its surface, at the middles of the cells and at some depths.
#[derive(Debug)]
pub struct Below {
    /// Cells of the surface.
    pub grid: CellGrid,
    /// Depths (m), 0 at the surface.
    pub depths: Vec<f64>,
    convolution: Convolution,
    /// For each depth, components of the stress by tractions along x, along y and by pressure.
    levels: Vec<[Spectrum; 18]>,
}

/// Pairs of components of a stress, which are transformed together.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [2, 3], [4, 5]];

impl Below {
    /// Prepares a body with a Poisson's ratio.
    pub fn new(grid: CellGrid, poisson: f64, depths: &[f64]) -> Self {
        let convolution = Convolution::new(&grid);
        let level = |depth: &f64| {
            convolution.spectra(|at| {
                let at = [at[0] * grid.size[0], at[1] * grid.size[1], *depth];
                let by = rectangle(poisson, grid.size, at);
                std::array::from_fn(|k| by[k / 6][k % 6])
            })
        };
        Self {
            grid,
            levels: depths.iter().map(level).collect(),
            depths: depths.to_vec(),
            convolution,
        }
    }

    /// Returns the stress at each depth, in each cell, by pressures (Pa, one per cell).
    pub fn by_pressure(&self, pressure: &[f64]) -> Vec<Vec<Stress>> {
        let field: Field = pressure.iter().map(|p| [*p, 0.0]).collect();
        self.all(&field, |level, component, k, [p, _]| {
            level[12 + component][k] * p
        })
    }

    /// Returns the stress at each depth, in each cell, by tractions on this body (Pa, one vector
    /// per cell). Those of [`tangential`](crate::tangential::tangential) act on the first body; the
    /// second one has the opposite tractions, with z into it.
    pub fn by_traction(&self, traction: &[Vector]) -> Vec<Vec<Stress>> {
        self.all(traction, |level, component, k, [x, y]| {
            level[component][k] * x + level[6 + component][k] * y
        })
    }

    /// Returns the stress at each depth, in each cell, by pressures and tractions (Pa).
    pub fn stresses(&self, pressure: &[f64], traction: &[Vector]) -> Vec<Vec<Stress>> {
        let mut sum = self.by_pressure(pressure);
        add(&mut sum, 1.0, &self.by_traction(traction));
        sum
    }

    fn all(
        &self,
        field: &[Vector],
        map: impl Fn(&[Spectrum; 18], usize, usize, [Complex64; 2]) -> Complex64,
    ) -> Vec<Vec<Stress>> {
        let level = |level: &[Spectrum; 18]| {
            let mut out = vec![[0.0; 6]; field.len()];
            for [a, b] in PAIRS {
                let pair = self
                    .convolution
                    .apply(field, |k, f| [map(level, a, k, f), map(level, b, k, f)]);
                for (out, pair) in out.iter_mut().zip(pair) {
                    (out[a], out[b]) = (pair[0], pair[1]);
                }
            }
            out
        };
        self.levels.iter().map(level).collect()
    }
}

/// Adds a multiple of stresses to others, at each depth and in each cell.
pub fn add(to: &mut [Vec<Stress>], factor: f64, other: &[Vec<Stress>]) {
    let levels = to.iter_mut().zip(other);
    for (to, other) in levels.flat_map(|(to, other)| to.iter_mut().zip(other)) {
        (0..6).for_each(|k| to[k] += factor * other[k]);
    }
}
