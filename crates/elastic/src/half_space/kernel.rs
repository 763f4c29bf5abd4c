//! Influence of loads on a regular grid of cells: it depends only on the distance of two cells, so
//! that one number per distance is stored, and the displacement due to many loads is a convolution.

use super::grid::CellGrid;
use super::influence::{Influence, rectangle, strip, uniform, wave};
use super::transforms::{Transforms, padded_length};
use crate::material::Elasticity;
use rustfft::num_complex::Complex64;
use std::sync::OnceLock;

/// Extent of a half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// Infinite, without load outside its cells. In the plane displacements are relative to this
    /// depth (m); in space to infinity.
    Infinite(f64),
    /// Periodic, with the extent of the cells; displacements are relative to this depth (m).
    Periodic(f64),
}

/// Influences by distance in cells.
#[derive(Debug)]
pub struct Kernel {
    dimension: usize,
    cells: [usize; 2],
    periodic: bool,
    /// Size of the table along x and y: twice that of the grid, or that of a period.
    table: [usize; 2],
    influence: Vec<Influence>,
    spectrum: OnceLock<Vec<[[Complex64; 3]; 3]>>,
    transforms: Transforms,
}

impl Kernel {
    /// Creates the kernel of a grid, with the displacement at positions that lie `shift` (m) along
    /// x from the middles of cells.
    pub fn new(
        grid: &CellGrid,
        material: &Elasticity,
        reach: Reach,
        dimension: usize,
        shift: f64,
    ) -> Self {
        let periodic = matches!(reach, Reach::Periodic(_));
        let table = grid.cells.map(|n| match n {
            n if periodic => n,
            n => padded_length(n),
        });
        let transforms = Transforms::new(table);
        let influence = match reach {
            Reach::Infinite(depth) => closed_forms(grid, material, dimension, depth, table, shift),
            Reach::Periodic(depth) => waves(grid, material, dimension, depth, &transforms, shift),
        };
        Self {
            dimension,
            cells: grid.cells,
            periodic,
            table,
            influence,
            spectrum: OnceLock::new(),
            transforms,
        }
    }

    /// Returns the displacement of a cell due to a force on another (m/N; m per N/m in the plane),
    /// with the inward normal as last axis.
    pub fn between(&self, at: usize, load: usize) -> &Influence {
        let columns = self.cells[0];
        let place = |cell: usize| [cell % columns, cell / columns];
        let [a, b] = [place(at), place(load)];
        let [i, j] = [0, 1].map(|k| (a[k] + self.table[k] - b[k]) % self.table[k]);
        &self.influence[j * self.table[0] + i]
    }

    /// Returns the displacements due to forces on all cells: `[a][cell]` along each axis.
    pub fn displacements(&self, forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let loaded: Vec<usize> = (0..forces[0].len())
            .filter(|c| forces.iter().any(|f| f[*c] != 0.0))
            .collect();
        // By measurement a pair of cells takes some ten times as long as an entry times a bit of a
        // transform, of which there are 2 D: 8 in the plane, 12 to 23 in space.
        let size = self.table[0] * self.table[1];
        let bits = usize::BITS - size.leading_zeros();
        if 10 * loaded.len() * forces[0].len() < 2 * self.dimension * size * bits as usize {
            self.sum(forces, &loaded)
        } else {
            self.convolve(forces)
        }
    }

    fn sum(&self, forces: &[Vec<f64>], loaded: &[usize]) -> Vec<Vec<f64>> {
        let d = self.dimension;
        let mut out = vec![vec![0.0; forces[0].len()]; d];
        for cell in 0..forces[0].len() {
            let mut sum = [0.0; 3];
            for load in loaded {
                let influence = self.between(cell, *load);
                for (a, sum) in sum.iter_mut().enumerate().take(d) {
                    for (b, force) in forces.iter().enumerate() {
                        *sum += influence[a][b] * force[*load];
                    }
                }
            }
            for (a, out) in out.iter_mut().enumerate() {
                out[cell] = sum[a];
            }
        }
        out
    }

