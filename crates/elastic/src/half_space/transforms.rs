//! Discrete Fourier transforms of real values over a table with two axes.

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
pub use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Returns the length of a table in which a convolution over this number of cells does not repeat:
/// at least twice as long, even, and without prime factors above 5, for which transforms are fast.
pub fn padded_length(cells: usize) -> usize {
    let simple = |mut n: usize| {
        for p in [2, 3, 5] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    match cells {
        1 => 1,
        _ => 2 * (cells..).find(|n| simple(*n)).unwrap_or(cells),
    }
}

/// Fourier transforms over a table, not normalised: forward and backward multiply by the number of
/// its entries.
///
/// Values are real, hence the waves along the rows have half the numbers: those of a wave vector
/// (i, j), with i up to half the number of columns, are at `i * rows + j`.
pub struct Transforms {
    table: [usize; 2],
    rows: (Arc<dyn RealToComplex<f64>>, Arc<dyn ComplexToReal<f64>>),
    columns: [Arc<dyn Fft<f64>>; 2],
}

impl std::fmt::Debug for Transforms {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Transforms")
            .field("table", &self.table)
            .finish_non_exhaustive()
    }
}

impl Transforms {
    /// Plans the transforms of a table: number of columns and of rows; entries are row by row.
    pub fn new(table: [usize; 2]) -> Self {
        let [columns, rows] = table;
        let mut real = RealFftPlanner::new();
        let mut planner = FftPlanner::new();
        Self {
            table,
            rows: (
                real.plan_fft_forward(columns),
                real.plan_fft_inverse(columns),
            ),
            columns: [
                planner.plan_fft_forward(rows),
                planner.plan_fft_inverse(rows),
            ],
        }
    }

    /// Returns the number of columns and of rows.
    pub fn table(&self) -> [usize; 2] {
        self.table
    }

    /// Returns the largest number of a wave along the rows.
    fn shortest(&self) -> usize {
        self.table[0] / 2
    }

    /// Iterates over the numbers of all waves along x and y, in order; those of y above half the
    /// number of rows represent negative ones.
    pub fn waves(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let rows = self.table[1];
        let all = (self.shortest() + 1) * rows;
        (0..all).map(move |k| [k / rows, k % rows])
    }

    /// Transforms values to waves. The values fill the first `cells`, columns and rows, of the
    /// table; the others are zero.
    pub fn forward(&self, values: &[f64], cells: [usize; 2]) -> Vec<Complex64> {
        let [columns, rows] = self.table;
        let mut waves = vec![Complex64::ZERO; (self.shortest() + 1) * rows];
        let transform = &self.rows.0;
        let mut row = vec![0.0; columns];
        let mut scratch = transform.make_scratch_vec();
        let mut of_rows = Block::new(self.shortest() + 1);
        for (first, values) in values.chunks(BLOCK * cells[0]).enumerate() {
            for (values, out) in values.chunks(cells[0]).zip(of_rows.rows()) {
                row[..cells[0]].copy_from_slice(values);
                row[cells[0]..].fill(0.0);
                let done = transform.process_with_scratch(&mut row, out, &mut scratch);
                assert!(done.is_ok(), "the lengths are those of the plan");
            }
            let count = values.len() / cells[0];
            of_rows.write_columns(&mut waves, rows, first * BLOCK, count);
        }
        if rows > 1 {
            self.columns[0].process(&mut waves);
        }
        waves
    }

    /// Transforms waves to values, and returns those of the first `cells`, columns and rows, of the
    /// table.
    pub fn backward(&self, mut waves: Vec<Complex64>, cells: [usize; 2]) -> Vec<f64> {
        let [columns, rows] = self.table;
        if rows > 1 {
            self.columns[1].process(&mut waves);
        }
        // Values are real: of the mean, and of the shortest wave, only the real part counts.
        let mut real = |i: usize| {
            waves[i * rows..(i + 1) * rows]
                .iter_mut()
                .for_each(|w| w.im = 0.0)
        };
        real(0);
        if columns.is_multiple_of(2) {
            real(self.shortest());
        }
        let transform = &self.rows.1;
        let mut row = vec![0.0; columns];
        let mut scratch = transform.make_scratch_vec();
        let mut of_rows = Block::new(self.shortest() + 1);
        let mut values = Vec::with_capacity(cells[0] * cells[1]);
        for first in (0..cells[1]).step_by(BLOCK) {
            let count = BLOCK.min(cells[1] - first);
            of_rows.read_columns(&waves, rows, first, count);
            for one in of_rows.rows().take(count) {
                let done = transform.process_with_scratch(one, &mut row, &mut scratch);
                assert!(done.is_ok(), "the lengths are those of the plan");
                values.extend_from_slice(&row[..cells[0]]);
            }
        }
        values
    }
}

