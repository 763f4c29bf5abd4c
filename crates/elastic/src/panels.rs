//! Solutions with a sparse Cholesky factor L by panels: up to four columns of L with the same rows
//! below their diagonal, such as those of the coordinates of a point. A row of a panel is read at
//! once, with one index for its entries; column by column, the same factor takes twice the time,
//! and a step of a body of finite elements has two solutions.
//!
//! Source: T. A. Davis, "Direct Methods for Sparse Linear Systems" (2006), sections 3.2 and 4.8
//! (supernodes).

use std::ops::Range;

/// Largest number of columns of a panel: more columns did not save time.
const WIDEST: usize = 4;

/// The pattern of a factor by panels.
#[derive(Clone, Debug, Default)]
pub struct Panels {
    panels: Vec<Panel>,
    /// Rows below the diagonal blocks, panel by panel.
    rows: Vec<u32>,
    /// Number of values: for each panel the triangle of its diagonal block row by row, then its
    /// other rows.
    values: usize,
}

/// Columns that share their rows.
#[derive(Clone, Copy, Debug)]
struct Panel {
    first: u32,
    width: u32,
    /// Start of its rows and of its values.
    rows: u32,
    values: u32,
}

impl Panels {
    /// Builds the panels of a factor in compressed columns, in which the diagonal comes first;
    /// `None` where it has too many values.
    pub fn new(starts: &[u32], rows: &[u32]) -> Option<Self> {
        u32::try_from(rows.len()).ok()?;
        let n = starts.len() - 1;
        let column = |c: usize| &rows[starts[c] as usize..starts[c + 1] as usize];
        let mut out = Self::default();
        let mut first = 0;
        while first < n {
            let mut width = 1;
            while width < WIDEST
                && first + width < n
                && column(first + width - 1)[1..] == *column(first + width)
            {
                width += 1;
            }
            let below = &column(first + width - 1)[1..];
            out.panels.push(Panel {
                first: first as u32,
                width: width as u32,
                rows: out.rows.len() as u32,
                values: out.values as u32,
            });
            out.rows.extend_from_slice(below);
            out.values += width * (width + 1) / 2 + width * below.len();
            first += width;
        }
        out.rows.shrink_to_fit();
        out.panels.shrink_to_fit();
        Some(out)
    }

    /// Returns the memory of the pattern and of the values (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&self.panels[..]) + size_of_val(&self.rows[..]) + size_of::<f64>() * self.values
    }

    /// Iterates over the number of columns of each panel.
    #[cfg(test)]
    pub fn widths(&self) -> impl Iterator<Item = usize> + '_ {
        self.panels.iter().map(|panel| panel.width as usize)
    }

    /// Returns the ranges of rows and values of a panel.
    fn of(&self, at: usize) -> [Range<usize>; 2] {
        let Panel { rows, values, .. } = self.panels[at];
        let end = self.panels.get(at + 1);
        let [row_end, value_end] = end.map_or([self.rows.len(), self.values], |next| {
            [next.rows as usize, next.values as usize]
        });
        [rows as usize..row_end, values as usize..value_end]
    }

    /// Returns the values by panels of a factor in compressed columns, with inverted diagonal.
    pub fn arrange(&self, starts: &[u32], values: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.values);
        for (at, panel) in self.panels.iter().enumerate() {
            let (first, width) = (panel.first as usize, panel.width as usize);
            let entry =
                |row: usize, column: usize| values[starts[first + column] as usize + row - column];
            for row in 0..width {
                out.extend((0..row).map(|column| entry(row, column)));
                out.push(1.0 / entry(row, row));
            }
            for row in width..width + self.of(at)[0].len() {
                out.extend((0..width).map(|column| entry(row, column)));
            }
        }
        out
    }

    /// Computes x = L^-T L^-1 x.
    pub fn solve(&self, values: &[f64], x: &mut [f64]) {
        for at in 0..self.panels.len() {
            self.visit(at, values, x, true);
        }
        for at in (0..self.panels.len()).rev() {
            self.visit(at, values, x, false);
        }
    }

    /// Eliminates a panel from the rows below it, or solves it with known values of these rows.
    #[inline]
    fn visit(&self, at: usize, values: &[f64], x: &mut [f64], forward: bool) {
        let Panel { first, width, .. } = self.panels[at];
        let [rows, of] = self.of(at);
        let (rows, values, first) = (&self.rows[rows], &values[of], first as usize);
        match (width, forward) {
            (1, true) => eliminate::<1>(first, rows, values, x),
            (2, true) => eliminate::<2>(first, rows, values, x),
            (3, true) => eliminate::<3>(first, rows, values, x),
            (_, true) => eliminate::<WIDEST>(first, rows, values, x),
            (1, false) => substitute::<1>(first, rows, values, x),
            (2, false) => substitute::<2>(first, rows, values, x),
            (3, false) => substitute::<3>(first, rows, values, x),
            (_, false) => substitute::<WIDEST>(first, rows, values, x),
        }
    }
}

/// Solves the diagonal block of a panel, and subtracts its contribution from the rows below.
#[inline]
fn eliminate<const W: usize>(first: usize, rows: &[u32], values: &[f64], x: &mut [f64]) {
    let (triangle, below) = values.split_at(W * (W + 1) / 2);
    let mut y = [0.0; W];
    let mut at = 0;
    for r in 0..W {
        let known = triangle[at..at + r].iter().zip(&y);
        let rest = known.fold(x[first + r], |rest, (l, y)| rest - l * y);
        y[r] = rest * triangle[at + r];
        x[first + r] = y[r];
        at += r + 1;
    }
    // A load at a few points affects only some of the panels.
    if y == [0.0; W] {
        return;
    }
    for (row, l) in rows.iter().zip(below.chunks_exact(W)) {
        let of_panel: f64 = l.iter().zip(&y).map(|(l, y)| l * y).sum();
        x[*row as usize] -= of_panel;
    }
}

/// Solves a panel with known values of the rows below it.
#[inline]
fn substitute<const W: usize>(first: usize, rows: &[u32], values: &[f64], x: &mut [f64]) {
    let (triangle, below) = values.split_at(W * (W + 1) / 2);
    let mut of_rows = [0.0; W];
    for (row, l) in rows.iter().zip(below.chunks_exact(W)) {
        let y = x[*row as usize];
        for (sum, l) in of_rows.iter_mut().zip(l) {
            *sum += l * y;
        }
    }
    for r in (0..W).rev() {
        let later = r + 1..W;
        let rest = later.fold(x[first + r] - of_rows[r], |rest, c| {
            rest - triangle[c * (c + 1) / 2 + r] * x[first + c]
        });
        x[first + r] = rest * triangle[r * (r + 1) / 2 + r];
    }
}
