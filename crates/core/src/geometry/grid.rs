//! Neighbour search for balls: a uniform grid of cells, each slightly wider than the largest search
//! distance.
//!
//! Where a few large balls would put many small ones into each cell, balls are sorted by size into
//! levels with a grid each, and a ball searches the grids of its own level and of the larger ones
//! (Ericson, Real-Time Collision Detection, 2005, section 7.2.1).

use super::cells::Grid;
use super::periodic::Periodic;
use super::space::VectorLike;
use crate::threads;
use std::ops::Range;

/// Number of balls per task.
const CHUNK: usize = 1024;
/// Approximate time for a ball (ns).
const COST: f64 = 300.0;

/// Balls of which pairs are searched.
#[derive(Clone, Copy, Debug)]
pub struct Balls<'a, V> {
    /// Centres x (m).
    pub centres: &'a [V],
    /// Radii r (m).
    pub radii: &'a [f64],
    /// Distance beyond the radii within which two balls are a pair (m).
    pub reach: f64,
    /// Periodic boundaries.
    pub periodic: &'a Periodic,
}

/// Returns all pairs (a, b), a < b, of balls with |x_a - x_b| < r_a + r_b + reach, sorted by (a,
/// b).
///
/// `keep(a, b)` selects the relevant pairs (balls of one body never touch each other). The cost is
/// linear in the number of balls, for any sizes; memory is bounded for any extent (cells grow if
/// the scene is sparse). Balls are distributed over threads if `parallel`; the results are the
/// same.
pub fn pairs<V: VectorLike>(
    balls: &Balls<V>,
    parallel: bool,
    keep: impl Fn(u32, u32) -> bool + Sync,
) -> Vec<(u32, u32)> {
    let n = balls.centres.len();
    if n < 2 {
        return Vec::new();
    }
    let levels = Levels::new(balls);
    let divide = threads::worth_dividing(parallel, n, COST);
    let parts = threads::map_ranges(divide, n, threads::chunk_size(CHUNK), |range| {
        let (mut out, mut rows) = (Vec::with_capacity(8 * range.len()), Vec::new());
        for a in range {
            let (a, first) = (a as u32, out.len());
            levels.near(a, balls, &mut rows, |b| {
                let pair = (a.min(b), a.max(b));
                if keep(pair.0, pair.1) {
                    out.push(pair);
                }
                true
            });
            out[first..].sort_unstable();
        }
        out
    });
    let mut out = parts.concat();
    if levels.levels.len() > 1 {
        out.sort_unstable();
    }
    out
}

/// A cell with many balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DenseCell {
    /// Index of a ball in the cell.
    pub ball: u32,
    /// Number of balls in the cell.
    pub count: usize,
    /// Size of the cell (m).
    pub size: f64,
}

/// Returns the cell with the most balls if [`pairs`] would find more than `most` pairs. Stores no
/// pairs, and stops counting when the answer is known.
pub fn dense_cell<V: VectorLike>(
    balls: &Balls<V>,
    most: usize,
    keep: impl Fn(u32, u32) -> bool,
) -> Option<DenseCell> {
    let n = balls.centres.len();
    // All possible pairs together are fewer.
    if n < 2 || n.saturating_mul(n - 1) / 2 <= most {
        return None;
    }
    let levels = Levels::new(balls);
    let (mut rows, mut found) = (Vec::new(), 0usize);
    for a in 0..n as u32 {
        levels.near(a, balls, &mut rows, |b| {
            found += usize::from(keep(a.min(b), a.max(b)));
            found <= most
        });
        if found > most {
            return levels.densest_cell();
        }
    }
    None
}

/// Returns the number of pairs that [`pairs`] examines, an upper bound of those it finds. Linear in
/// the number of balls.
pub fn pairs_bound<V: VectorLike>(balls: &Balls<V>) -> f64 {
    let levels = Levels::new(balls);
    let (mut rows, mut sum) = (Vec::new(), 0.0);
    for (a, x) in balls.centres.iter().enumerate() {
        for level in levels.of(a as u32) {
            level.grid.around(x, balls.periodic, &mut rows);
            let examined: usize = rows.iter().map(|row| row.len()).sum();
            sum += if levels.is_own(a as u32, level) {
                0.5 * (examined as f64 - 1.0)
            } else {
                examined as f64
            };
        }
    }
    sum
}

/// Mean number of balls per cell searched, above which balls are sorted by size. For balls of one
/// size it is three.
const CROWDED: f64 = 8.0;
/// The largest search distance of a level is at most twice its smallest, except in the last level,
/// which starts at 1e-9 of the largest.
const MAX_LEVELS: usize = 31;

/// Balls sorted by size into levels with a grid each, from small to large.
struct Levels<V> {
    levels: Vec<Level<V>>,
    /// Level of each ball; empty if there is only one.
    own: Vec<u8>,
}

struct Level<V> {
    place: usize,
    grid: Grid,
    /// Centres and radii of the balls, cell by cell (m).
    places: Vec<(V, f64)>,
}

