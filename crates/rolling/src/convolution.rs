//! Convolutions over the cells of a patch by Fourier transforms: two components at once, as real
//! and imaginary part.

use crate::fields::{Field, Vector};
use fretwork_elastic::half_space::{CellGrid, Complex64, Transforms, smooth};

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
            transforms: Transforms::new(grid.cells.map(|n| smooth(2 * n - 1))),
        }
    }

    /// Returns the number of entries of a table.
    fn size(&self) -> usize {
        self.transforms.table().iter().product()
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
                    table.push(Complex64::from(value));
                }
            }
        }
        tables.map(|mut table| {
            self.transforms.forward(&mut table);
            table
        })
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
        let mut tables = [(); N].map(|()| Vec::with_capacity(columns * rows));
        for j in 0..rows {
            for i in 0..columns {
                let values = of([wave(i, columns), wave(j, rows)]);
                for (table, value) in tables.iter_mut().zip(values) {
                    table.push(value);
                }
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
        let [columns, rows] = self.transforms.table();
        let mut values = vec![Complex64::ZERO; self.size()];
        for (row, out) in field.chunks(self.cells[0]).zip(values.chunks_mut(columns)) {
            for (v, out) in row.iter().zip(out) {
                *out = Complex64::new(v[0], v[1]);
            }
        }
        self.transforms.forward(&mut values);
        let norm = 1.0 / self.size() as f64;
        let half = Complex64::from(0.5 * norm);
        let mut mapped = vec![Complex64::ZERO; values.len()];
        for j in 0..rows {
            let opposite = (rows - j) % rows * columns;
            for i in 0..columns {
                // The transform of a real field at -k is the conjugate of that at k.
                let k = j * columns + i;
                let (a, b) = (values[k], values[opposite + (columns - i) % columns].conj());
                let [x, y] = map(k, [(a + b) * half, (a - b) * half * -Complex64::I]);
                mapped[k] = x + y * Complex64::I;
            }
        }
        self.transforms.backward(&mut mapped);
        let rows = mapped.chunks(columns).take(self.cells[1]);
        rows.flat_map(|row| row[..self.cells[0]].iter().map(|z| [z.re, z.im]))
            .collect()
    }
}
