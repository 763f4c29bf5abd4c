//! Tests of the Voronoi cells in space: the volume they fill, and the faces that neighbours share.

use super::*;
use fretwork_core::geometry::convex::polyhedron::Polyhedron;
use fretwork_core::geometry::convex::polyhedron_mass;

const LOW: V = V::new(-0.3, 0.7, 0.1);
const HIGH: V = V::new(0.3, 1.1, 0.5);

fn unit_tiling(size: f64, rounds: usize, around: [bool; 3], seed: u64) -> SpaceTiling {
    let corners = Corners {
        low: LOW,
        high: HIGH,
    };
    let period = [0, 1, 2].map(|k| around[k].then(|| HIGH[k] - LOW[k]));
    tiling(&corners, &Periodic { period }, size, rounds, seed).unwrap()
}

fn polyhedron(cell: &Cell) -> Polyhedron {
    Polyhedron::from_faces(cell.points.clone(), cell.faces.clone()).unwrap()
}

fn volume(cell: &Cell) -> f64 {
    polyhedron_mass::of(&polyhedron(cell), 0.0).volume
}

fn area(points: &[V], face: &[u32]) -> V {
    let at = |k: usize| points[face[k] as usize] - points[face[0] as usize];
    (1..face.len() - 1)
        .map(|k| at(k).cross(&at(k + 1)) * 0.5)
        .sum()
}

/// Every cell is convex with plane faces and no short edge, and together the cells fill the box.
#[test]
fn cells_are_convex_and_fill_the_box() {
    let whole = (HIGH - LOW).product();
    let mut moved = 0;
    for (seed, rounds, around) in [
        (1, 0, [false; 3]),
        (2, 0, [true, false, false]),
        (3, 0, [true, true, true]),
        (4, 10, [false; 3]),
        (5, 10, [true, false, true]),
    ] {
        let tiling = unit_tiling(0.05, rounds, around, seed);
        assert_eq!(
            tiling.cells.len(),
            (whole / 0.05f64.powi(3)).round() as usize
        );
        moved += tiling.moved;
        let sum: f64 = tiling.cells.iter().map(volume).sum();
        // The volumes add up to that of the box, so there are no holes and, since no cell is
        // inverted, no overlaps.
        assert!((sum / whole - 1.0).abs() < 1e-13, "{:e}", sum / whole - 1.0);
        for cell in &tiling.cells {
            let core = polyhedron(cell);
            // Euler's formula holds, and three faces meet at every corner.
            let t = core.topology();
            assert_eq!(t.about.len() + t.faces.len(), t.edges.len() + 2);
            assert!(t.about.iter().all(|a| a.len() == 3));
            for (f, n) in core.normals().iter().enumerate() {
                let height = |p: &V| (p - core.points()[t.faces[f][0] as usize]).dot(n);
                for (k, p) in core.points().iter().enumerate() {
                    if t.faces[f].contains(&(k as u32)) {
                        assert!(height(p).abs() < 1e-14, "{:e}", height(p));
                    } else {
                        assert!(height(p) < 0.0, "{:e}", height(p));
                    }
                }
            }
            for e in 0..t.edges.len() {
                let [a, b] = core.ends(e);
                assert!((a - b).norm() > 0.99 * SHORTEST * 0.05);
            }
        }
    }
    assert!(moved > 0, "no edge was short enough to test with");
}

/// The face shared with another cell is also a face of that cell: the corners are bit-identical
/// without periods, the areas equal, and the normals opposite.
#[test]
fn neighbours_share_their_faces() {
    let tiling = unit_tiling(0.06, 0, [false; 3], 7);
    let (mut shared, mut walls) = (0, V::zeros());
    for (i, cell) in tiling.cells.iter().enumerate() {
        for (face, beyond) in cell.faces.iter().zip(&cell.beyond) {
            let Some(j) = beyond else {
                walls += area(&cell.points, face).abs();
                continue;
            };
            let other = &tiling.cells[*j as usize];
            let back = other.beyond.iter().position(|b| *b == Some(i as u32));
            let back = &other.faces[back.unwrap()];
            let bits = |points: &[V], face: &[u32]| {
                let mut out: Vec<[u64; 3]> = face
                    .iter()
                    .map(|c| <[f64; 3]>::from(points[*c as usize]).map(f64::to_bits))
                    .collect();
                out.sort_unstable();
                out
            };
            assert_eq!(bits(&cell.points, face), bits(&other.points, back));
            let (a, b) = (area(&cell.points, face), area(&other.points, back));
            assert!((a + b).norm() < 1e-13 * 0.06f64.powi(2));
            shared += 1;
        }
    }
    // A cell has about fifteen faces, fewer at walls.
    assert!(shared > 10 * tiling.cells.len());
    let box_walls = V::new(0.4 * 0.4, 0.6 * 0.4, 0.6 * 0.4) * 2.0;
    assert!((walls - box_walls).norm() < 1e-14);
}

