//! Division of the cells of a grid into triangles or tetrahedra that match those of their
//! neighbours.

use super::grid::{BlockGrid, Place};

/// A cell: its lowest and highest grid point, and the number of its column along each axis and of
/// its row.
pub(super) struct Cell {
    pub(super) low: Place,
    pub(super) high: Place,
    at: Place,
}

impl Cell {
    /// Returns the corners, each reached along one axis from the previous one.
    pub(super) fn corners(&self, d: usize) -> Vec<Place> {
        let corner = |k: usize| {
            let gray = k ^ (k >> 1);
            let end = |a: usize| [self.low, self.high][(gray >> a) & 1][a];
            [end(0), end(1), end(2)]
        };
        (0..1 << d).map(corner).collect()
    }
}

/// The elements of a cell: of an undivided one by the grid points of their D + 1 corners, or around
/// the centre of the cell by the D others.
pub(super) enum Cut {
    Whole(Vec<Vec<Place>>),
    Around(Vec<Vec<Place>>),
}

/// The cells of a row.
pub(super) fn cells(grid: &BlockGrid, row: usize) -> impl Iterator<Item = Cell> + '_ {
    let (d, axis) = (grid.dimension(), grid.axis());
    let set = grid.row(row);
    let counts: Vec<usize> = set.iter().map(|s| s.len().max(2) - 1).collect();
    (0..counts.iter().product()).map(move |cell| {
        let (mut rest, mut at) = (cell, [0; 3]);
        let (mut low, mut high) = ([0; 3], [0; 3]);
        for k in 0..d {
            if k == axis {
                (at[k], low[k], high[k]) = (row, row, row + 1);
            } else {
                at[k] = rest % counts[k];
                rest /= counts[k];
                (low[k], high[k]) = (set[k][at[k]], set[k][at[k] + 1]);
            }
        }
        Cell { low, high, at }
    })
}

/// Divides a cell. Elements have positive volume where the coordinates increase along all axes.
pub(super) fn cut(grid: &BlockGrid, cell: &Cell) -> Cut {
    let d = grid.dimension();
    if d == 3 && is_plain(grid, cell) {
        let mut whole = paths(cell);
        for element in &mut whole {
            orient(element, None, d);
        }
        return Cut::Whole(whole);
    }
    let mut facets = if d == 2 {
        let order = [(1, 0), (0, 1), (1, 1), (0, 0)];
        let face = |(axis, end)| edges(grid, cell, axis, end);
        order.into_iter().flat_map(face).collect::<Vec<_>>()
    } else {
        let order = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
        let face = |(axis, end)| triangles(grid, cell, axis, end);
        order.flat_map(face).collect()
    };
    for facet in &mut facets {
        orient(facet, Some(cell), d);
    }
    Cut::Around(facets)
}

/// Returns whether a cell in space has no points except its corners, and the diagonals of its faces
/// are those of [`paths`].
fn is_plain(grid: &BlockGrid, cell: &Cell) -> bool {
    let row = cell.at[grid.axis()];
    let others = (0..3).filter(|k| *k != grid.axis());
    others.into_iter().all(|k| {
        [row, row + 1].iter().all(|plane| {
            let (first, stops) = grid.between(*plane, k, [cell.low[k], cell.high[k]]);
            stops.len() == 2 && first % 2 == cell.at[k] % 2
        })
    })
}

/// Returns the tetrahedra of a cell along the paths from one corner to the opposite one, along one
/// axis after the other (Kuhn). Paths begin where all numbers are even, so that the diagonal of a
/// face goes from its corner with even numbers to that with odd numbers.
fn paths(cell: &Cell) -> Vec<Vec<Place>> {
    let orders = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    let ends = |k: usize| {
        let [low, high] = [cell.low[k], cell.high[k]];
        if cell.at[k].is_multiple_of(2) {
            [low, high]
        } else {
            [high, low]
        }
    };
    let one = |order: [usize; 3]| {
        let mut corner = [0, 1, 2].map(|k| ends(k)[0]);
        let mut path = vec![corner];
        for axis in order {
            corner[axis] = ends(axis)[1];
            path.push(corner);
        }
        path
    };
    orders.map(one).to_vec()
}

