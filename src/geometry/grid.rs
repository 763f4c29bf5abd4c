//! Pairs of balls that may touch: a uniform grid of cells, each a little wider than the widest reach.

use super::periodic::Periodic;
use super::space::VectorLike;

/// All pairs (a, b), a < b, of balls with |x_a - x_b| < r_a + r_b + `reach`, sorted by (a, b).
///
/// `keep(a, b)` says which pairs matter (balls of one body never touch each other). Cost is linear in
/// the number of balls; memory is bounded whatever the extent (cells grow when the scene is sparse).
pub fn pairs<V: VectorLike>(
    centres: &[V],
    radii: &[f64],
    reach: f64,
    periodic: &Periodic,
    keep: impl Fn(u32, u32) -> bool,
) -> Vec<(u32, u32)> {
    let n = centres.len();
    if n < 2 {
        return Vec::new();
    }
    let widest = radii.iter().copied().fold(0.0, f64::max);
    let grid = Grid::new(centres, 2.0 * widest + reach, periodic);
    let mut out = Vec::with_capacity(4 * n);
    let mut near = Vec::new();
    for a in 0..n {
        let (xa, ra) = (centres[a], radii[a]);
        grid.around(&xa, periodic, &mut near);
        let first = out.len();
        for &cell in &near {
            for &b in grid.balls(cell) {
                if b as usize <= a {
                    continue;
                }
                let d = periodic.shortest(centres[b as usize] - xa);
                let limit = ra + radii[b as usize] + reach;
                if d.dot(&d) < limit * limit && keep(a as u32, b) {
                    out.push((a as u32, b));
                }
            }
        }
        out[first..].sort_unstable();
    }
    out
}

/// How many pairs [`pairs`] looks at: no fewer than it finds. Linear in the number of balls.
pub fn most_pairs<V: VectorLike>(
    centres: &[V],
    radii: &[f64],
    reach: f64,
    periodic: &Periodic,
) -> f64 {
    let widest = radii.iter().copied().fold(0.0, f64::max);
    let grid = Grid::new(centres, 2.0 * widest + reach, periodic);
    let (mut near, mut sum) = (Vec::new(), 0.0);
    for x in centres {
        grid.around(x, periodic, &mut near);
        let seen: usize = near.iter().map(|cell| grid.balls(*cell).len()).sum();
        sum += seen as f64 - 1.0;
    }
    0.5 * sum
}

struct Grid {
    counts: [usize; 3],
    origin: [f64; 3],
    size: [f64; 3],
    dimension: usize,
    starts: Vec<u32>,
    sorted: Vec<u32>,
}

impl Grid {
    fn new<V: VectorLike>(centres: &[V], width: f64, periodic: &Periodic) -> Self {
        let mut counts = [1usize; 3];
        let (mut origin, mut size) = ([0.0; 3], [1.0; 3]);
        let mut width = width.max(f64::MIN_POSITIVE);
        let extent = |k: usize| match periodic.period[k] {
            Some(period) => (0.0, period),
            None => centres
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
                    (lo.min(x[k]), hi.max(x[k]))
                }),
        };
        // A sparse scene gets wider cells rather than more memory.
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
            if total <= 8.0 * centres.len() as f64 + 64.0 {
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
        let cells: Vec<u32> = centres
            .iter()
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
        let mut sorted = vec![0u32; centres.len()];
        for (ball, c) in cells.iter().enumerate() {
            sorted[next[*c as usize] as usize] = ball as u32;
            next[*c as usize] += 1;
        }
        grid.starts = starts;
        grid.sorted = sorted;
        grid
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

    fn balls(&self, cell: usize) -> &[u32] {
        &self.sorted[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The cells around a position, each once even where a periodic axis has one or two cells.
    fn around<V: VectorLike>(&self, x: &V, periodic: &Periodic, out: &mut Vec<usize>) {
        out.clear();
        let home = self.cell(&periodic.wrapped(*x));
        let mut axis: [([usize; 3], usize); 3] = [([0; 3], 1); 3];
        for k in 0..self.dimension {
            let (n, c) = (self.counts[k], home[k]);
            let mut list = [c; 3];
            let mut len = 1;
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
            for neighbour in [below, above].into_iter().flatten() {
                if !list[..len].contains(&neighbour) {
                    list[len] = neighbour;
                    len += 1;
                }
            }
            axis[k] = (list, len);
        }
        for &cz in &axis[2].0[..axis[2].1] {
            for &cy in &axis[1].0[..axis[1].1] {
                for &cx in &axis[0].0[..axis[0].1] {
                    out.push(self.index([cx, cy, cz]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector3};
    use rand::{RngExt, SeedableRng};

    fn brute<V: VectorLike>(
        x: &[V],
        r: &[f64],
        reach: f64,
        periodic: &Periodic,
    ) -> Vec<(u32, u32)> {
        let mut out = Vec::new();
        for a in 0..x.len() {
            for b in a + 1..x.len() {
                if periodic.shortest(x[b] - x[a]).norm() < r[a] + r[b] + reach {
                    out.push((a as u32, b as u32));
                }
            }
        }
        out
    }

    #[test]
    fn finds_what_all_pairs_finds() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        for period in [None, Some(1.0), Some(3.0), Some(10.0)] {
            let periodic = Periodic {
                period: [period, None, None],
            };
            let r: Vec<f64> = (0..200).map(|_| rng.random_range(0.05..0.2)).collect();
            let x2: Vec<_> = (0..200)
                .map(|_| Vector2::new(rng.random_range(-2.0..12.0), rng.random_range(0.0..4.0)))
                .collect();
            assert_eq!(
                pairs(&x2, &r, 0.05, &periodic, |_, _| true),
                brute(&x2, &r, 0.05, &periodic)
            );
            let x3: Vec<_> = x2
                .iter()
                .map(|p| Vector3::new(p.x, p.y * 0.3, p.x * 0.1))
                .collect();
            assert_eq!(
                pairs(&x3, &r, 0.05, &periodic, |_, _| true),
                brute(&x3, &r, 0.05, &periodic)
            );
        }
    }

    #[test]
    fn pairs_are_no_more_than_are_looked_at() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(8);
        let x: Vec<_> = (0..500)
            .map(|_| Vector2::new(rng.random_range(0.0..10.0), rng.random_range(0.0..10.0)))
            .collect();
        let r = vec![0.1; 500];
        let mut last = 0.0;
        for (reach, period) in [(0.0, None), (0.5, Some(10.0)), (3.0, None), (1e3, None)] {
            let periodic = Periodic {
                period: [period, None, None],
            };
            let found = pairs(&x, &r, reach, &periodic, |_, _| true).len() as f64;
            let most = most_pairs(&x, &r, reach, &periodic);
            assert!(found <= most && most > last, "{found} of {most}");
            last = most;
        }
        // All see all.
        assert_eq!(last, 500.0 * 499.0 / 2.0);
    }

    #[test]
    fn a_sparse_scene_takes_bounded_memory() {
        let x = [
            Vector2::new(0.0, 0.0),
            Vector2::new(1e9, 1e9),
            Vector2::new(1e9, 1e9 + 1e-3),
        ];
        assert_eq!(
            pairs(&x, &[1e-3; 3], 0.0, &Periodic::default(), |_, _| true),
            vec![(1, 2)]
        );
    }
}