    fn convolve(&self, forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let d = self.dimension;
        let norm = 1.0 / (self.table[0] * self.table[1]) as f64;
        let forces = forces.iter();
        let transformed: Vec<Vec<Complex64>> = forces
            .map(|force| self.transforms.forward(force, self.cells))
            .collect();
        let spectrum = self.spectrum.get_or_init(|| self.transformed());
        (0..d)
            .map(|a| {
                let waves = spectrum.iter().enumerate().map(|(k, s)| {
                    let terms = transformed.iter().zip(s[a]);
                    norm * terms.fold(Complex64::ZERO, |sum, (force, s)| sum + s * force[k])
                });
                self.transforms.backward(waves.collect(), self.cells)
            })
            .collect()
    }

    /// The table in wave numbers.
    fn transformed(&self) -> Vec<[[Complex64; 3]; 3]> {
        let mut out = vec![[[Complex64::ZERO; 3]; 3]; self.transforms.waves().count()];
        for a in 0..self.dimension {
            for b in 0..self.dimension {
                let entries: Vec<f64> = self.influence.iter().map(|i| i[a][b]).collect();
                let waves = self.transforms.forward(&entries, self.table);
                for (out, value) in out.iter_mut().zip(waves) {
                    out[a][b] = value;
                }
            }
        }
        out
    }

    /// Returns the memory of the tables, by distance and by wave number (bytes).
    pub fn bytes(&self) -> usize {
        self.influence.len() * size_of::<Influence>()
            + self.transforms.waves().count() * size_of::<[[Complex64; 3]; 3]>()
    }

    /// Returns the number of floating-point operations of a convolution: a transform of n real
    /// numbers takes some 2.5 n log2(n), and half as many waves have a product of 8 each.
    pub fn operations(&self) -> f64 {
        let (n, d) = (self.influence.len() as f64, self.dimension as f64);
        n * (5.0 * d * n.log2().max(1.0) + 4.0 * d * d)
    }

    /// Whether cells repeat.
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }
}

/// The table of a half-space without end.
fn closed_forms(
    grid: &CellGrid,
    material: &Elasticity,
    dimension: usize,
    depth: f64,
    table: [usize; 2],
    shift: f64,
) -> Vec<Influence> {
    // Distances beyond the middle of the table represent negative ones; distances in between occur
    // for no pair of cells.
    let distance = |k: usize, of: usize| match k {
        k if k < grid.cells[of] => k as f64 * grid.size[of],
        k => (k as f64 - table[of] as f64) * grid.size[of],
    };
    let places = (0..table[0] * table[1]).map(|k| (k % table[0], k / table[0]));
    places
        .map(|(i, j)| {
            let x = distance(i, 0) + shift;
            match dimension {
                2 => strip(material, grid.size[0], depth, x),
                _ => rectangle(material, grid.size, x, distance(j, 1)),
            }
        })
        .collect()
}

