//! Voronoi cells that fill a rectangle with grains that fit each other side by side.
//!
//! Random sites, at least half a cell size apart, are mirrored in the walls of the box, so that the
//! cells end at the walls (Mollon, Tribol. Int. 90 (2015) 343 makes degradable bodies of such
//! cells). Lloyd iterations (IEEE Trans. Inf. Theory 28 (1982) 129) move each site to the centroid
//! of its cell, which makes the cells more uniform.

use super::deposit::{Corners, deposit};
use super::sizes::Sizes;
use fretwork_core::geometry::convex::mass;
use fretwork_core::geometry::periodic::Periodic;
use fretwork_core::geometry::space::Dim2;
use nalgebra::Vector2;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

type V = Vector2<f64>;

/// Sides shorter than this fraction of the cell size are removed: their ends are merged into one
/// corner.
pub const SHORTEST: f64 = 1e-3;
/// Tolerance, as a fraction of the cell size, within which corners coincide, or a corner is on a
/// wall.
const SAME: f64 = 1e-7;

/// A Voronoi tiling of a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Tiling {
    /// Corners of each cell (m), counter-clockwise; neighbours share both ends of their common
    /// side. Across a period, cells extend beyond the box.
    pub cells: Vec<Vec<V>>,
    /// Number of short sides that were removed.
    pub merged: usize,
}

/// Fills a box with about area/size² cells, periodic along x if the box is as wide as the period.
/// `None` if the box is thinner than half a cell.
pub fn tiling(
    corners: &Corners<V>,
    periodic: &Periodic,
    size: f64,
    rounds: usize,
    seed: u64,
) -> Option<Tiling> {
    let wide = corners.high.x - corners.low.x;
    let around = periodic.period[0].filter(|p| wide >= p * (1.0 - 1e-9));
    let count = (corners.volume() / (size * size)).round().max(1.0) as usize;
    let apart = Sizes::power((0.25 * size, 0.25 * size), 0.0);
    let only_x = Periodic {
        period: [around, None, None],
    };
    let deposited = deposit::<Dim2>(count, &apart, corners, &only_x, seed);
    if deposited.grains.len() < count {
        return None;
    }
    let mut sites: Vec<V> = deposited.grains.iter().map(|g| g.0).collect();
    let region = Rectangle {
        corners: *corners,
        around,
        size,
    };
    for _ in 0..rounds {
        let cells = region.cells(&sites)?.cells;
        for (site, cell) in sites.iter_mut().zip(cells) {
            *site = mass::of(&cell, 0.0).centre;
            if let Some(period) = around {
                let low = corners.low.x;
                site.x = low + (site.x - low).rem_euclid(period);
            }
        }
    }
    // Sorted so that neighbours in space are neighbours in memory.
    sites.sort_by_cached_key(|p| [p.y, p.x].map(|x| (x / (2.0 * size)).floor() as i64));
    region.cells(&sites)
}

/// Offsets the sides of a convex polygon inwards by `distance` (m), and removes sides shorter than
/// `shortest` (m). `None` if nothing is left.
pub fn inset(points: &[V], distance: f64, shortest: f64) -> Option<Vec<V>> {
    let n = points.len();
    let mut left = points.to_vec();
    for k in 0..n {
        let along = (points[(k + 1) % n] - points[k]).normalize();
        let depth = |p: &V| along.perp(&(p - points[k])) - distance;
        let mut kept = Vec::with_capacity(left.len() + 1);
        for (i, p) in left.iter().enumerate() {
            let q = left[(i + 1) % left.len()];
            let (here, next) = (depth(p), depth(&q));
            if here >= 0.0 {
                kept.push(*p);
            }
            if here * next < 0.0 {
                kept.push(p + (q - p) * (here / (here - next)));
            }
        }
        left = kept;
    }
    let mut out: Vec<V> = Vec::with_capacity(left.len());
    for p in left {
        if out.last().is_none_or(|q| (p - q).norm() >= shortest) {
            out.push(p);
        }
    }
    while out.len() > 1 && (out[0] - out[out.len() - 1]).norm() < shortest {
        out.pop();
    }
    (out.len() > 2).then_some(out)
}

/// A site of the triangulation, with the index of its cell unless it is an image.
struct Site {
    at: Point2<f64>,
    cell: Option<usize>,
}

