//! Convolutions over the cells of a patch by Fourier transforms.

use crate::fields::{Field, Vector};
use fretwork_elastic::half_space::{CellGrid, Complex64, Transforms, padded_length};

/// Transforms over a table of twice the size of the grid, so that nothing repeats.
#[derive(Debug)]
pub struct Convolution {
    cells: [usize; 2],
    transforms: Transforms,
}

/// The transform of a table of distances.
pub type Spectrum = Vec<Complex64>;

impl Convolution {
    /// Plans the transforms for a grid.
    pub fn new(grid: &CellGrid) -> Self {
        Self {
            cells: grid.cells,
            transforms: Transforms::new(grid.cells.map(padded_length)),
        }
    }

    /// Returns the transforms of N functions of the distance in cells, of the displaced cell from
    /// the loaded one.
    pub fn spectra<const N: usize>(&self, of: impl Fn([f64; 2]) -> [f64; N]) -> [Spectrum; N] {
        let [columns, rows] = self.transforms.table();
        // Distances beyond the middle of the table represent negative ones.
        let distance = |k: usize, axis: usize, all: usize| match k {
            k if k < self.cells[axis] => k as f64,
            k => k as f64 - all as f64,
        };
        let mut tables = [(); N].map(|()| Vec::with_capacity(columns * rows));
        for j in 0..rows {
            for i in 0..columns {
                let values = of([distance(i, 0, columns), distance(j, 1, rows)]);
                for (table, value) in tables.iter_mut().zip(values) {
                    table.push(value);
                }
            }
        }
        tables.map(|table| self.transforms.forward(&table, [columns, rows]))
    }

    /// Returns N functions of the wave vector (1 per cell, times 2 pi) over the table.
    pub fn waves<const N: usize>(&self, of: impl Fn([f64; 2]) -> [f64; N]) -> [Vec<f64>; N] {
        let [columns, rows] = self.transforms.table();
        let wave = |k: usize, all: usize| {
            let signed = match k {
                k if 2 * k > all => k as f64 - all as f64,
                k => k as f64,
            };
            std::f64::consts::TAU * signed / all as f64
        };
        let mut tables = [(); N].map(|()| Vec::new());
        for [i, j] in self.transforms.waves() {
            let values = of([wave(i, columns), wave(j, rows)]);
            for (table, value) in tables.iter_mut().zip(values) {
                table.push(value);
            }
        }
        tables
    }

    /// Applies a linear map to the transforms of both components of a field; the map has the index
    /// of the wave number.
    pub fn apply(
        &self,
        field: &[Vector],
        map: impl Fn(usize, [Complex64; 2]) -> [Complex64; 2],
    ) -> Field {
        let component = |k: usize| {
            let values: Vec<f64> = field.iter().map(|v| v[k]).collect();
            self.transforms.forward(&values, self.cells)
        };
        let [mut x, mut y] = [0, 1].map(component);
        let norm = self.norm();
        for (k, (x, y)) in x.iter_mut().zip(&mut y).enumerate() {
            [*x, *y] = map(k, [norm * *x, norm * *y]);
        }
        let [x, y] = [x, y].map(|waves| self.transforms.backward(waves, self.cells));
        x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
    }

    /// Returns the convolution of a field of numbers with a table.
    pub fn convolve(&self, values: &[f64], table: &Spectrum) -> Vec<f64> {
        let mut waves = self.transforms.forward(values, self.cells);
        let norm = self.norm();
        for (wave, factor) in waves.iter_mut().zip(table) {
            *wave *= norm * factor;
        }
        self.transforms.backward(waves, self.cells)
    }

    /// What a transform and its inverse have to be multiplied by.
    fn norm(&self) -> f64 {
        1.0 / self.transforms.table().iter().product::<usize>() as f64
    }
}
