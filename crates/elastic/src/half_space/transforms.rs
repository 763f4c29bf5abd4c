//! Discrete Fourier transforms over a table with two axes.

pub use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Returns the next number without prime factors above 5, for which transforms are fast.
pub fn smooth(from: usize) -> usize {
    let simple = |mut n: usize| {
        for p in [2, 3, 5] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    (from..).find(|n| simple(*n)).unwrap_or(from)
}

/// Fourier transforms over a table, not normalised: forward and backward multiply by the number of
/// its entries.
pub struct Transforms {
    table: [usize; 2],
    forward: [Arc<dyn Fft<f64>>; 2],
    backward: [Arc<dyn Fft<f64>>; 2],
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
        let mut planner = FftPlanner::new();
        Self {
            table,
            forward: table.map(|n| planner.plan_fft_forward(n)),
            backward: table.map(|n| planner.plan_fft_inverse(n)),
        }
    }

    /// Returns the number of columns and of rows.
    pub fn table(&self) -> [usize; 2] {
        self.table
    }

    /// Transforms values to wave numbers, in place.
    pub fn forward(&self, values: &mut [Complex64]) {
        self.both(&self.forward, values);
    }

    /// Transforms wave numbers to values, in place.
    pub fn backward(&self, values: &mut [Complex64]) {
        self.both(&self.backward, values);
    }

    /// Transforms along the rows, then along the columns.
    fn both(&self, transforms: &[Arc<dyn Fft<f64>>; 2], values: &mut [Complex64]) {
        let [columns, rows] = self.table;
        transforms[0].process(values);
        if rows == 1 {
            return;
        }
        let mut turned = vec![Complex64::ZERO; values.len()];
        transpose(values, &mut turned, [columns, rows]);
        transforms[1].process(&mut turned);
        transpose(&turned, values, [rows, columns]);
    }
}

/// Writes columns as rows, block by block, which stays within a processor's cache.
fn transpose(from: &[Complex64], to: &mut [Complex64], [columns, rows]: [usize; 2]) {
    const BLOCK: usize = 16;
    for j0 in (0..rows).step_by(BLOCK) {
        for i0 in (0..columns).step_by(BLOCK) {
            for j in j0..(j0 + BLOCK).min(rows) {
                for i in i0..(i0 + BLOCK).min(columns) {
                    to[i * rows + j] = from[j * columns + i];
                }
            }
        }
    }
}
