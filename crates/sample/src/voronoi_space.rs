//! Voronoi cells that fill a box: polyhedra that fit each other face to face.
//!
//! A cell is the box cut by the bisecting planes of the other sites, the nearest first, until the
//! next site is farther away than twice the farthest corner and cannot cut the cell (as in Rycroft,
//! Chaos 19 (2009) 041111). Three planes meet in a corner; they and the cell's site name it, and
//! its position is computed from that name, so all cells around a corner have identical
//! coordinates. Removing short edges would bend faces, so the sites of cells with short edges are
//! moved a little instead.

use super::cutting::{Corner, centre, cut, ordered, sides_of};
use super::deposit::{Corners, deposit};
use super::sizes::Sizes;
use super::voronoi::SHORTEST;
use fretwork_core::geometry::convex::polyhedron::normal;
use fretwork_core::geometry::periodic::Periodic;
use fretwork_core::geometry::space::Dim3;
use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

type V = Vector3<f64>;

/// Displacement of a site whose cell has a short edge, as a fraction of the cell size.
const NUDGE: f64 = 0.02;
/// Limit on the number of rounds in which sites are moved; each round leaves about a fifth of the
/// short edges.
const NUDGES: usize = 100;

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Corners (m).
    pub points: Vec<V>,
    /// Faces as corner indices, counter-clockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Index of the cell beyond each face; `None` for a wall.
    pub beyond: Vec<Option<u32>>,
}

/// A Voronoi tiling of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceTiling {
    /// The cells, sorted so that neighbours in space are near in memory. Across a period, cells
    /// extend beyond the box.
    pub cells: Vec<Cell>,
    /// Number of times a site was moved.
    pub moved: usize,
}

/// Reason why no tiling was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The box is thinner than half a cell.
    Thin,
    /// Short edges remain after all rounds of moving the sites.
    Short,
}

/// Fills a box with about volume/size³ cells, periodic along each axis where the box spans the
/// period.
///
/// # Errors
/// The sites do not fit into the box, or their cells keep edges shorter than [`SHORTEST`] times the
/// size.
pub fn tiling(
    corners: &Corners<V>,
    periodic: &Periodic,
    size: f64,
    rounds: usize,
    seed: u64,
) -> Result<SpaceTiling, Failure> {
    let count = (corners.volume() / size.powi(3)).round().max(1.0) as usize;
    let wide = corners.high - corners.low;
    let around = [0, 1, 2].map(|k| periodic.period[k].filter(|p| wide[k] >= p * (1.0 - 1e-9)));
    let apart = Sizes::power((0.25 * size, 0.25 * size), 0.0);
    let periods = Periodic { period: around };
    let deposited = deposit::<Dim3>(count, &apart, corners, &periods, seed);
    if deposited.grains.len() < count {
        return Err(Failure::Thin);
    }
    let region = BoxRegion {
        corners: *corners,
        around,
        size,
    };
    let mut sites: Vec<V> = deposited.grains.iter().map(|g| g.0).collect();
    for _ in 0..rounds {
        let moves: Vec<V> = region.cut_all(&sites).iter().map(|c| centre(c)).collect();
        for (site, way) in sites.iter_mut().zip(moves) {
            *site = region.wrapped(*site + way);
        }
    }
    // Sorted so that neighbours in space are neighbours in memory.
    sites.sort_by_cached_key(|p| [p.z, p.y, p.x].map(|x| (x / (2.0 * size)).floor() as i64));
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut moved = 0;
    let mut cut = region.cut_all(&sites);
    let to_move = |cut: &[Vec<Corner<Side>>], i: usize| region.is_to_move(i, &cut[i]);
    let mut short: Vec<bool> = (0..sites.len()).map(|i| to_move(&cut, i)).collect();
    for _ in 0..NUDGES {
        let short_cells: Vec<usize> = (0..sites.len()).filter(|i| short[*i]).collect();
        if short_cells.is_empty() {
            let cells = cut.iter().enumerate();
            let cells = cells.map(|(i, corners)| region.finished(&sites, i, corners));
            let cells: Option<Vec<Cell>> = cells.collect();
            let tiling = cells.map(|cells| SpaceTiling { cells, moved });
            return tiling.ok_or(Failure::Short);
        }
        moved += short_cells.len();
        let left: Vec<V> = short_cells.iter().map(|i| sites[*i]).collect();
        for i in &short_cells {
            let way = V::from_fn(|_, _| rng.random_range(-1.0..1.0)) * (NUDGE * size);
            sites[*i] = region.wrapped(sites[*i] + way);
        }
        for i in region.cut_again(&sites, &short_cells, &left, &mut cut) {
            short[i] = to_move(&cut, i);
        }
    }
    Err(Failure::Short)
}

