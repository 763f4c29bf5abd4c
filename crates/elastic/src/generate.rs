//! Meshes of simple bodies.

mod cells;
mod grid;
#[cfg(test)]
mod grid_tests;
#[cfg(test)]
mod tests;

use crate::mesh::{Mesh, MeshError};
use cells::{Cut, cells, cut};
use fretwork_core::geometry::space::{Space, VectorLike};
use grid::Place;
pub use grid::{BlockGrid, Coarsening, GridError};
use std::collections::BTreeMap;

/// Names of the sides of a block, at the low and the high end of each axis. In 2D `bottom` and
/// `top` are normal to y, in 3D to z.
const SIDES: [&[[&str; 2]]; 2] = [
    &[["left", "right"], ["bottom", "top"]],
    &[["left", "right"], ["front", "back"], ["bottom", "top"]],
];

/// Creates a block with the given coordinates of its points along each axis (m), which must
/// increase. Its sides are the parts `left` and `right` (x), `bottom` and `top` (y in 2D, z in 3D),
/// `front` and `back` (y in 3D).
///
/// In 2D each cell is divided in four by its centre, so that all points of a side are equivalent.
/// In 3D it is divided along the paths from one corner to the opposite one (Kuhn's simplices),
/// mirrored from cell to cell so that no direction is preferred; points of a side then have
/// alternately more and fewer elements.
///
/// # Errors
/// Fails with fewer than two coordinates along an axis, or coordinates that do not increase:
/// elements would have no volume.
pub fn block<S: Space>(coordinates: &[Vec<f64>]) -> Result<Mesh<S>, MeshError> {
    mapped_block(coordinates, |x| *x)
}

/// Creates a [`block`] whose points are moved before its cells are divided.
///
/// # Errors
/// Fails with fewer than two coordinates along an axis, coordinates that do not increase, or points
/// or elements that the map makes invalid.
pub fn mapped_block<S: Space>(
    coordinates: &[Vec<f64>],
    map: impl Fn(&S::Vector) -> S::Vector,
) -> Result<Mesh<S>, MeshError> {
    let grid = BlockGrid::new(coordinates).map_err(|_| MeshError::Empty(S::D))?;
    mapped_grid(&grid, map)
}

/// Creates the mesh of a grid in the dimension of the space, whose points are moved before the
/// cells are divided; its sides are parts like those of a [`block`].
///
/// A cell with a point of a smaller cell on its side is divided by its centre, in triangles or, in
/// 3D, in tetrahedra on the triangles of its faces, which its neighbours share.
///
/// # Errors
/// Fails if the map makes points or elements invalid, or for a grid of another dimension.
pub fn mapped_grid<S: Space>(
    grid: &BlockGrid,
    map: impl Fn(&S::Vector) -> S::Vector,
) -> Result<Mesh<S>, MeshError> {
    let (d, up) = (S::D, grid.axis());
    if grid.dimension() != d {
        return Err(MeshError::Empty(d));
    }
    let lines = grid.lines();
    let counts: Vec<usize> = lines.iter().map(Vec::len).collect();
    let mut points = Vec::with_capacity(grid.points());
    // First point of each plane between rows, and index offset to the next point along each axis.
    let mut planes: Vec<(usize, Place)> = Vec::with_capacity(grid.rows() + 1);
    for k in 0..=grid.rows() {
        let stops = grid.plane(k);
        let (mut stride, mut total) = ([0; 3], 1);
        for axis in (0..d).filter(|a| *a != up) {
            stride[axis] = total;
            total *= stops[axis].len();
        }
        planes.push((points.len(), stride));
        for p in 0..total {
            let mut point = S::Vector::zero();
            for axis in 0..d {
                let stop = match axis == up {
                    true => k,
                    false => stops[axis][p / stride[axis] % stops[axis].len()],
                };
                point[axis] = lines[axis][stop];
            }
            points.push(map(&point));
        }
    }
    let index = |place: &Place| {
        let (first, stride) = planes[place[up]];
        let along = (0..d).filter(|a| *a != up).map(|axis| {
            let (at, _) = grid.between(place[up], axis, [place[axis]; 2]);
            at * stride[axis]
        });
        (first + along.sum::<usize>()) as u32
    };
    let mut elements = Vec::new();
    let mut parts: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for cell in (0..grid.rows()).flat_map(|row| cells(grid, row)) {
        let (pieces, centre) = match cut(grid, &cell) {
            Cut::Whole(pieces) => (pieces, None),
            Cut::Around(pieces) => {
                let corners = cell.corners(d);
                let share = 1.0 / corners.len() as f64;
                let middle = corners.iter().fold(S::Vector::zero(), |sum, c| {
                    sum + points[index(c) as usize] * share
                });
                points.push(middle);
                (pieces, Some(points.len() as u32 - 1))
            }
        };
        for places in pieces {
            let corners: Vec<u32> = places.iter().map(index).collect();
            name_sides(&counts, &places, &corners, &mut parts);
            elements.extend(corners.into_iter().chain(centre));
        }
    }
    Mesh::new(points, elements, &parts)
}

/// Adds the facets between the given points of an element that lie in sides of the block.
fn name_sides(
    counts: &[usize],
    places: &[Place],
    corners: &[u32],
    parts: &mut BTreeMap<String, Vec<u32>>,
) {
    let d = counts.len();
    for (axis, names) in SIDES[d - 2].iter().enumerate() {
        for (end, name) in names.iter().enumerate() {
            let side = end * (counts[axis] - 1);
            let on: Vec<u32> = (0..places.len())
                .filter(|c| places[*c][axis] == side)
                .map(|c| corners[c])
                .collect();
            if on.len() == d {
                parts.entry((*name).to_owned()).or_default().extend(on);
            }
        }
    }
}

/// Returns coordinates from `from` to `to` (m) in `cells` equal parts.
pub fn even(from: f64, to: f64, cells: usize) -> Vec<f64> {
    (0..=cells)
        .map(|k| from + (to - from) * (k as f64 / cells as f64))
        .collect()
}

/// Returns coordinates from `from` to `to` (m) whose parts have the length `first` at `from` and
/// grow by at most the ratio `growth` from one to the next. The lengths are scaled to end at `to`.
pub fn graded(from: f64, to: f64, first: f64, growth: f64) -> Vec<f64> {
    let (length, mut part) = ((to - from).abs(), first);
    let mut sums = vec![0.0];
    while sums[sums.len() - 1] < length * (1.0 - 1e-9) {
        sums.push(sums[sums.len() - 1] + part);
        part *= growth.max(1.0);
    }
    let last = sums[sums.len() - 1];
    sums.iter().map(|s| from + (to - from) * s / last).collect()
}
