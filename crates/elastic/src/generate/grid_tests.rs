//! Tests of joining columns of cells, and of the resulting meshes.

use super::*;
use crate::element::Simplex;
use crate::material::Elasticity;
use fretwork_core::geometry::space::{Dim2, Dim3, MatrixLike};
use std::collections::BTreeSet;

const STEEL: Elasticity = Elasticity {
    young: 210e9,
    poisson: 0.3,
    density: 7800.0,
};

/// Upper bound of the number of points, which no grid here reaches.
const MAX_POINTS: usize = 100_000;

fn coarsened(lines: &[Vec<f64>], from: &str, ratio: f64) -> BlockGrid {
    let grid = BlockGrid::coarsened(lines, &Coarsening { from, ratio }, MAX_POINTS);
    grid.unwrap_or_else(|e| panic!("{from}: {e}"))
}

/// Names of the sides with their axes and ends.
fn sides(d: usize) -> Vec<(usize, usize, &'static str)> {
    let all = SIDES[d - 2].iter().enumerate();
    all.flat_map(|(axis, names)| [0, 1].map(|end| (axis, end, names[end])))
        .collect()
}

/// Returns coordinates along each axis for a side of small cells: equidistant ones with these
/// numbers, and rows that grow away from the side, starting with the narrowest columns.
fn lines(counts: &[usize], axis: usize, end: usize) -> Vec<Vec<f64>> {
    let length = |k: usize| 1.0 + 0.25 * k as f64;
    let width = |k: usize| length(k) / counts[k] as f64;
    let others = (0..counts.len()).filter(|k| *k != axis);
    let narrowest = others.map(width).fold(f64::INFINITY, f64::min);
    let along = |(k, count): (usize, &usize)| {
        if k != axis {
            return even(0.5, 0.5 + length(k), *count);
        }
        let mut rows = graded(0.0, 4.0, narrowest, 1.4);
        if end == 1 {
            rows = rows.iter().rev().map(|x| 4.0 - x).collect();
        }
        rows
    };
    counts.iter().enumerate().map(along).collect()
}

/// Tests a box of these numbers of columns, with joins away from each of its sides in turn.
fn boxes(counts: &[usize]) -> Vec<(BlockGrid, &'static str)> {
    let one = |(axis, end, name)| {
        let lines = lines(counts, axis, end);
        (coarsened(&lines, name, 1.0), name)
    };
    sides(counts.len()).into_iter().map(one).collect()
}

/// Every facet that belongs to one element is on exactly one side of the box: a crack between cells
/// would have facets on none.
fn is_conforming<S: Space>(mesh: &Mesh<S>) {
    let mut named = vec![0; mesh.facets()];
    for (_, _, name) in sides(S::D) {
        for f in mesh.part(name).unwrap() {
            named[*f as usize] += 1;
        }
    }
    assert!(named.iter().all(|n| *n == 1), "{named:?}");
}

fn volumes<S: Space>(mesh: &Mesh<S>) -> Vec<f64> {
    let volume = |e: &[u32]| Simplex::<S>::new(&mesh.corners(e)).unwrap().volume;
    mesh.elements().map(volume).collect()
}

/// Returns the volume within the boundary (Gauss; m^3, m^2 in 2D), which is independent of the
/// elements inside.
fn enclosed<S: Space>(mesh: &Mesh<S>) -> f64 {
    let one = |f: usize| {
        let c: Vec<_> = mesh
            .corners(mesh.facet(f))
            .iter()
            .map(|p| p.padded())
            .collect();
        let at = |k: usize| nalgebra::Vector3::from(c[k]);
        match S::D {
            2 => 0.5 * at(0).cross(&at(1)).z,
            _ => at(0).dot(&at(1).cross(&at(2))) / 6.0,
        }
    };
    (0..mesh.facets()).map(one).sum()
}

/// Pairs join where rows are high enough; the numbers of columns of the rows start at the side.
#[test]
fn pairs_join_where_rows_are_high_enough() {
    // The heights from the top are 1, 1, 2, 4, 4.
    let y = vec![0.0, 4.0, 8.0, 10.0, 11.0, 12.0];
    let columns = |cells: usize, ratio: f64| {
        let lines = [even(0.0, cells as f64, cells), y.clone()];
        let mut columns = coarsened(&lines, "top", ratio).columns();
        columns.reverse();
        columns
    };
    assert_eq!(columns(8, 1.0), [8, 8, 4, 2, 2]);
    // One of seven columns is left over, between pairs; with a pair it is 3 wide and joins where
    // rows are 4 high.
    assert_eq!(columns(7, 1.0), [7, 7, 4, 2, 2]);
    // Five columns join to widths 2 1 2, then 3 2; the next would be 5 wide.
    assert_eq!(columns(5, 1.0), [5, 5, 3, 2, 2]);
    // At a ratio of 2 the second row joins too.
    assert_eq!(columns(8, 2.0), [8, 4, 2, 1, 1]);
}