/// Offsets the faces of a cell inwards by `distance` (m); `None` if nothing is left.
pub fn inset(cell: &Cell, distance: f64) -> Option<(Vec<V>, Vec<Vec<u32>>)> {
    let normals: Vec<V> = cell.faces.iter().map(|f| normal(&cell.points, f)).collect();
    let mut sides: Vec<Vec<usize>> = vec![Vec::new(); cell.points.len()];
    for (f, face) in cell.faces.iter().enumerate() {
        face.iter().for_each(|c| sides[*c as usize].push(f));
    }
    let corners = cell.points.iter().zip(sides);
    let corners = corners.map(|(at, s)| Some((*at, <[usize; 3]>::try_from(s).ok()?)));
    let mut corners: Vec<Corner<usize>> = corners
        .map(|c| c.map(|(at, sides)| Corner { at, sides }))
        .collect::<Option<_>>()?;
    for (f, face) in cell.faces.iter().enumerate() {
        let height = cell.points[face[0] as usize].dot(&normals[f]) - distance;
        cut(&mut corners, f, &normals[f], height);
    }
    let left = |f: &usize| corners.iter().any(|c| c.sides.contains(f));
    let faces = (0..normals.len()).filter(left);
    let faces = faces.map(|f| ordered(&corners, f, &normals[f])).collect();
    let points: Vec<V> = corners.iter().map(|c| c.at).collect();
    (points.len() > 3).then_some((points, faces))
}

/// A plane that bounds a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Side {
    /// The bisector with a site's image, and its offset in periods.
    Site(u32, [i8; 3]),
    /// A wall: its axis, and whether it is the high one.
    Wall(usize, bool),
}

/// A site's image: the site, and its offset in periods.
type Image = (u32, [i8; 3]);

/// Sites and images sorted into cubes, counted from a low corner. If most cubes would be empty,
/// 2^`merged` cubes along each axis are combined.
struct Cubes {
    merged: u32,
    low: [i64; 3],
    counts: [usize; 3],
    starts: Vec<u32>,
    images: Vec<Image>,
}

impl Cubes {
    /// Builds the grid from the images and their cubes.
    fn new(placed: &[([i64; 3], Image)]) -> Self {
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        if placed.is_empty() {
            (low, high) = ([0; 3], [0; 3]);
        }
        for (cube, _) in placed {
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(cube[k]), high[k].max(cube[k]));
            }
        }
        let (mut merged, mut counts) = (0, [0; 3]);
        for shift in 0..64 {
            merged = shift;
            counts = [0, 1, 2]
                .map(|k| (high[k] >> shift).abs_diff(low[k] >> shift) as usize)
                .map(|n| n.saturating_add(1));
            let all: f64 = counts.iter().map(|n| *n as f64).product();
            if all <= 8.0 * placed.len() as f64 + 64.0 {
                break;
            }
        }
        let low = low.map(|c| c >> merged);
        let mut out = Self {
            merged,
            low,
            counts,
            starts: vec![0; counts.iter().product::<usize>() + 1],
            images: vec![(0, [0; 3]); placed.len()],
        };
        let place = |out: &Self, cube: &[i64; 3]| {
            let [x, y, z] = [0, 1, 2].map(|k| ((cube[k] >> merged) - low[k]) as usize);
            (z * out.counts[1] + y) * out.counts[0] + x
        };
        for (cube, _) in placed {
            let at = place(&out, cube);
            out.starts[at + 1] += 1;
        }
        for k in 1..out.starts.len() {
            out.starts[k] += out.starts[k - 1];
        }
        let mut next = out.starts.clone();
        for (cube, image) in placed {
            let at = place(&out, cube);
            out.images[next[at] as usize] = *image;
            next[at] += 1;
        }
        out
    }

    /// Visits all images in a range of cubes.
    fn between(&self, from: [i64; 3], to: [i64; 3], mut found: impl FnMut(Image)) {
        let range = |k: usize| {
            let place = |cube: i64| (cube >> self.merged).saturating_sub(self.low[k]);
            let most = self.counts[k] as i64;
            let end = place(to[k]).saturating_add(1).clamp(0, most);
            place(from[k]).clamp(0, most) as usize..end as usize
        };
        let along = range(0);
        for z in range(2) {
            for y in range(1) {
                // Cubes along x are adjacent in memory.
                let row = (z * self.counts[1] + y) * self.counts[0];
                let [first, last] = [along.start, along.end].map(|x| self.starts[row + x] as usize);
                self.images[first..last.max(first)]
                    .iter()
                    .for_each(|image| found(*image));
            }
        }
    }
}