impl HasPosition for Site {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// The region to fill.
struct Rectangle {
    corners: Corners<V>,
    around: Option<f64>,
    size: f64,
}

impl Rectangle {
    /// The sites and their images in the walls or across the period.
    fn with_images(&self, sites: &[V]) -> Vec<Site> {
        let (low, high) = (self.corners.low, self.corners.high);
        let mut out = Vec::with_capacity(5 * sites.len());
        for (k, p) in sites.iter().enumerate() {
            let mut add = |x: f64, y: f64, cell: Option<usize>| {
                let at = Point2::new(x, y);
                out.push(Site { at, cell });
            };
            let [left, right] = match self.around {
                Some(period) => [p.x - period, p.x + period],
                None => [2.0 * low.x - p.x, 2.0 * high.x - p.x],
            };
            add(p.x, p.y, Some(k));
            add(left, p.y, None);
            add(right, p.y, None);
            add(p.x, 2.0 * low.y - p.y, None);
            add(p.x, 2.0 * high.y - p.y, None);
        }
        out
    }

    /// Moves a corner onto the wall if it is within the tolerance of one.
    fn snapped(&self, mut p: V) -> V {
        for k in usize::from(self.around.is_some())..2 {
            for wall in [self.corners.low[k], self.corners.high[k]] {
                if (p[k] - wall).abs() < SAME * self.size {
                    p[k] = wall;
                }
            }
        }
        p
    }

    /// Position of merged corners: on every wall that one of them touches, otherwise their mean.
    fn joined(&self, members: &[V]) -> V {
        let mut at = members.iter().sum::<V>() / members.len() as f64;
        for k in usize::from(self.around.is_some())..2 {
            for wall in [self.corners.low[k], self.corners.high[k]] {
                if members.iter().any(|p| p[k] == wall) {
                    at[k] = wall;
                }
            }
        }
        at
    }

