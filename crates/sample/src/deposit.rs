//! Loose random deposits: grains are placed one after another at random without overlaps, the
//! largest first.
//!
//! Random sequential addition fills about 0.5 of a box in 2D and 0.35 in 3D before it fails (0.547,
//! Feder 1980, and 0.384, Cooper 1988, in the limit for equal balls); gravity or walls compact the
//! sample further.

use super::sizes::Sizes;
use fretwork_core::geometry::periodic::Periodic;
use fretwork_core::geometry::space::{Dim2, Dim3, Space, VectorLike};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::HashMap;

/// Attempts to place one grain.
const ATTEMPTS: usize = 5_000;

/// A box (m).
#[derive(Clone, Copy, Debug)]
pub struct Corners<V> {
    /// Low corner.
    pub low: V,
    /// High corner.
    pub high: V,
}

impl<V: VectorLike> Corners<V> {
    /// Area or volume (m^2, m^3).
    pub fn volume(&self) -> f64 {
        (0..V::N).map(|k| self.high[k] - self.low[k]).product()
    }
}

/// Result of a deposit.
#[derive(Clone, Debug)]
pub struct Deposit<V> {
    /// Centres and radii (m), in random order of size.
    pub grains: Vec<(V, f64)>,
    /// Fraction of the box that all requested grains would fill.
    pub filling: f64,
}

/// Places grains in a box between two corners (m) in 2 or 3 dimensions, see [`deposit`]. In 2D the
/// third component is ignored.
pub fn deposit_between(
    dimension: usize,
    count: usize,
    sizes: &Sizes,
    corners: [[f64; 3]; 2],
    periodic: &Periodic,
    seed: u64,
) -> Deposit<[f64; 3]> {
    match dimension {
        2 => padded::<Dim2>(count, sizes, corners, periodic, seed),
        _ => padded::<Dim3>(count, sizes, corners, periodic, seed),
    }
}

fn padded<S: Space>(
    count: usize,
    sizes: &Sizes,
    [low, high]: [[f64; 3]; 2],
    periodic: &Periodic,
    seed: u64,
) -> Deposit<[f64; 3]> {
    let corners = Corners {
        low: S::Vector::from_slice(&low),
        high: S::Vector::from_slice(&high),
    };
    let made = deposit::<S>(count, sizes, &corners, periodic, seed);
    let grains = made.grains.into_iter();
    Deposit {
        grains: grains.map(|(at, radius)| (at.padded(), radius)).collect(),
        filling: made.filling,
    }
}

/// Places `count` grains in a box without overlaps, across a periodic axis if the box spans it.
/// Returns fewer if one of them cannot be placed.
pub fn deposit<S: Space>(
    count: usize,
    sizes: &Sizes,
    corners: &Corners<S::Vector>,
    periodic: &Periodic,
    seed: u64,
) -> Deposit<S::Vector> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let radii = sizes.draw(count, &mut rng);
    let volume: f64 = radii.iter().map(|r| S::ball_volume(*r)).sum();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| radii[*b].total_cmp(&radii[*a]));
    let around: [bool; 3] = std::array::from_fn(|k| {
        k < S::D
            && periodic.period[k]
                .is_some_and(|p| corners.high[k] - corners.low[k] >= p * (1.0 - 1e-9))
    });
    let mut placed = SizeLevels::<S::Vector>(Vec::new());
    let mut found: Vec<Option<S::Vector>> = vec![None; count];
    for k in order {
        let radius = radii[k];
        let Some(at) = free_place(&mut rng, radius, corners, around, periodic, &placed) else {
            break;
        };
        placed.add(at, radius, periodic);
        found[k] = Some(at);
    }
    let grains = found.iter().zip(&radii);
    Deposit {
        grains: grains.filter_map(|(x, r)| x.map(|x| (x, *r))).collect(),
        filling: volume / corners.volume(),
    }
}

/// Draws positions for a ball until one overlaps no other; `None` after too many attempts.
fn free_place<V: VectorLike>(
    rng: &mut Pcg64,
    radius: f64,
    corners: &Corners<V>,
    around: [bool; 3],
    periodic: &Periodic,
    placed: &SizeLevels<V>,
) -> Option<V> {
    let mut ranges = [(0.0, 0.0); 3];
    for k in 0..V::N {
        let margin = if around[k] { 0.0 } else { radius };
        ranges[k] = (corners.low[k] + margin, corners.high[k] - margin);
        if ranges[k].0 > ranges[k].1 {
            return None;
        }
    }
    for _ in 0..ATTEMPTS {
        let mut at = V::zero();
        for k in 0..V::N {
            let (low, high) = ranges[k];
            at[k] = low + (high - low) * rng.random_range(0.0..1.0);
        }
        if placed.free(&at, radius, periodic) {
            return Some(at);
        }
    }
    None
}

