//! The cells of the surface of a half-space.

use fretwork_core::geometry::space::{Space, VectorLike};

/// Equal cells in a rectangle (an interval in the plane).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellGrid {
    /// Lowest corner (m), along x and y.
    pub from: [f64; 2],
    /// Sides of a cell (m).
    pub size: [f64; 2],
    /// Number of cells along x and along y: one along y in the plane.
    pub cells: [usize; 2],
}

impl CellGrid {
    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Returns whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns column and row of a cell.
    pub fn place(&self, cell: usize) -> [usize; 2] {
        [cell % self.cells[0], cell / self.cells[0]]
    }

    /// The cell in a column and a row.
    pub fn cell(&self, [i, j]: [usize; 2]) -> usize {
        j * self.cells[0] + i
    }

    /// Returns the middle of a cell (m).
    pub fn middle(&self, cell: usize) -> [f64; 2] {
        let [i, j] = self.place(cell);
        [
            self.from[0] + (i as f64 + 0.5) * self.size[0],
            self.from[1] + (j as f64 + 0.5) * self.size[1],
        ]
    }

    /// Returns the area of a cell (m^2; its width in the plane, m).
    pub fn area(&self, dimension: usize) -> f64 {
        self.size[..dimension - 1].iter().product()
    }

    /// Returns whether one of these numbers, one per cell, is positive on the border (3D). A single
    /// row or column has its border at its ends.
    pub fn on_border(&self, values: &[f64]) -> bool {
        let border = |cell: usize| {
            let place = self.place(cell);
            (0..2).any(|k| {
                let last = self.cells[k] - 1;
                last > 0 && (place[k] == 0 || place[k] == last)
            })
        };
        (0..self.len()).any(|cell| values[cell] > 0.0 && border(cell))
    }

    /// Returns the lengths of the sides of the grid (m).
    pub fn extent(&self) -> [f64; 2] {
        [0, 1].map(|k| self.cells[k] as f64 * self.size[k])
    }

    /// Returns the facets between the middles of cells, anticlockwise seen from above (3D).
    pub fn facets(&self, dimension: usize) -> Vec<[u32; 3]> {
        let [columns, rows] = self.cells;
        if dimension == 2 {
            return (0..columns as u32 - 1).map(|k| [k, k + 1, 0]).collect();
        }
        let mut out = Vec::new();
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let at = |di, dj| self.cell([i + di, j + dj]) as u32;
                out.push([at(0, 0), at(1, 0), at(1, 1)]);
                out.push([at(0, 0), at(1, 1), at(0, 1)]);
            }
        }
        out
    }

    /// Returns the cells around a position and their weights, by the shape functions of the facets;
    /// clamped to the grid, or along x wrapped into it where it is periodic (2D).
    pub fn weights<S: Space>(&self, at: &S::Vector, repeats: bool) -> Vec<(u32, f64)> {
        if repeats {
            let s = (at[0] - self.from[0]) / self.size[0] - 0.5;
            let cells = self.cells[0] as f64;
            let (lower, part) = (s.floor(), s - s.floor());
            let cell = |s: f64| (s.rem_euclid(cells) as u32).min(self.cells[0] as u32 - 1);
            return vec![(cell(lower), 1.0 - part), (cell(lower + 1.0), part)];
        }
        let along = |k: usize| {
            let s = (at[k] - self.from[k]) / self.size[k] - 0.5;
            let last = self.cells[k] - 1;
            let lower = (s.max(0.0) as usize).min(last.saturating_sub(1));
            (lower, (s - lower as f64).clamp(0.0, 1.0))
        };
        let (i, s) = along(0);
        if S::Vector::N == 2 {
            return vec![(i as u32, 1.0 - s), (i as u32 + 1, s)];
        }
        let (j, t) = along(1);
        let cell = |di, dj| self.cell([i + di, j + dj]) as u32;
        if s >= t {
            vec![(cell(0, 0), 1.0 - s), (cell(1, 0), s - t), (cell(1, 1), t)]
        } else {
            vec![(cell(0, 0), 1.0 - t), (cell(1, 1), s), (cell(0, 1), t - s)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn weights_interpolate_linear_functions() {
        let grid = CellGrid {
            from: [-1.0, 2.0],
            size: [0.5, 0.25],
            cells: [7, 5],
        };
        let f = |[x, y]: [f64; 2]| 1.0 + 2.0 * x - 3.0 * y;
        for at in [[-0.3, 2.9], [1.9, 2.2], [0.25, 2.375]] {
            let weights = grid.weights::<Dim3>(&Vector3::new(at[0], at[1], 0.1), false);
            let sum: f64 = weights
                .iter()
                .map(|(c, w)| w * f(grid.middle(*c as usize)))
                .sum();
            assert!((sum - f(at)).abs() < 1e-14, "{at:?}: {sum}");
        }
        let line = CellGrid {
            cells: [7, 1],
            ..grid
        };
        let weights = line.weights::<Dim2>(&Vector2::new(9.0, 0.0), false);
        assert_eq!(weights, [(5, 0.0), (6, 1.0)]);
        // The grid is from -1 to 2.5: the last cell and the first meet at 2.5.
        for at in [2.5, -1.0] {
            let weights = line.weights::<Dim2>(&Vector2::new(at, 0.0), true);
            assert_eq!(weights, [(6, 0.5), (0, 0.5)]);
        }
    }
}