/// The parts of an edge of a cell in the plane.
fn edges(grid: &BlockGrid, cell: &Cell, axis: usize, end: usize) -> Vec<Vec<Place>> {
    let along = 1 - axis;
    let mut place = cell.low;
    place[axis] = [cell.low, cell.high][end][axis];
    let whole = [cell.low[along], cell.high[along]];
    let stops = match axis == grid.axis() {
        true => grid.between(place[axis], along, whole).1,
        false => &whole,
    };
    let at = |stop: usize| {
        let mut out = place;
        out[along] = stop;
        out
    };
    stops.windows(2).map(|w| vec![at(w[0]), at(w[1])]).collect()
}

/// Returns the triangles of a face of a cell in space; the adjacent cell has the same ones.
fn triangles(grid: &BlockGrid, cell: &Cell, axis: usize, end: usize) -> Vec<Vec<Place>> {
    let mut place = cell.low;
    place[axis] = [cell.low, cell.high][end][axis];
    let up = grid.axis();
    if axis == up {
        let [a, b] = others(axis);
        let stops = |k| grid.between(place[axis], k, [cell.low[k], cell.high[k]]);
        let ((i, along), (j, across)) = (stops(a), stops(b));
        let mut out = Vec::new();
        for (j, w) in across.windows(2).enumerate().map(|(k, w)| (j + k, w)) {
            for (i, v) in along.windows(2).enumerate().map(|(k, v)| (i + k, v)) {
                out.extend(halves(place, [a, b], [[v[0], v[1]], [w[0], w[1]]], i + j));
            }
        }
        return out;
    }
    // This is the other axis of the columns.
    let along = 3 - axis - up;
    let (row, ends) = (cell.at[up], [cell.low[along], cell.high[along]]);
    let planes = [row, row + 1];
    let inside = |k: &usize| {
        let stops = grid.between(*k, along, ends).1;
        stops[1..stops.len() - 1].first().copied()
    };
    let at = |stop: usize, plane: usize| {
        let mut out = place;
        (out[along], out[up]) = (stop, plane);
        out
    };
    for (near, far) in [(row, row + 1), (row + 1, row)] {
        let Some(middle) = inside(&near) else {
            continue;
        };
        let [low, high] = ends;
        let middle = at(middle, near);
        return vec![
            vec![at(low, near), middle, at(low, far)],
            vec![at(low, far), middle, at(high, far)],
            vec![at(high, far), middle, at(high, near)],
        ];
    }
    halves(place, [along, up], [ends, planes], cell.at[along] + row).to_vec()
}

/// Returns the two other axes.
fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Divides a rectangle along two axes along a diagonal, from the corner with even to that with odd
/// numbers; `sum` is the sum of the numbers of its low ends.
fn halves(
    place: Place,
    [a, b]: [usize; 2],
    [along, across]: [[usize; 2]; 2],
    sum: usize,
) -> [Vec<Place>; 2] {
    let at = |i: usize, j: usize| {
        let mut out = place;
        (out[a], out[b]) = (along[i], across[j]);
        out
    };
    // Where the sum is odd, the numbers along one axis are odd and those along the other even.
    let k = sum % 2;
    [0, 1].map(|other| {
        vec![
            at(0, k),
            at(1, 1 - k),
            at(other, if other == k { 1 } else { 0 }),
        ]
    })
}

/// Swaps the first two corners of an inverted element; the centre of a cell is its last corner if
/// it has one.
fn orient(corners: &mut [Place], around: Option<&Cell>, d: usize) {
    // Coordinates are doubled, so that a centre has whole numbers.
    let doubled = corners.iter().map(|p| p.map(|k| 2 * k as i64));
    let centre = around.map(|c| [0, 1, 2].map(|k| (c.low[k] + c.high[k]) as i64));
    let all: Vec<[i64; 3]> = doubled.chain(centre).collect();
    let edge = |k: usize| [0, 1, 2].map(|a| all[k][a] - all[0][a]);
    let ([a, b], c) = ([edge(1), edge(2)], all.get(3).map(|_| edge(3)));
    let turn = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    let volume = match c {
        Some(c) if d == 3 => turn(1, 2) * c[0] + turn(2, 0) * c[1] + turn(0, 1) * c[2],
        _ => turn(0, 1),
    };
    if volume < 0 {
        corners.swap(0, 1);
    }
}