/// Balls sorted by size: each level has radii within a factor of two of its largest, in cells as
/// wide as that ball. A ball not larger than all placed ones therefore meets the balls of a level
/// in adjacent cells only.
struct SizeLevels<V>(Vec<SizeLevel<V>>);

struct SizeLevel<V> {
    widest: f64,
    cells: HashMap<[i64; 3], Vec<(V, f64)>>,
}

/// Number of cells of a level along an axis, and their width, adjusted to the period.
fn grid(widest: f64, period: Option<f64>) -> (f64, Option<i64>) {
    let width = 2.0 * widest;
    match period {
        None => (width, None),
        Some(p) => {
            let n = (p / width).floor().max(1.0);
            (p / n, Some(n as i64))
        }
    }
}

impl<V: VectorLike> SizeLevel<V> {
    fn cell(&self, x: &V, periodic: &Periodic) -> [i64; 3] {
        let mut cell = [0; 3];
        for (k, c) in cell.iter_mut().enumerate().take(V::N) {
            let (width, count) = grid(self.widest, periodic.period[k]);
            let at = (x[k] / width).floor() as i64;
            *c = count.map_or(at, |n| at.rem_euclid(n));
        }
        cell
    }
}

impl<V: VectorLike> SizeLevels<V> {
    /// Inserts a ball that is not larger than those before.
    fn add(&mut self, at: V, radius: f64, periodic: &Periodic) {
        if self.0.last().is_none_or(|l| radius < 0.5 * l.widest) {
            self.0.push(SizeLevel {
                widest: radius,
                cells: HashMap::new(),
            });
        }
        if let Some(level) = self.0.last_mut() {
            let cell = level.cell(&at, periodic);
            level.cells.entry(cell).or_default().push((at, radius));
        }
    }

    /// Whether a ball that is not larger than those before overlaps none of them.
    fn free(&self, at: &V, radius: f64, periodic: &Periodic) -> bool {
        self.0.iter().all(|level| {
            let home = level.cell(at, periodic);
            (0..3i64.pow(V::N as u32)).all(|code| {
                let mut cell = home;
                for (k, c) in cell.iter_mut().enumerate().take(V::N) {
                    *c += code / 3i64.pow(k as u32) % 3 - 1;
                    if let (_, Some(n)) = grid(level.widest, periodic.period[k]) {
                        *c = c.rem_euclid(n);
                    }
                }
                level.cells.get(&cell).into_iter().flatten().all(|(x, r)| {
                    let d = periodic.shortest(*x - *at);
                    let reach = r + radius;
                    d.dot(&d) >= reach * reach
                })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smallest_gap<S: Space>(grains: &[(S::Vector, f64)], periodic: &Periodic) -> f64 {
        let mut least = f64::INFINITY;
        for (k, (x, r)) in grains.iter().enumerate() {
            for (y, s) in &grains[..k] {
                least = least.min(periodic.shortest(*x - *y).norm() - r - s);
            }
        }
        least
    }

    fn check<S: Space>(high: &[f64], count: usize) {
        for period in [None, Some(high[0])] {
            let periodic = Periodic {
                period: [period, None, None],
            };
            let corners = Corners {
                low: S::Vector::zero(),
                high: S::Vector::from_slice(high),
            };
            let sizes = Sizes::power((0.01, 0.08), S::D as f64);
            let made = deposit::<S>(count, &sizes, &corners, &periodic, 1);
            assert_eq!(made.grains.len(), count);
            assert!(smallest_gap::<S>(&made.grains, &periodic) >= -1e-15);
            for (x, r) in &made.grains {
                for k in 0..S::D {
                    let margin = if k == 0 && period.is_some() { 0.0 } else { *r };
                    assert!(x[k] >= margin - 1e-12 && x[k] <= high[k] - margin + 1e-12);
                }
            }
            let again = deposit::<S>(count, &sizes, &corners, &periodic, 1);
            assert_eq!(made.grains, again.grains);
            let other = deposit::<S>(count, &sizes, &corners, &periodic, 2);
            assert_ne!(made.grains, other.grains);
        }
    }

    #[test]
    fn deposits_do_not_overlap_and_follow_their_seed() {
        check::<Dim2>(&[1.0, 1.0], 250);
        check::<Dim3>(&[1.0, 0.8, 0.8], 600);
    }

    #[test]
    fn a_box_that_is_too_small_gets_fewer() {
        let corners = Corners {
            low: nalgebra::Vector2::new(0.0, 0.0),
            high: nalgebra::Vector2::new(1.0, 1.0),
        };
        let sizes = Sizes::power((0.1, 0.1), 0.0);
        let made = deposit::<Dim2>(60, &sizes, &corners, &Periodic::default(), 1);
        assert!(made.grains.len() < 32 && made.grains.len() > 5);
        assert!((made.filling - 60.0 * std::f64::consts::PI * 0.01).abs() < 1e-9);
    }
}