/// Number of rows that are turned into columns together, so that both stay within a processor's
/// cache.
const BLOCK: usize = 16;

/// Some successive rows of waves.
struct Block {
    length: usize,
    waves: Vec<Complex64>,
}

impl Block {
    fn new(length: usize) -> Self {
        let waves = vec![Complex64::ZERO; BLOCK * length];
        Self { length, waves }
    }

    fn rows(&mut self) -> impl Iterator<Item = &mut [Complex64]> {
        self.waves.chunks_mut(self.length)
    }

    /// Writes `count` rows into columns of length `rows`, from the row `first`.
    fn write_columns(&self, to: &mut [Complex64], rows: usize, first: usize, count: usize) {
        for (i, column) in to.chunks_mut(rows).enumerate() {
            let places = column[first..first + count].iter_mut().enumerate();
            places.for_each(|(j, to)| *to = self.waves[j * self.length + i]);
        }
    }

    /// Reads `count` rows from columns of length `rows`, from the row `first`.
    fn read_columns(&mut self, from: &[Complex64], rows: usize, first: usize, count: usize) {
        for (i, column) in from.chunks(rows).enumerate() {
            let places = column[first..first + count].iter().enumerate();
            places.for_each(|(j, from)| self.waves[j * self.length + i] = *from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Waves are the sums of their definition, and the way back returns the values.
    #[test]
    fn waves_are_the_sums_of_their_definition() {
        for (table, cells) in [
            ([8, 6], [8, 6]),
            ([10, 20], [5, 17]),
            ([7, 5], [7, 5]),
            ([7, 6], [4, 6]),
            ([6, 7], [6, 4]),
            ([1, 5], [1, 3]),
            ([12, 1], [6, 1]),
            ([1, 1], [1, 1]),
        ] {
            let transforms = Transforms::new(table);
            let value = |i: usize, j: usize| (1.3 * i as f64 + 0.7 * (j * j) as f64).sin();
            let places = (0..cells[0] * cells[1]).map(|c| (c % cells[0], c / cells[0]));
            let values: Vec<f64> = places.clone().map(|(i, j)| value(i, j)).collect();
            let waves = transforms.forward(&values, cells);
            for ([kx, ky], wave) in transforms.waves().zip(&waves) {
                let phase = |i: usize, j: usize| {
                    let x = (kx * i) as f64 / table[0] as f64;
                    -TAU * (x + (ky * j) as f64 / table[1] as f64)
                };
                let term = |(i, j)| Complex64::from_polar(value(i, j), phase(i, j));
                let sum: Complex64 = places.clone().map(term).sum();
                assert!((sum - wave).norm() < 1e-12, "{table:?} {kx} {ky}");
            }
            let back = transforms.backward(waves, cells);
            let size = (table[0] * table[1]) as f64;
            for (back, value) in back.iter().zip(&values) {
                assert!((back / size - value).abs() < 1e-14, "{table:?}");
            }
        }
    }

    /// Of waves that are those of no real field, the values are the real part of their sum.
    #[test]
    fn values_are_the_real_part_of_all_waves() {
        for table in [[6, 5], [7, 6], [8, 4]] {
            let transforms = Transforms::new(table);
            let wave = |k: usize| Complex64::from_polar(1.0, 0.9 * (k * k) as f64);
            let waves: Vec<Complex64> = (0..transforms.waves().count()).map(wave).collect();
            let found = transforms.backward(waves.clone(), table);
            for (cell, found) in found.iter().enumerate() {
                let (x, y) = (cell % table[0], cell / table[0]);
                let part = |(k, [kx, ky]): (usize, [usize; 2])| {
                    let turn =
                        (kx * x) as f64 / table[0] as f64 + (ky * y) as f64 / table[1] as f64;
                    // A wave along x stands for its opposite too.
                    let count = if kx == 0 || 2 * kx == table[0] {
                        1.0
                    } else {
                        2.0
                    };
                    count * (waves[k] * Complex64::from_polar(1.0, TAU * turn)).re
                };
                let sum: f64 = transforms.waves().enumerate().map(part).sum();
                assert!((sum - found).abs() < 1e-12, "{table:?} {cell}");
            }
        }
    }
}
