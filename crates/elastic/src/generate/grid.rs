//! Rows of cells in a box, with fewer columns the farther they are from one of its sides.

use super::SIDES;

/// Largest relative difference of lengths that count as equal.
const ROUNDING: f64 = 1e-9;

/// A grid point: indices of the coordinates along each axis. In 2D the last is not used.
pub(super) type Place = [usize; 3];

/// Cells of a box in rows along one axis. All cells of a row have the same columns; the next row
/// has the same columns, or pairs of them are joined. The points between two rows are those of the
/// row with more columns.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockGrid {
    /// Coordinates along each axis (m), increasing.
    lines: Vec<Vec<f64>>,
    /// The axis along which rows follow each other.
    axis: usize,
    /// Columns of each row, as an index in `sets`.
    rows: Vec<usize>,
    /// Coordinates, along each axis, where columns end; empty along the axis of the rows.
    sets: Vec<Vec<Vec<usize>>>,
}

/// Rule by which columns of a grid are joined, see [`BlockGrid::coarsened`].
#[derive(Clone, Debug, PartialEq)]
pub struct Coarsening<'a> {
    /// Name of the side where all columns are kept.
    pub from: &'a str,
    /// Largest ratio of the width of a joined pair of columns to the height of their row.
    pub ratio: f64,
}

/// Reason why a grid is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// There are fewer than two axes, more than three, or fewer than two coordinates along one.
    #[error("a block has two or three axes, with two coordinates at least along each")]
    Lines,
    /// There is no such side.
    #[error("a block has no side `{0}` to coarsen from; its sides are {1}")]
    Side(String, String),
    /// The ratio is not positive.
    #[error(
        "cells join where they are `ratio` times as wide as high; it must be positive, got {0}"
    )]
    Ratio(f64),
    /// No row is high enough.
    #[error(
        "no cells would join: two columns join where a row is at least 1/{ratio} as high as they are wide, {needed:.3e} m for the narrowest two, and the highest row away from `{side}` has {highest:.3e} m; let the rows grow with the distance from `{side}` (`fine` and `growth` along {axis}), give `coarsen` a larger `ratio`, or leave it out"
    )]
    Nothing {
        /// The side.
        side: String,
        /// The axis of the rows.
        axis: char,
        /// Height of the highest row (m).
        highest: f64,
        /// Height at which the narrowest pair of columns would join (m).
        needed: f64,
        /// Width over height at which columns join.
        ratio: f64,
    },
    /// There is only one row of cells.
    #[error(
        "no cells would join: the first row from `{side}` keeps all its columns, and the block has no other along {axis}; give it more rows, or leave `coarsen` out"
    )]
    OneRow {
        /// The side.
        side: String,
        /// The axis of the rows.
        axis: char,
    },
    /// There is only one column.
    #[error("the block has a single column, and none that could join; leave `coarsen` out")]
    Single,
    /// There are more points than allowed.
    #[error(
        "the block has more than {0} points; make its elements larger, or let them grow away from `fine`"
    )]
    TooMany(usize),
}

impl BlockGrid {
    /// Creates a grid with the same columns in all rows, between the given coordinates along two or
    /// three axes (m), which must increase.
    ///
    /// # Errors
    /// Fails with fewer than two coordinates along an axis, or another number of axes.
    pub fn new(lines: &[Vec<f64>]) -> Result<Self, GridError> {
        if !(2..=3).contains(&lines.len()) || lines.iter().any(|line| line.len() < 2) {
            return Err(GridError::Lines);
        }
        let axis = lines.len() - 1;
        let all = all_columns(lines, axis);
        Ok(Self {
            axis,
            rows: vec![0; lines[axis].len() - 1],
            sets: vec![all],
            lines: lines.to_vec(),
        })
    }

    /// Creates a grid with the given coordinates along each axis (m), whose columns join with the
    /// distance from a side: from the second row on, neighbours join in pairs, from both ends of
    /// each axis to its middle, where the pair is no wider than `ratio` times the height of the
    /// row. A single column that is left over joins in the next row in which it and its neighbour
    /// are narrow enough.
    ///
    /// # Errors
    /// Fails with fewer than two coordinates along an axis, or another number of axes; an unknown
    /// side; no row that is high enough; more than `most` points of cells.
    pub fn coarsened(
        lines: &[Vec<f64>],
        coarsening: &Coarsening,
        most: usize,
    ) -> Result<Self, GridError> {
        let mut grid = Self::new(lines)?;
        let d = lines.len();
        let side = coarsening.from;
        let sides = SIDES[d - 2].iter().enumerate();
        let mut found =
            sides.filter_map(|(a, names)| Some((a, names.iter().position(|n| *n == side)?)));
        let Some((axis, end)) = found.next() else {
            let names: Vec<String> = SIDES[d - 2]
                .iter()
                .flatten()
                .map(|n| format!("`{n}`"))
                .collect();
            return Err(GridError::Side(side.to_owned(), names.join(", ")));
        };
        if !(coarsening.ratio > 0.0 && coarsening.ratio.is_finite()) {
            return Err(GridError::Ratio(coarsening.ratio));
        }
        let heights: Vec<f64> = lines[axis].windows(2).map(|w| w[1] - w[0]).collect();
        let count = heights.len();
        grid.axis = axis;
        grid.sets = vec![all_columns(lines, axis)];
        grid.rows = vec![0; count];
        let mut points = 0usize;
        for depth in 0..count {
            let row = if end == 1 { count - 1 - depth } else { depth };
            let above = &grid.sets[grid.sets.len() - 1];
            points = points.saturating_add(stops(above));
            if points > most {
                return Err(GridError::TooMany(most));
            }
            if depth > 0 {
                let longest = coarsening.ratio * heights[row] * (1.0 + ROUNDING);
                let next: Vec<Vec<usize>> = (0..d)
                    .map(|k| join(&lines[k], &above[k], longest))
                    .collect();
                if next != *above {
                    grid.sets.push(next);
                }
            }
            grid.rows[row] = grid.sets.len() - 1;
        }
        // The last plane lies beyond the last row.
        points = points.saturating_add(stops(&grid.sets[grid.sets.len() - 1]));
        if points > most {
            return Err(GridError::TooMany(most));
        }
        if grid.sets.len() == 1 {
            return Err(grid.nothing(coarsening, end));
        }
        Ok(grid)
    }