/// Returns the table of a half-space with a period, from the waves that fit in it and are longer
/// than two cells.
fn waves(
    grid: &CellGrid,
    material: &Elasticity,
    dimension: usize,
    depth: f64,
    transforms: &Transforms,
    shift: f64,
) -> Vec<Influence> {
    let [columns, rows] = grid.cells;
    let extent = grid.extent();
    let signed = |k: usize, n: usize| match k {
        k if 2 * k > n => k as f64 - n as f64,
        k => k as f64,
    };
    let number =
        |k: usize, of: usize| 2.0 * std::f64::consts::PI * signed(k, grid.cells[of]) / extent[of];
    // The sign of the shortest wave is undetermined: its odd terms are left out.
    let shortest = |k: usize, of: usize| 2 * k == grid.cells[of];
    let spectrum: Vec<[Influence; 2]> = transforms
        .waves()
        .map(|[i, j]| {
            if [i, j] == [0, 0] {
                return [uniform(material, depth, dimension), Influence::default()];
            }
            let k = [number(i, 0), if rows > 1 { number(j, 1) } else { 0.0 }];
            let [mut real, mut imaginary] = wave(material, k, dimension);
            if shortest(i, 0) || (rows > 1 && shortest(j, 1)) {
                imaginary = Influence::default();
                if dimension == 3 {
                    (real[0][1], real[1][0]) = (0.0, 0.0);
                }
            }
            // A wave at x + shift is exp(i k shift) times that at x.
            let phase = Complex64::from_polar(1.0, k[0] * shift);
            let mut turned = [Influence::default(); 2];
            for a in 0..dimension {
                for b in 0..dimension {
                    let value = Complex64::new(real[a][b], imaginary[a][b]) * phase;
                    (turned[0][a][b], turned[1][a][b]) = (value.re, value.im);
                }
            }
            turned
        })
        .collect();
    // A unit force on a cell is a pressure of one over the area of the cell.
    let scale = 1.0 / (grid.area(dimension) * (columns * rows) as f64);
    let mut out = vec![Influence::default(); columns * rows];
    for a in 0..dimension {
        for b in 0..dimension {
            let waves = spectrum.iter();
            let waves = waves.map(|s| scale * Complex64::new(s[0][a][b], s[1][a][b]));
            let values = transforms.backward(waves.collect(), grid.cells);
            for (out, value) in out.iter_mut().zip(values) {
                out[a][b] = value;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Elasticity = Elasticity {
        young: 210e9,
        poisson: 0.3,
        density: 7800.0,
    };

    fn grid(cells: [usize; 2]) -> CellGrid {
        CellGrid {
            from: [0.0; 2],
            size: [1e-3, 2e-3],
            cells,
        }
    }

    /// Sums over pairs of cells and convolutions are equal, for any grid.
    #[test]
    fn convolution_is_the_sum() {
        let reaches = [Reach::Infinite(1.0), Reach::Periodic(0.1)];
        for (cells, dimension) in [([13, 1], 2), ([8, 1], 2), ([6, 5], 3), ([4, 8], 3)] {
            for reach in reaches {
                let grid = grid(cells);
                let kernel = Kernel::new(&grid, &STEEL, reach, dimension, 0.0);
                let forces: Vec<Vec<f64>> = (0..dimension)
                    .map(|a| {
                        let one = |c: usize| ((c * (a + 3)) as f64).sin();
                        (0..grid.len()).map(one).collect()
                    })
                    .collect();
                let all: Vec<usize> = (0..grid.len()).collect();
                let (one, other) = (kernel.sum(&forces, &all), kernel.convolve(&forces));
                for (one, other) in one.iter().flatten().zip(other.iter().flatten()) {
                    assert!(
                        (one - other).abs() < 1e-13 * one.abs().max(1e-11),
                        "{cells:?} {reach:?}"
                    );
                }
            }
        }
    }

    /// Displacements at places that lie one cell ahead are those of the next cell.
    #[test]
    fn a_shift_by_a_cell_is_the_next_cell() {
        for (cells, dimension) in [
            ([8, 1], 2),
            ([7, 1], 2),
            ([6, 5], 3),
            ([5, 4], 3),
            ([6, 1], 3),
        ] {
            for reach in [Reach::Infinite(1.0), Reach::Periodic(0.1)] {
                let grid = grid(cells);
                let kernel = |shift| Kernel::new(&grid, &STEEL, reach, dimension, shift);
                let (here, ahead) = (kernel(0.0), kernel(grid.size[0]));
                for load in 0..grid.len() {
                    let (one, other) = (ahead.between(0, load), here.between(1, load));
                    for (a, b) in one.iter().flatten().zip(other.iter().flatten()) {
                        assert!(
                            (a - b).abs() < 1e-12 * here.between(0, 0)[0][0].abs(),
                            "{cells:?}"
                        );
                    }
                }
            }
        }
    }

    /// Forces and displacements are reciprocal in the table too.
    #[test]
    fn tables_are_reciprocal() {
        for reach in [Reach::Infinite(1.0), Reach::Periodic(0.1)] {
            let grid = grid([6, 5]);
            let kernel = Kernel::new(&grid, &STEEL, reach, 3, 0.0);
            for (one, other) in [(0, 29), (3, 11), (7, 7)] {
                let (there, back) = (kernel.between(one, other), kernel.between(other, one));
                for a in 0..3 {
                    for b in 0..3 {
                        let off = (there[a][b] - back[b][a]).abs();
                        assert!(off < 1e-13 * there[2][2].abs(), "{reach:?}: {off:e}");
                    }
                }
            }
        }
    }
}