/// The elements are known by hand: undivided cells above, and joined cells with a point of smaller
/// cells on each upper edge.
#[test]
fn cells_are_cut_by_their_points() {
    let mesh = mapped_grid::<Dim2>(
        &coarsened(&[even(0.0, 4.0, 4), vec![0.0, 2.0, 3.0]], "top", 1.0),
        |x| *x,
    );
    let mesh = mesh.unwrap();
    assert_eq!(
        (mesh.points().len(), mesh.elements().len()),
        (5 + 5 + 3 + 6, 4 * 4 + 2 * 5)
    );
    let lines = [even(0.0, 4.0, 4), even(0.0, 2.0, 2), vec![0.0, 2.0, 3.0]];
    let mesh = mapped_grid::<Dim3>(&coarsened(&lines, "top", 1.0), |x| *x).unwrap();
    // A joined cell has eight triangles above, two below, and three on each of four sides.
    assert_eq!(
        (mesh.points().len(), mesh.elements().len()),
        (15 + 15 + 6 + 2, 8 * 6 + 2 * 22)
    );
}

fn fills<S: Space>(counts: &[usize]) {
    for (grid, from) in boxes(counts) {
        let mesh = mapped_grid::<S>(&grid, |x| *x).unwrap_or_else(|e| panic!("{from}: {e}"));
        is_conforming(&mesh);
        let lengths: Vec<f64> = grid.lines().iter().map(|l| l[l.len() - 1] - l[0]).collect();
        let volume: f64 = lengths.iter().product();
        let found = volumes(&mesh);
        assert!(found.iter().all(|v| *v > 0.0), "{from}");
        assert!(
            (found.iter().sum::<f64>() / volume - 1.0).abs() < 1e-12,
            "{from}"
        );
        for (axis, end, name) in sides(S::D) {
            let part = mesh.part(name).unwrap();
            let area: f64 = part.iter().map(|f| mesh.facet_area(*f as usize)).sum();
            assert!(
                (area * lengths[axis] / volume - 1.0).abs() < 1e-12,
                "{from}: {name} {area}"
            );
            let line = &grid.lines()[axis];
            let at = [line[0], line[line.len() - 1]][end];
            for point in mesh.points_of(name).unwrap() {
                assert_eq!(mesh.points()[point as usize][axis], at, "{from}: {name}");
            }
        }
        // The side itself keeps all of its points.
        let all: usize = (0..S::D)
            .filter(|k| *k != grid.axis())
            .map(|k| counts[k] + 1)
            .product();
        assert_eq!(mesh.points_of(from).unwrap().len(), all, "{from}");
        // A few joined cells in space have more points, including their centres, than the cells
        // that they replace.
        let whole = mapped_block::<S>(grid.lines(), |x| *x).unwrap();
        assert!(
            all < 50 || mesh.points().len() < whole.points().len(),
            "{from}"
        );
    }
}

/// Numbers of columns are powers of two, odd numbers, primes, and two.
#[test]
fn coarsened_blocks_fill_their_box_and_have_its_sides() {
    for counts in [[64, 32], [61, 37], [2, 2], [3, 50], [100, 7]] {
        fills::<Dim2>(&counts);
    }
    for counts in [[16, 16, 8], [13, 7, 11], [2, 1, 2], [3, 20, 9]] {
        fills::<Dim3>(&counts);
    }
}

/// A uniform strain has no force on points inside, and Hooke's uniform stress.
fn patch<S: Space>(counts: &[usize]) {
    for (grid, from) in boxes(counts) {
        let mesh = mapped_grid::<S>(&grid, |x| *x).unwrap();
        let gradient = [
            [3e-4, -1e-4, 2e-4],
            [5e-4, -2e-4, 1e-4],
            [-3e-4, 4e-4, 6e-4],
        ];
        let displaced = |p: &u32| {
            let (x, mut u) = (mesh.points()[*p as usize], S::Vector::zero());
            for i in 0..S::D {
                u[i] = (0..S::D).map(|j| gradient[i][j] * x[j]).sum();
            }
            u
        };
        let mut forces = vec![S::Vector::zero(); mesh.points().len()];
        let mut largest = 0.0f64;
        let mut first = None;
        for points in mesh.elements() {
            let simplex = Simplex::<S>::new(&mesh.corners(points)).unwrap();
            let moved: Vec<S::Vector> = points.iter().map(displaced).collect();
            for (a, point) in points.iter().enumerate() {
                let mut force = S::Vector::zero();
                for (b, u) in moved.iter().enumerate() {
                    force += simplex.stiffness(&STEEL, a, b).apply(u);
                }
                largest = largest.max(force.norm());
                forces[*point as usize] += force;
            }
            let stress = simplex.stress(&STEEL, &moved);
            let expected = first.get_or_insert(stress);
            for (found, expected) in stress.iter().zip(expected) {
                assert!((found - *expected).abs() < 1e-12 * STEEL.young, "{from}");
            }
        }
        let names = sides(S::D).into_iter();
        let outside: BTreeSet<u32> = names
            .flat_map(|(_, _, name)| mesh.points_of(name).unwrap())
            .collect();
        for (k, force) in forces.iter().enumerate() {
            let inside = !outside.contains(&(k as u32));
            assert!(
                !inside || force.norm() < 1e-12 * largest,
                "{from}: {k} {force:?}"
            );
        }
    }
}