    /// The cells of the sites, in their order. `None` if rounding lost a site's cell.
    fn cells(&self, sites: &[V]) -> Option<Tiling> {
        let triangles = DelaunayTriangulation::<Site>::bulk_load(self.with_images(sites)).ok()?;
        let mut places = vec![V::zeros(); triangles.num_all_faces()];
        for face in triangles.inner_faces() {
            let c = face.circumcenter();
            places[face.fix().index()] = self.snapped(V::new(c.x, c.y));
        }
        let mut roots: Vec<usize> = (0..places.len()).collect();
        for edge in triangles.undirected_edges() {
            let [a, b] = [edge.as_directed(), edge.as_directed().rev()].map(|e| e.face());
            if let (Some(a), Some(b)) = (a.as_inner(), b.as_inner()) {
                let (a, b) = (a.fix().index(), b.fix().index());
                if (places[a] - places[b]).norm() < SHORTEST * self.size {
                    let (a, b) = (root(&roots, a), root(&roots, b));
                    roots[a.max(b)] = a.min(b);
                }
            }
        }
        let mut members: Vec<Vec<V>> = vec![Vec::new(); places.len()];
        for (k, place) in places.iter().enumerate() {
            members[root(&roots, k)].push(*place);
        }
        let mut tiling = Tiling {
            cells: vec![Vec::new(); sites.len()],
            merged: 0,
        };
        for vertex in triangles.vertices() {
            let Some(cell) = vertex.data().cell else {
                continue;
            };
            let mut around = Vec::new();
            // The corners are listed counter-clockwise.
            for edge in vertex.out_edges() {
                let face = edge.face().as_inner()?;
                around.push(face.fix().index());
            }
            let n = around.len();
            let corner = |k: usize| root(&roots, around[k % n]);
            for k in 0..n {
                if corner(k) != corner(k + 1) {
                    tiling.cells[cell].push(self.joined(&members[corner(k)]));
                } else if (places[around[k]] - places[around[(k + 1) % n]]).norm()
                    > SAME * self.size
                {
                    tiling.merged += 1;
                }
            }
        }
        let whole = tiling.cells.iter().all(|c| c.len() > 2);
        whole.then_some(tiling)
    }
}

/// Representative of the corners that are merged with this one.
fn root(roots: &[usize], mut k: usize) -> usize {
    while roots[k] != k {
        k = roots[k];
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::geometry::convex::polygon::Polygon;
    use std::collections::HashMap;

    const LOW: V = V::new(-0.3, 0.7);
    const HIGH: V = V::new(0.9, 1.5);

    fn unit_tiling(size: f64, rounds: usize, period: Option<f64>, seed: u64) -> Tiling {
        let corners = Corners {
            low: LOW,
            high: HIGH,
        };
        let periodic = Periodic {
            period: [period, None, None],
        };
        tiling(&corners, &periodic, size, rounds, seed).unwrap()
    }

    fn area(cells: &[Vec<V>]) -> f64 {
        cells.iter().map(|c| mass::of(c, 0.0).area).sum()
    }

    #[test]
    fn cells_are_convex_and_fill_the_box() {
        let whole = (HIGH.x - LOW.x) * (HIGH.y - LOW.y);
        let mut merged = 0;
        for (seed, rounds) in [(1, 0), (2, 0), (3, 0), (4, 1), (5, 20)] {
            for period in [None, Some(HIGH.x - LOW.x)] {
                let tiling = unit_tiling(0.03, rounds, period, seed);
                assert_eq!(tiling.cells.len(), (whole / 0.0009).round() as usize);
                merged += tiling.merged;
                for cell in &tiling.cells {
                    Polygon::new(cell.clone()).unwrap_or_else(|e| panic!("{e}: {cell:?}"));
                }
                // The areas add up to that of the box, so there are no holes and, since no cell is
                // inverted, no overlaps.
                assert!((area(&tiling.cells) / whole - 1.0).abs() < 1e-13);
            }
        }
        assert!(merged > 0, "no side was short enough to test with");
    }

    /// Every side coincides with a side of one neighbour, or lies on a wall.
    #[test]
    fn neighbours_share_their_sides() {
        for period in [None, Some(HIGH.x - LOW.x)] {
            let tiling = unit_tiling(0.05, 0, period, 7);
            let name = |p: &V| {
                let x = period.map_or(p.x - LOW.x, |w| {
                    let x = (p.x - LOW.x).rem_euclid(w);
                    if w - x < 1e-9 { 0.0 } else { x }
                });
                [x, p.y].map(|x| (x * 1e10).round() as i64)
            };
            let mut sides: HashMap<_, Vec<f64>> = HashMap::new();
            for cell in &tiling.cells {
                for k in 0..cell.len() {
                    let (a, b) = (cell[k], cell[(k + 1) % cell.len()]);
                    let wall = a.y == b.y && (a.y == LOW.y || a.y == HIGH.y)
                        || a.x == b.x && (a.x == LOW.x || a.x == HIGH.x);
                    if !wall {
                        let mut ends = [name(&a), name(&b)];
                        ends.sort_unstable();
                        sides.entry(ends).or_default().push((b - a).norm());
                    }
                }
            }
            assert!(sides.len() > 500);
            for lengths in sides.values() {
                assert_eq!(lengths.len(), 2);
                assert!((lengths[0] - lengths[1]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn lloyds_rounds_make_cells_alike_and_seeds_make_them_differ() {
        let spread = |tiling: &Tiling| {
            let areas: Vec<f64> = tiling.cells.iter().map(|c| mass::of(c, 0.0).area).collect();
            let mean = areas.iter().sum::<f64>() / areas.len() as f64;
            let square = areas.iter().map(|a| (a - mean).powi(2)).sum::<f64>();
            (square / areas.len() as f64).sqrt() / mean
        };
        let of = |rounds: usize| spread(&unit_tiling(0.04, rounds, None, 3));
        let (none, five, fifty) = (of(0), of(5), of(50));
        assert!(
            none > 0.2 && five < 0.7 * none && fifty < 0.7 * five,
            "{none} {five} {fifty}"
        );
        assert_eq!(unit_tiling(0.05, 2, None, 3), unit_tiling(0.05, 2, None, 3));
        assert_ne!(unit_tiling(0.05, 2, None, 3), unit_tiling(0.05, 2, None, 4));
    }

    /// A single cell is the box; a box too thin for a site has no cells.
    #[test]
    fn few_cells() {
        let square = Corners {
            low: LOW,
            high: LOW + V::new(0.8, 0.8),
        };
        let one = tiling(&square, &Periodic::default(), 0.8, 0, 1).unwrap();
        assert!((area(&one.cells) - 0.64).abs() < 1e-15);
        assert_eq!((one.cells.len(), one.cells[0].len()), (1, 4));
        let thin = Corners {
            low: LOW,
            high: V::new(HIGH.x, LOW.y + 0.01),
        };
        assert!(tiling(&thin, &Periodic::default(), 0.05, 0, 1).is_none());
    }

    /// Offsetting the sides of a polygon inwards by d reduces its area by d times the perimeter,
    /// less d² (sum of cot of half angles).
    #[test]
    fn an_inset_takes_a_band_off() {
        let cells = unit_tiling(0.1, 0, None, 5).cells;
        let mut checked = 0;
        for cell in &cells {
            let n = cell.len();
            let d = 1e-4;
            let (mut perimeter, mut corners) = (0.0, 0.0);
            for k in 0..n {
                let (before, after) =
                    (cell[k] - cell[(k + n - 1) % n], cell[(k + 1) % n] - cell[k]);
                perimeter += after.norm();
                let turn = before.perp(&after).atan2(before.dot(&after));
                corners += (0.5 * turn).tan();
            }
            let inner = inset(cell, d, 1e-12).unwrap();
            if inner.len() == n {
                let expected = mass::of(cell, 0.0).area - perimeter * d + d * d * corners;
                assert!((mass::of(&inner, 0.0).area - expected).abs() < 1e-13);
                checked += 1;
            }
        }
        assert!(checked > cells.len() / 2);
        assert!(inset(&cells[0], 0.1, 1e-12).is_none());
    }
}
