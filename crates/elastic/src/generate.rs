//! Meshes of simple bodies.

use crate::mesh::{Mesh, MeshError};
use fretwork_core::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;

/// Names of the sides of a block, at the low and the high end of each axis. In 2D `bottom` and `top` are those of y, in 3D
/// those of z.
const SIDES: [&[[&str; 2]]; 2] = [
    &[["left", "right"], ["bottom", "top"]],
    &[["left", "right"], ["front", "back"], ["bottom", "top"]],
];

/// A block with the given coordinates of its points along each axis (m), which must rise. Its sides are the parts `left` and
/// `right` (x), `bottom` and `top` (y in 2D, z in 3D), `front` and `back` (y in 3D).
///
/// In 2D each cell is cut in four by its centre, so that all points of a side are alike. In 3D it is cut along the paths from one
/// corner to the opposite one (Kuhn's simplices), mirrored from cell to cell so that no direction of the cuts is preferred; points
/// of a side then have more and fewer elements in turn.
///
/// # Errors
/// Fewer than two coordinates along an axis, or some that do not rise: elements without volume.
pub fn block<S: Space>(coordinates: &[Vec<f64>]) -> Result<Mesh<S>, MeshError> {
    mapped_block(coordinates, |x| *x)
}

/// A [`block`] whose points are moved before its cells are cut.
///
/// # Errors
/// As for a block, and points or elements that the map makes invalid.
pub fn mapped_block<S: Space>(
    coordinates: &[Vec<f64>],
    map: impl Fn(&S::Vector) -> S::Vector,
) -> Result<Mesh<S>, MeshError> {
    let d = S::D;
    let counts: Vec<usize> = (0..d)
        .map(|k| coordinates.get(k).map_or(0, Vec::len))
        .collect();
    if counts.iter().any(|n| *n < 2) {
        return Err(MeshError::Empty(d));
    }
    let index = |at: &[usize]| (0..d).rev().fold(0, |sum, k| sum * counts[k] + at[k]) as u32;
    let total: usize = counts.iter().product();
    let mut points = Vec::with_capacity(total);
    for p in 0..total {
        let (mut rest, mut point) = (p, S::Vector::zero());
        for k in 0..d {
            point[k] = coordinates[k][rest % counts[k]];
            rest /= counts[k];
        }
        points.push(map(&point));
    }
    let mut elements = Vec::new();
    let mut parts: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    let cells: usize = counts.iter().map(|n| n - 1).product();
    for cell in 0..cells {
        let (mut rest, mut at) = (cell, vec![0; d]);
        for k in 0..d {
            at[k] = rest % (counts[k] - 1);
            rest /= counts[k] - 1;
        }
        if d == 2 {
            let corner = |i: usize, j: usize| [at[0] + i, at[1] + j];
            let around = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let centre = points.len() as u32;
            let middle = around.iter().fold(S::Vector::zero(), |sum, c| {
                sum + points[index(c) as usize] * 0.25
            });
            points.push(middle);
            for k in 0..4 {
                let ends = [around[k], around[(k + 1) % 4]];
                let edge = ends.map(|c| index(&c));
                name_sides(2, &counts, &ends.map(Vec::from), &edge, &mut parts);
                elements.extend([edge[0], edge[1], centre]);
            }
            continue;
        }
        for element in cell_simplices(&at) {
            let corner = |c: &Vec<usize>| index(c);
            let corners: Vec<u32> = element.iter().map(corner).collect();
            name_sides(d, &counts, &element, &corners, &mut parts);
            elements.extend(corners);
        }
    }
    Mesh::new(points, elements, &parts)
}

/// Tetrahedra of a cell, as the places of their points in the grid.
fn cell_simplices(at: &[usize]) -> Vec<Vec<Vec<usize>>> {
    // Permutations of the axes with their parity.
    let orders: [([usize; 3], bool); 6] = [
        ([0, 1, 2], false),
        ([1, 2, 0], false),
        ([2, 0, 1], false),
        ([0, 2, 1], true),
        ([2, 1, 0], true),
        ([1, 0, 2], true),
    ];
    let mirrored = at.iter().filter(|i| *i % 2 == 1).count() % 2 == 1;
    let one = |(order, odd): &([usize; 3], bool)| {
        // The path from a corner to the opposite one, along one axis after the other.
        let mut corner: Vec<usize> = at.iter().map(|i| i + i % 2).collect();
        let mut path = vec![corner.clone()];
        for axis in order {
            corner[*axis] = at[*axis] + 1 - at[*axis] % 2;
            path.push(corner.clone());
        }
        if *odd != mirrored {
            path.swap(0, 1);
        }
        path
    };
    orders.iter().map(one).collect()
}

/// Adds the facets of an element, given by its points in the grid, that lie in sides of the block.
fn name_sides(
    d: usize,
    counts: &[usize],
    element: &[Vec<usize>],
    corners: &[u32],
    parts: &mut BTreeMap<String, Vec<u32>>,
) {
    for (axis, names) in SIDES[d - 2].iter().enumerate() {
        for (end, name) in names.iter().enumerate() {
            let side = end * (counts[axis] - 1);
            let on: Vec<u32> = (0..element.len())
                .filter(|c| element[*c][axis] == side)
                .map(|c| corners[c])
                .collect();
            if on.len() == d {
                parts.entry((*name).to_owned()).or_default().extend(on);
            }
        }
    }
}

/// Coordinates from `from` to `to` (m) in `cells` equal parts.
pub fn even(from: f64, to: f64, cells: usize) -> Vec<f64> {
    (0..=cells)
        .map(|k| from + (to - from) * (k as f64 / cells as f64))
        .collect()
}

/// Coordinates from `from` to `to` (m) whose parts have the length `first` at `from` and grow by at most the ratio `growth` from
/// one to the next. The lengths are scaled to end at `to`.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Simplex;
    use fretwork_core::geometry::space::{Dim2, Dim3};

    fn volume<S: Space>(mesh: &Mesh<S>) -> f64 {
        mesh.elements()
            .map(|e| Simplex::<S>::new(&mesh.corners(e)).unwrap().volume)
            .sum()
    }

    #[test]
    fn blocks_fill_their_box() {
        let mesh = block::<Dim2>(&[even(0.0, 3.0, 5), even(-1.0, 1.0, 4)]).unwrap();
        assert!((volume(&mesh) - 6.0).abs() < 1e-12);
        assert_eq!((mesh.elements().len(), mesh.facets()), (80, 18));
        assert_eq!(mesh.points_of("top").unwrap().len(), 6);
        let mesh = block::<Dim3>(&[even(0.0, 3.0, 3), even(-1.0, 1.0, 2), even(0.0, 0.5, 4)]);
        let mesh = mesh.unwrap();
        assert!((volume(&mesh) - 3.0).abs() < 1e-12);
        assert_eq!(mesh.facets(), 2 * 2 * (6 + 12 + 8));
        let area = |name: &str| -> f64 {
            let facets = mesh.part(name).unwrap().iter();
            facets.map(|f| mesh.facet_area(*f as usize)).sum()
        };
        for (name, expected) in [("left", 1.0), ("back", 1.5), ("bottom", 6.0)] {
            assert!((area(name) - expected).abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn graded_coordinates_end_where_they_should() {
        let x = graded(0.0, -2.0, 0.1, 1.5);
        assert_eq!((x[0], x[x.len() - 1]), (0.0, -2.0));
        assert!((x[1] + 0.1).abs() < 0.02, "{x:?}");
        assert!(x.windows(2).all(|w| w[1] < w[0]));
    }
}