    /// Returns why no columns join with the distance from this side, at an end of the axis.
    fn nothing(&self, coarsening: &Coarsening, end: usize) -> GridError {
        let side = coarsening.from.to_owned();
        let axis = ['x', 'y', 'z'][self.axis];
        let others = (0..self.lines.len()).filter(|k| *k != self.axis);
        let pairs = others.flat_map(|k| self.lines[k].windows(3));
        let narrowest = pairs.map(|w| w[2] - w[0]).fold(f64::INFINITY, f64::min);
        if narrowest.is_infinite() {
            return GridError::Single;
        }
        if self.rows.len() == 1 {
            return GridError::OneRow { side, axis };
        }
        let mut heights: Vec<f64> = self.lines[self.axis]
            .windows(2)
            .map(|w| w[1] - w[0])
            .collect();
        if end == 1 {
            heights.reverse();
        }
        GridError::Nothing {
            side,
            axis,
            highest: heights.iter().skip(1).copied().fold(0.0, f64::max),
            needed: narrowest / coarsening.ratio,
            ratio: coarsening.ratio,
        }
    }

    /// Returns the coordinates along each axis (m).
    pub fn lines(&self) -> &[Vec<f64>] {
        &self.lines
    }

    /// Returns the number of points of the cells, without those inside cells.
    pub fn points(&self) -> usize {
        (0..=self.rows.len()).map(|k| stops(self.plane(k))).sum()
    }

    /// Whether columns join.
    pub fn is_coarsened(&self) -> bool {
        self.sets.len() > 1
    }

    /// Returns the number of columns of each row, along the axis of the rows.
    pub fn columns(&self) -> Vec<usize> {
        let one = |set: &usize| self.sets[*set].iter().filter(|s| !s.is_empty());
        let count = |set| one(set).map(|s| s.len() - 1).product();
        self.rows.iter().map(count).collect()
    }

    pub(super) fn dimension(&self) -> usize {
        self.lines.len()
    }

    /// The axis of the rows.
    pub(super) fn axis(&self) -> usize {
        self.axis
    }

    pub(super) fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Returns the coordinates, along each axis except that of the rows, where the columns of a row
    /// end.
    pub(super) fn row(&self, row: usize) -> &[Vec<usize>] {
        &self.sets[self.rows[row]]
    }

    /// Returns the coordinates, along each axis except that of the rows, where the columns of the
    /// points between rows k - 1 and k end.
    pub(super) fn plane(&self, k: usize) -> &[Vec<usize>] {
        let below = self.rows.get(k.wrapping_sub(1));
        let around = below.into_iter().chain(self.rows.get(k));
        // Columns join from one set to the next.
        &self.sets[around.copied().min().unwrap_or(0)]
    }

    /// Returns the coordinates of the points in plane k from one end of a column to the other along
    /// an axis, and the number of the first.
    pub(super) fn between(
        &self,
        k: usize,
        axis: usize,
        [low, high]: [usize; 2],
    ) -> (usize, &[usize]) {
        let stops = &self.plane(k)[axis];
        let first = stops.partition_point(|s| *s < low);
        let last = stops.partition_point(|s| *s < high);
        (first, &stops[first..=last])
    }
}

/// Returns all coordinates along all axes except one.
fn all_columns(lines: &[Vec<f64>], axis: usize) -> Vec<Vec<usize>> {
    let every = |(k, line): (usize, &Vec<f64>)| {
        let count = if k == axis { 0 } else { line.len() };
        (0..count).collect()
    };
    lines.iter().enumerate().map(every).collect()
}

/// Returns the number of points where columns end.
fn stops(set: &[Vec<usize>]) -> usize {
    let along = set.iter().filter(|s| !s.is_empty());
    along.map(Vec::len).product()
}

/// Joins neighbours in pairs no longer than `longest` (m), from both ends to the middle.
fn join(line: &[f64], stops: &[usize], longest: f64) -> Vec<usize> {
    let Some(parts) = stops.len().checked_sub(1) else {
        return Vec::new();
    };
    let narrow = |k: usize| line[stops[k + 1]] - line[stops[k - 1]] <= longest;
    let mut kept = vec![true; stops.len()];
    // The remaining columns lie between these coordinates.
    let (mut low, mut high) = (0, parts);
    while low + 1 < high {
        if narrow(low + 1) {
            kept[low + 1] = false;
            low += 1;
        }
        low += 1;
        if low + 1 < high && narrow(high - 1) {
            kept[high - 1] = false;
            high -= 1;
        }
        high -= usize::from(low < high);
    }
    let kept = stops.iter().zip(kept).filter(|(_, kept)| *kept);
    kept.map(|(stop, _)| *stop).collect()
}