/// Across a period the two sides of a face differ only by the period.
#[test]
fn neighbours_share_their_faces_across_periods() {
    let tiling = unit_tiling(0.06, 3, [true, true, false], 8);
    for (i, cell) in tiling.cells.iter().enumerate() {
        for (face, beyond) in cell.faces.iter().zip(&cell.beyond) {
            let Some(j) = beyond else { continue };
            let a = area(&cell.points, face);
            let other = &tiling.cells[*j as usize];
            let mut back = other.faces.iter().zip(&other.beyond);
            let found = back.any(|(face, beyond)| {
                let b = area(&other.points, face);
                *beyond == Some(i as u32) && (a + b).norm() < 1e-13 * 0.06f64.powi(2)
            });
            assert!(found, "{i} {j}");
        }
    }
}

/// The volumes of Poisson-Voronoi cells have a relative standard deviation of 0.42. Sites that are
/// kept apart have a smaller one, and Lloyd iterations reduce it further.
#[test]
fn lloyds_rounds_make_cells_alike_and_seeds_make_them_differ() {
    let of = |rounds: usize| {
        let volumes: Vec<f64> = unit_tiling(0.06, rounds, [false; 3], 3)
            .cells
            .iter()
            .map(volume)
            .collect();
        let mean = volumes.iter().sum::<f64>() / volumes.len() as f64;
        let square = volumes.iter().map(|a| (a - mean).powi(2)).sum::<f64>();
        (square / volumes.len() as f64).sqrt() / mean
    };
    let (none, five, thirty) = (of(0), of(5), of(30));
    assert!(
        none < 0.42 && five < 0.7 * none && thirty < 0.7 * five,
        "{none} {five} {thirty}"
    );
    assert_eq!(
        unit_tiling(0.08, 2, [false; 3], 3),
        unit_tiling(0.08, 2, [false; 3], 3)
    );
    assert_ne!(
        unit_tiling(0.08, 2, [false; 3], 3),
        unit_tiling(0.08, 2, [false; 3], 4)
    );
}

/// A single cell is the box; a box too thin for a site has no cells.
#[test]
fn few_cells() {
    let cube = Corners {
        low: LOW,
        high: LOW + V::repeat(0.4),
    };
    let of = |corners: &Corners<V>, size| tiling(corners, &Periodic::default(), size, 5, 1);
    let one = of(&cube, 0.4).unwrap().cells;
    assert!((volume(&one[0]) - 0.064).abs() < 1e-16);
    assert_eq!((one.len(), one[0].faces.len()), (1, 6));
    let thin = Corners {
        low: LOW,
        high: LOW + V::new(0.4, 0.4, 0.01),
    };
    assert_eq!(of(&thin, 0.05), Err(Failure::Thin));
}

/// Offsetting the faces of a tetrahedron of inradius r inwards by d leaves (1 - d/r)³ of its
/// volume.
#[test]
fn an_inset_keeps_its_distance() {
    let third = 1.0 / 3f64.sqrt();
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let tetrahedron = Cell {
        points: corners.map(|c| V::from(c) * third).to_vec(),
        faces: vec![vec![0, 1, 2], vec![0, 3, 1], vec![0, 2, 3], vec![1, 3, 2]],
        beyond: vec![None; 4],
    };
    for d in [0.01, 0.2] {
        let (points, faces) = inset(&tetrahedron, d).unwrap();
        let beyond = vec![None; 4];
        let left = volume(&Cell {
            points,
            faces,
            beyond,
        });
        // The inradius is a third of the circumradius, which is 1.
        let expected = volume(&tetrahedron) * (1.0 - 3.0 * d).powi(3);
        assert!(
            left > 0.0 && (left - expected).abs() < 1e-15,
            "{left} {expected}"
        );
    }
    for cell in &unit_tiling(0.1, 2, [false; 3], 5).cells {
        let (points, faces) = inset(cell, 5e-3).unwrap();
        let inner = Polyhedron::from_faces(points, faces).unwrap();
        let outer = polyhedron(cell);
        // Every point is at least `distance` deep, and every remaining face has a point exactly
        // that deep.
        let depth = |p: &V| -outer.distance(p).0;
        assert!(
            inner
                .points()
                .iter()
                .all(|p| (depth(p) - 5e-3).abs() < 1e-14)
        );
        assert!(inset(cell, 0.1).is_none());
    }
}