impl<V: VectorLike> Level<V> {
    fn new(place: usize, grid: Grid, balls: &Balls<V>) -> Self {
        let at = |b: &u32| (balls.centres[*b as usize], balls.radii[*b as usize]);
        let places = grid.sorted().iter().map(at).collect();
        Self {
            place,
            grid,
            places,
        }
    }
}

impl<V: VectorLike> Levels<V> {
    fn new(balls: &Balls<V>) -> Self {
        let (radii, reach) = (balls.radii, balls.reach);
        let widest = radii.iter().copied().fold(0.0, f64::max);
        let width = |radius: f64| 2.0 * radius + reach;
        let grid = Grid::new(balls.centres, None, width(widest), balls.periodic);
        let one = |grid| Self {
            levels: vec![Level::new(0, grid, balls)],
            own: Vec::new(),
        };
        if grid.crowd() <= CROWDED {
            return one(grid);
        }
        // The levels go from large to small balls, as far as there are balls.
        let class = |radius: f64| {
            let ratio = width(widest) / width(radius);
            // The exponent is monotonic in the ratio: a lower level contains no larger ball.
            let exponent = (ratio.to_bits() >> 52) as usize;
            exponent.saturating_sub(1023).min(MAX_LEVELS - 1)
        };
        let classes: Vec<usize> = radii.iter().map(|r| class(*r)).collect();
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); MAX_LEVELS];
        for (ball, class) in classes.iter().enumerate() {
            members[*class].push(ball as u32);
        }
        let filled: Vec<usize> = (0..MAX_LEVELS)
            .rev()
            .filter(|class| !members[*class].is_empty())
            .collect();
        if filled.len() < 2 {
            return one(grid);
        }
        let levels = filled.iter().enumerate().map(|(place, class)| {
            let members = &members[*class];
            let widest = members.iter().map(|b| radii[*b as usize]);
            let widest = widest.fold(0.0, f64::max);
            let grid = Grid::new(balls.centres, Some(members), width(widest), balls.periodic);
            Level::new(place, grid, balls)
        });
        let levels = levels.collect();
        let place = |class: &usize| filled.iter().position(|f| f == class).unwrap_or(0) as u8;
        Self {
            levels,
            own: classes.iter().map(place).collect(),
        }
    }

    /// Returns the levels that a ball searches: its own and the larger ones.
    fn of(&self, ball: u32) -> &[Level<V>] {
        let own = self.own.get(ball as usize).copied().unwrap_or(0);
        &self.levels[usize::from(own)..]
    }

    /// Calls `each` with the balls within the search distance of `a` that it is paired with, until
    /// it returns false.
    fn near(
        &self,
        a: u32,
        balls: &Balls<V>,
        rows: &mut Vec<Range<usize>>,
        mut each: impl FnMut(u32) -> bool,
    ) {
        let (xa, ra) = (balls.centres[a as usize], balls.radii[a as usize]);
        for level in self.of(a) {
            level.grid.around(&xa, balls.periodic, rows);
            let own = self.is_own(a, level);
            for row in rows.iter() {
                let sorted = &level.grid.sorted()[row.clone()];
                for (&b, (xb, rb)) in sorted.iter().zip(&level.places[row.clone()]) {
                    // Two balls of one level find each other twice.
                    if own && b <= a {
                        continue;
                    }
                    let d = balls.periodic.shortest(*xb - xa);
                    let limit = ra + rb + balls.reach;
                    if d.dot(&d) < limit * limit && !each(b) {
                        return;
                    }
                }
            }
        }
    }

    /// Returns the cell with the most balls.
    fn densest_cell(&self) -> Option<DenseCell> {
        let cells = self.levels.iter().filter_map(|level| {
            let (cell, count) = level.grid.fullest_cell()?;
            Some((&level.grid, cell, count))
        });
        let (grid, cell, count) = cells.max_by_key(|c| c.2)?;
        Some(DenseCell {
            ball: *grid.balls(cell).first()?,
            count,
            size: grid.cell_size(),
        })
    }

    fn is_own(&self, ball: u32, level: &Level<V>) -> bool {
        let own = self.own.get(ball as usize).copied().unwrap_or(0);
        usize::from(own) == level.place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector3};
    use rand::{RngExt, SeedableRng};

    /// All pairs by comparing every ball with every other.
    fn brute<V: VectorLike>(balls: &Balls<V>) -> Vec<(u32, u32)> {
        let (x, r) = (balls.centres, balls.radii);
        let mut out = Vec::new();
        for a in 0..x.len() {
            for b in a + 1..x.len() {
                if balls.periodic.shortest(x[b] - x[a]).norm() < r[a] + r[b] + balls.reach {
                    out.push((a as u32, b as u32));
                }
            }
        }
        out
    }

    fn balls<'a, V>(
        centres: &'a [V],
        radii: &'a [f64],
        reach: f64,
        periodic: &'a Periodic,
    ) -> Balls<'a, V> {
        Balls {
            centres,
            radii,
            reach,
            periodic,
        }
    }

    const OPEN: &Periodic = &Periodic { period: [None; 3] };

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
            let plane = balls(&x2, &r, 0.05, &periodic);
            assert_eq!(pairs(&plane, false, |_, _| true), brute(&plane));
            let x3: Vec<_> = x2
                .iter()
                .map(|p| Vector3::new(p.x, p.y * 0.3, p.x * 0.1))
                .collect();
            let space = balls(&x3, &r, 0.05, &periodic);
            assert_eq!(pairs(&space, false, |_, _| true), brute(&space));
        }
    }

    /// Balls of sizes from one to `ratio` in a box half as wide as the largest.
    fn mixed<const N: usize>(
        rng: &mut rand_pcg::Pcg64,
        count: usize,
        ratio: f64,
    ) -> (Vec<[f64; N]>, Vec<f64>) {
        let radius = |rng: &mut rand_pcg::Pcg64| ratio.powf(rng.random_range(-1.0..0.0));
        let r = (0..count).map(|_| radius(rng)).collect();
        let x = (0..count).map(|_| std::array::from_fn(|_| rng.random_range(-1.0..3.0)));
        (x.collect(), r)
    }

    #[test]
    fn finds_what_all_pairs_finds_whatever_the_sizes() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(9);
        let every = |_, _| true;
        for ratio in [1.0, 2.5, 10.0, 1e2, 1e4] {
            for period in [None, Some(4.0), Some(40.0)] {
                for reach in [0.0, 1e-4, 0.3] {
                    let periodic = Periodic {
                        period: [period, None, period],
                    };
                    let (x, mut r) = mixed(&mut rng, 400, ratio);
                    let x: Vec<_> = x.into_iter().map(Vector2::from).collect();
                    let plane = balls(&x, &r, reach, &periodic);
                    let found = pairs(&plane, true, every);
                    assert_eq!(found, brute(&plane));
                    assert!(pairs_bound(&plane) >= found.len() as f64);
                    // One large ball among many small ones of equal size.
                    r.fill(1.0 / ratio);
                    r[137] = 1.0;
                    let (x, _) = mixed(&mut rng, 400, ratio);
                    let x: Vec<_> = x.into_iter().map(Vector3::from).collect();
                    let space = balls(&x, &r, reach, &periodic);
                    let found = pairs(&space, true, every);
                    assert_eq!(found, brute(&space));
                    assert!(pairs_bound(&space) >= found.len() as f64);
                }
            }
        }
    }

    #[test]
    fn a_large_ball_does_not_widen_the_search_of_small_ones() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(10);
        let n = 20_000;
        let mut x: Vec<_> = (0..n)
            .map(|_| Vector2::new(rng.random_range(0.0..1.0), rng.random_range(0.0..1.0)))
            .collect();
        let mut r = vec![3e-3; n];
        let alone = pairs_bound(&balls(&x, &r, 0.0, OPEN));
        x.push(Vector2::new(0.5, 1.5));
        r.push(0.6);
        let both = pairs_bound(&balls(&x, &r, 0.0, OPEN));
        // Each also examines the large one.
        assert!(both < 1.1 * alone + n as f64, "{both:e} {alone:e}");
    }

    #[test]
    fn the_bound_of_pairs_is_not_exceeded() {
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
            let balls = balls(&x, &r, reach, &periodic);
            let found = pairs(&balls, false, |_, _| true).len() as f64;
            let most = pairs_bound(&balls);
            assert!(found <= most && most > last, "{found} of {most}");
            last = most;
        }
        // Every ball finds every other.
        assert_eq!(last, 500.0 * 499.0 / 2.0);
    }

    #[test]
    fn a_pile_is_found_without_its_pairs() {
        let mut x: Vec<_> = (0..3000).map(|k| Vector2::new(f64::from(k), 0.0)).collect();
        let radii = vec![0.6; 3000];
        let none = dense_cell(&balls(&x, &radii, 0.0, OPEN), 2999, |_, _| true);
        assert_eq!(none, None);
        x[1000..2000].fill(Vector2::new(500.25, 0.0));
        let balls = balls(&x, &radii, 0.0, OPEN);
        let found = pairs(&balls, false, |_, _| true).len();
        assert!(found > 499_500);
        let pile = |most| dense_cell(&balls, most, |_, _| true);
        assert_eq!(pile(found), None);
        for most in [10, found - 1] {
            let crowd = pile(most).unwrap();
            assert_eq!(x[crowd.ball as usize].x.floor(), 500.0);
            assert!(
                (1000..1003).contains(&crowd.count) && crowd.size < 2.5,
                "{crowd:?}"
            );
        }
        // Irrelevant pairs are not counted.
        let apart = |a: u32, b: u32| a / 1000 != b / 1000;
        let few = dense_cell(&balls, 5000, apart);
        assert_eq!(few, None);
    }

    #[test]
    fn a_sparse_scene_takes_bounded_memory() {
        let x = [
            Vector2::new(0.0, 0.0),
            Vector2::new(1e9, 1e9),
            Vector2::new(1e9, 1e9 + 1e-3),
        ];
        let far = balls(&x, &[1e-3; 3], 0.0, OPEN);
        assert_eq!(pairs(&far, false, |_, _| true), [(1, 2)]);
    }
}