#[test]
fn a_uniform_strain_is_reproduced() {
    patch::<Dim2>(&[21, 18]);
    patch::<Dim3>(&[9, 6, 7]);
}

/// Columns that grow along the surface join where they are narrow, and a side that is round or wavy
/// keeps a mesh that fits.
#[test]
fn graded_columns_and_sides_that_are_not_flat() {
    let across = |n: usize| -> Vec<f64> {
        let right = graded(0.1, 1.0, 0.2 / n as f64, 1.3);
        let left = right.iter().skip(1).rev().map(|x| -x);
        left.chain(even(-0.1, 0.1, n))
            .chain(right.iter().skip(1).copied())
            .collect()
    };
    let down: Vec<f64> = graded(0.0, 1.0, 0.02, 1.3)
        .iter()
        .rev()
        .map(|x| 1.0 - x)
        .collect();
    let raised = |x: [f64; 3], up: usize| {
        let round = -0.25 * (x[0] * x[0] + if up == 2 { x[1] * x[1] } else { 0.0 });
        let wave = 2e-3 * (30.0 * x[0]).cos();
        x[up] * (1.0 + round + wave)
    };
    let plane = coarsened(&[across(11), down.clone()], "top", 1.0);
    let mesh = mapped_grid::<Dim2>(&plane, |p| {
        nalgebra::Vector2::new(p.x, raised([p.x, p.y, 0.0], 1))
    });
    let mesh = mesh.unwrap();
    is_conforming(&mesh);
    let sum: f64 = volumes(&mesh).iter().sum();
    assert!((sum / enclosed(&mesh) - 1.0).abs() < 1e-12);
    let space = coarsened(&[across(11), across(8), down], "top", 1.0);
    let mesh = mapped_grid::<Dim3>(&space, |p| {
        nalgebra::Vector3::new(p.x, p.y, raised([p.x, p.y, p.z], 2))
    });
    let mesh = mesh.unwrap();
    is_conforming(&mesh);
    let sum: f64 = volumes(&mesh).iter().sum();
    assert!((sum / enclosed(&mesh) - 1.0).abs() < 1e-12);
    // Columns far away are wider than the height of the first rows, and are the same in all of
    // them.
    let columns = plane.columns();
    let (first, last) = (columns[columns.len() - 1], columns[0]);
    let fine = plane.lines()[0]
        .windows(2)
        .filter(|w| w[1] - w[0] < 0.1)
        .count();
    assert!(last < first / 2 && last >= first - fine, "{columns:?}");
}

#[test]
fn grids_that_cannot_be_say_why() {
    let lines = lines(&[8, 8], 1, 1);
    let error = |lines: &[Vec<f64>], from: &str, ratio: f64, most: usize| {
        let grid = BlockGrid::coarsened(lines, &Coarsening { from, ratio }, most);
        grid.unwrap_err()
    };
    let said = error(&lines, "front", 1.0, MAX_POINTS).to_string();
    assert!(said.contains("`left`, `right`, `bottom`, `top`"), "{said}");
    for ratio in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let said = error(&lines, "top", ratio, MAX_POINTS).to_string();
        assert!(said.contains("must be positive"), "{said}");
    }
    let even = [even(0.0, 1.0, 8), even(0.0, 1.0, 8)];
    let said = error(&even, "left", 1.0, MAX_POINTS);
    assert!(
        matches!(said, GridError::Nothing { axis: 'x', .. }),
        "{said}"
    );
    assert!(said.to_string().contains("1.250e-1 m") && said.to_string().contains("2.500e-1 m"));
    // With a ratio of 1/20 a row must be twenty times as high as columns are wide.
    let said = error(&even, "left", 0.05, MAX_POINTS);
    assert!(said.to_string().contains("1/0.05") && said.to_string().contains("5.000e0 m"));
    let one_row = [vec![0.0, 1.0, 2.0], vec![0.0, 1.0]];
    let said = error(&one_row, "top", 1.0, MAX_POINTS);
    assert!(
        matches!(said, GridError::OneRow { axis: 'y', .. }),
        "{said}"
    );
    let single = [vec![0.0, 1.0], vec![0.0, 1.0, 2.0]];
    assert_eq!(error(&single, "top", 1.0, MAX_POINTS), GridError::Single);
    let points = coarsened(&lines, "top", 1.0).points();
    assert_eq!(
        error(&lines, "top", 1.0, points - 1),
        GridError::TooMany(points - 1)
    );
    assert!(
        BlockGrid::coarsened(
            &lines,
            &Coarsening {
                from: "top",
                ratio: 1.0
            },
            points
        )
        .is_ok()
    );
    assert_eq!(BlockGrid::new(&lines[..1]), Err(GridError::Lines));
}