/// Twice the distance of the farthest corner from the site: sites farther away do not cut the cell.
fn farthest(corners: &[Corner<Side>]) -> f64 {
    2.0 * corners.iter().map(|c| c.at.norm()).fold(0.0, f64::max)
}

/// The region to fill.
struct BoxRegion {
    corners: Corners<V>,
    around: [Option<f64>; 3],
    size: f64,
}

impl BoxRegion {
    /// Wraps a position into the box across periods, and keeps it at least a twentieth of a cell
    /// from walls.
    fn wrapped(&self, mut at: V) -> V {
        for k in 0..3 {
            let (low, high) = (self.corners.low[k], self.corners.high[k]);
            at[k] = match self.around[k] {
                Some(period) => low + (at[k] - low).rem_euclid(period),
                None => at[k].clamp(low + 0.05 * self.size, high - 0.05 * self.size),
            };
        }
        at
    }

    fn shift(&self, periods: [i8; 3]) -> V {
        V::from_fn(|k, _| self.around[k].map_or(0.0, |p| p * f64::from(periods[k])))
    }

    /// The sites and their images, sorted into cubes of the cell size.
    fn cubes(&self, sites: &[V]) -> Cubes {
        let images = |k: usize| -> &[i8] {
            if self.around[k].is_some() {
                &[-1, 0, 1]
            } else {
                &[0]
            }
        };
        let mut placed = Vec::new();
        for (i, site) in sites.iter().enumerate() {
            for &x in images(0) {
                for &y in images(1) {
                    for &z in images(2) {
                        let cube = self.cube(&(site + self.shift([x, y, z])));
                        placed.push((cube, (i as u32, [x, y, z])));
                    }
                }
            }
        }
        Cubes::new(&placed)
    }

    fn cube(&self, at: &V) -> [i64; 3] {
        [0, 1, 2].map(|k| (at[k] / self.size).floor() as i64)
    }

    /// Cuts all cells and returns their corners relative to their sites.
    fn cut_all(&self, sites: &[V]) -> Vec<Vec<Corner<Side>>> {
        let cubes = self.cubes(sites);
        (0..sites.len())
            .map(|i| self.cell(sites, &cubes, i))
            .collect()
    }

    /// Updates the corners after some sites moved. Only cells near enough to be affected change: a
    /// site farther from a cell than twice its farthest corner neither cut it before nor cuts it
    /// now. Returns the cells.
    fn cut_again(
        &self,
        sites: &[V],
        moved: &[usize],
        left: &[V],
        cut: &mut [Vec<Corner<Side>>],
    ) -> Vec<usize> {
        const MARGIN: f64 = 1.0 + 1e-6;
        let cubes = self.cubes(sites);
        let limits: Vec<f64> = cut.iter().map(|c| MARGIN * farthest(c)).collect();
        let reach = limits.iter().copied().fold(0.0, f64::max);
        let mut touched = vec![false; sites.len()];
        moved.iter().for_each(|i| touched[*i] = true);
        for place in left.iter().chain(moved.iter().map(|i| &sites[*i])) {
            self.near(&cubes, place, reach, |(j, periods)| {
                let j = j as usize;
                let far = (sites[j] + self.shift(periods) - place).norm();
                touched[j] |= far <= limits[j];
            });
        }
        let touched: Vec<usize> = (0..sites.len()).filter(|i| touched[*i]).collect();
        for i in &touched {
            cut[*i] = self.cell(sites, &cubes, *i);
        }
        touched
    }

    /// Visits all images in the cubes within a distance of a point.
    fn near(&self, cubes: &Cubes, place: &V, reach: f64, found: impl FnMut(Image)) {
        let [low, high] = [-reach, reach].map(|r| self.cube(&(place + V::repeat(r))));
        cubes.between(low, high, found);
    }

    /// Cuts one cell and returns its corners relative to its site.
    fn cell(&self, sites: &[V], cubes: &Cubes, i: usize) -> Vec<Corner<Side>> {
        let own = sites[i];
        let mut corners = self.whole(i, &own);
        let (mut done, mut reach) = (0.0, 2.0 * self.size);
        loop {
            let mut near = Vec::new();
            self.near(cubes, &own, reach, |(j, periods)| {
                let way = sites[j as usize] + self.shift(periods) - own;
                let far = way.norm();
                // The initial box is already bounded by the site's own images.
                if j as usize != i && far > done && far <= reach {
                    near.push((far, j, periods, way));
                }
            });
            near.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            let mut limit = farthest(&corners);
            for (far, j, periods, way) in near {
                if far > limit {
                    break;
                }
                let side = Side::Site(j, periods);
                if cut(&mut corners, side, &(way / far), 0.5 * far) {
                    limit = farthest(&corners);
                }
            }
            if limit <= reach {
                return corners;
            }
            (done, reach) = (reach, 2.0 * reach);
        }
    }

