//! A uniform grid of cells, periodic where space is.

use super::periodic::Periodic;
use super::space::VectorLike;
use std::ops::Range;

/// Balls sorted into cells of equal size.
pub(super) struct Grid {
    counts: [usize; 3],
    origin: [f64; 3],
    size: [f64; 3],
    dimension: usize,
    /// Start of each cell in the list of balls, and its end.
    starts: Vec<u32>,
    /// The balls, cell by cell.
    sorted: Vec<u32>,
}

impl Grid {
    /// Builds a grid of all balls, or of some of them, in their order.
    pub(super) fn new<V: VectorLike>(
        centres: &[V],
        some: Option<&[u32]>,
        width: f64,
        periodic: &Periodic,
    ) -> Self {
        let count = some.map_or(centres.len(), <[u32]>::len);
        let ball = |k: usize| some.map_or(k as u32, |list| list[k]);
        let members = || (0..count).map(|k| &centres[ball(k) as usize]);
        let mut counts = [1usize; 3];
        let (mut origin, mut size) = ([0.0; 3], [1.0; 3]);
        let mut width = width.max(f64::MIN_POSITIVE);
        let extent = |k: usize| match periodic.period[k] {
            Some(period) => (0.0, period),
            None => members().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
                (lo.min(x[k]), hi.max(x[k]))
            }),
        };
        // A sparse scene gets larger cells rather than more memory.
        loop {
            let mut total = 1.0;
            for k in 0..V::N {
                let (low, high) = extent(k);
                let cells = ((high - low) / width).floor().max(1.0);
                total *= cells;
                if total > 1e18 {
                    break;
                }
                counts[k] = cells as usize;
                origin[k] = low;
                size[k] = ((high - low) / cells).max(width);
                if periodic.period[k].is_some() {
                    size[k] = (high - low) / cells;
                }
            }
            if total <= 8.0 * count as f64 + 64.0 {
                break;
            }
            width *= 1.5;
        }
        let mut grid = Self {
            counts,
            origin,
            size,
            dimension: V::N,
            starts: Vec::new(),
            sorted: Vec::new(),
        };
        let cells: Vec<u32> = members()
            .map(|x| grid.index(grid.cell(&periodic.wrapped(*x))) as u32)
            .collect();
        let total = counts.iter().product::<usize>();
        let mut starts = vec![0u32; total + 1];
        for c in &cells {
            starts[*c as usize + 1] += 1;
        }
        for k in 0..total {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut sorted = vec![0u32; count];
        for (k, c) in cells.iter().enumerate() {
            sorted[next[*c as usize] as usize] = ball(k);
            next[*c as usize] += 1;
        }
        grid.starts = starts;
        grid.sorted = sorted;
        grid
    }

    /// Returns the mean number of balls in the cell of a ball.
    pub(super) fn crowd(&self) -> f64 {
        let of = |w: &[u32]| f64::from(w[1] - w[0]).powi(2);
        let sum: f64 = self.starts.windows(2).map(of).sum();
        sum / self.sorted.len() as f64
    }

    fn cell<V: VectorLike>(&self, x: &V) -> [usize; 3] {
        let mut cell = [0; 3];
        for k in 0..V::N {
            let c = ((x[k] - self.origin[k]) / self.size[k]).floor().max(0.0) as usize;
            cell[k] = c.min(self.counts[k] - 1);
        }
        cell
    }

    fn index(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.counts[1] + cell[1]) * self.counts[0] + cell[0]
    }

    /// Returns the balls of a cell.
    pub(super) fn balls(&self, cell: usize) -> &[u32] {
        &self.sorted[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns the balls, cell by cell.
    pub(super) fn sorted(&self) -> &[u32] {
        &self.sorted
    }

    /// Finds the cells around a position, each once even if a periodic axis has only one or two
    /// cells, as ranges in
    /// [`Self::sorted`]: cells beside each other along x follow each other there.
    pub(super) fn around<V: VectorLike>(
        &self,
        x: &V,
        periodic: &Periodic,
        out: &mut Vec<Range<usize>>,
    ) {
        out.clear();
        let home = self.cell(&periodic.wrapped(*x));
        let mut axis: [([usize; 3], usize); 3] = [([0; 3], 1); 3];
        for k in 0..self.dimension {
            let (n, c) = (self.counts[k], home[k]);
            let mut list = [c; 3];
            let mut len = 0;
            let wraps = periodic.period[k].is_some();
            let below = if c > 0 {
                Some(c - 1)
            } else {
                wraps.then_some(n - 1)
            };
            let above = if c + 1 < n {
                Some(c + 1)
            } else {
                wraps.then_some(0)
            };
            for neighbour in [below, Some(c), above].into_iter().flatten() {
                if !list[..len].contains(&neighbour) {
                    list[len] = neighbour;
                    len += 1;
                }
            }
            axis[k] = (list, len);
        }
        let row = &axis[0].0[..axis[0].1];
        for &cz in &axis[2].0[..axis[2].1] {
            for &cy in &axis[1].0[..axis[1].1] {
                let mut from = 0;
                for k in 0..row.len() {
                    if k + 1 == row.len() || row[k + 1] != row[k] + 1 {
                        let first = self.index([row[from], cy, cz]);
                        let last = self.index([row[k], cy, cz]);
                        out.push(self.starts[first] as usize..self.starts[last + 1] as usize);
                        from = k + 1;
                    }
                }
            }
        }
    }

    /// Returns the cell with the most balls, and their number.
    pub(super) fn fullest_cell(&self) -> Option<(usize, usize)> {
        let counts = self.starts.windows(2).map(|w| (w[1] - w[0]) as usize);
        counts.enumerate().max_by_key(|c| c.1)
    }

    /// Returns the largest side of a cell (m).
    pub(super) fn cell_size(&self) -> f64 {
        let size = self.size[..self.dimension].iter().copied();
        size.fold(0.0, f64::max)
    }
}