    /// The corners of the initial box relative to a site. Along periodic axes they are half a
    /// period away.
    fn whole(&self, i: usize, own: &V) -> Vec<Corner<Side>> {
        let side = |k: usize, high: bool| match self.around[k] {
            Some(period) => {
                let mut periods = [0; 3];
                periods[k] = if high { 1 } else { -1 };
                let place = 0.5 * period * f64::from(periods[k]);
                (Side::Site(i as u32, periods), place)
            }
            None => (Side::Wall(k, high), self.wall(k, high) - own[k]),
        };
        (0..8)
            .map(|c| {
                let of = [0, 1, 2].map(|k| side(k, c >> k & 1 == 1));
                Corner {
                    at: V::from(of.map(|s| s.1)),
                    sides: of.map(|s| s.0),
                }
            })
            .collect()
    }

    /// Whether a cell has a short edge of which its site is the first.
    fn is_to_move(&self, i: usize, corners: &[Corner<Side>]) -> bool {
        let first = |s: &Side| match s {
            Side::Site(j, _) => i <= *j as usize,
            Side::Wall(..) => true,
        };
        corners.iter().enumerate().any(|(k, c)| {
            corners[..k].iter().any(|d| {
                (c.at - d.at).norm() < SHORTEST * self.size
                    && c.edge(d).is_some_and(|sides| sides.iter().all(first))
            })
        })
    }

    /// The cell in absolute coordinates. `None` if a corner's position, computed from its name, is
    /// inconsistent with the cut.
    fn finished(&self, sites: &[V], i: usize, corners: &[Corner<Side>]) -> Option<Cell> {
        let own = sites[i];
        let points: Option<Vec<V>> = corners
            .iter()
            .map(|c| {
                let at = self.place(sites, i, &c.sides)?;
                ((at - own - c.at).norm() < 0.01 * SHORTEST * self.size).then_some(at)
            })
            .collect();
        let sides = sides_of(corners);
        let outward = |side: &Side| match side {
            Side::Site(j, periods) => (sites[*j as usize] + self.shift(*periods) - own).normalize(),
            Side::Wall(k, high) => V::ith(*k, if *high { 1.0 } else { -1.0 }),
        };
        let neighbour = |side: &Side| match side {
            Side::Site(j, _) => Some(*j),
            Side::Wall(..) => None,
        };
        Some(Cell {
            points: points?,
            faces: sides
                .iter()
                .map(|s| ordered(corners, *s, &outward(s)))
                .collect(),
            beyond: sides.iter().map(neighbour).collect(),
        })
    }

    /// The intersection of a corner's planes, computed identically for all cells around it.
    fn place(&self, sites: &[V], i: usize, sides: &[Side; 3]) -> Option<V> {
        let mut name = [Side::Site(i as u32, [0; 3]), sides[0], sides[1], sides[2]];
        name.sort_unstable();
        // The position is computed relative to the first site of the name; there is always one.
        let Side::Site(first, base) = name[0] else {
            return None;
        };
        let origin = sites[first as usize];
        let (mut rows, mut heights) = (Matrix3::zeros(), V::zeros());
        for (row, side) in name[1..].iter().enumerate() {
            match side {
                Side::Site(j, periods) => {
                    let periods = [0, 1, 2].map(|k| periods[k] - base[k]);
                    let way = sites[*j as usize] + self.shift(periods) - origin;
                    let far = way.norm();
                    rows.set_row(row, &(way / far).transpose());
                    heights[row] = 0.5 * far;
                }
                Side::Wall(k, high) => {
                    rows[(row, *k)] = 1.0;
                    heights[row] = self.wall(*k, *high) - origin[*k];
                }
            }
        }
        let mut at = origin + rows.try_inverse()? * heights;
        for side in &name {
            if let Side::Wall(k, high) = side {
                at[*k] = self.wall(*k, *high);
            }
        }
        Some(at + self.shift(base))
    }

    fn wall(&self, axis: usize, high: bool) -> f64 {
        let corners = [self.corners.low, self.corners.high];
        corners[usize::from(high)][axis]
    }
}

#[cfg(test)]
#[path = "voronoi_space_tests.rs"]
mod tests;
