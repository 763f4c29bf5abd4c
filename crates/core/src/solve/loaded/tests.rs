//! Loaded points of large systems, compared with the full product with the compliance.

use crate::geometry::space::Dim3;
use crate::solve::NodalSystem;
use nalgebra::{Matrix3, Vector3};

const NODES: usize = 90;

/// Compliance of two nodes: symmetric as a whole, not as a block.
fn block(a: usize, b: usize) -> Matrix3<f64> {
    let far = 1.0 + (a as f64 - b as f64).abs();
    let shear = 0.1 * (a as f64 - b as f64) / far;
    Matrix3::new(2.0, shear, 0.1, -shear, 3.0, 0.2, 0.1, 0.2, 1.0) / far
}

fn free(a: usize) -> Vector3<f64> {
    Vector3::new((a as f64).sin(), 1.0, -0.5)
}

fn system() -> NodalSystem<Dim3> {
    let rows: Vec<_> = (0..NODES * NODES)
        .map(|k| block(k / NODES, k % NODES))
        .collect();
    let nodes = (0..NODES as u32).collect();
    NodalSystem::new(nodes, (0..NODES).map(free).collect(), &rows)
}

/// Impulses act on points of a large system; new points are loaded between two tests and after a
/// test. The velocities of loaded points always equal those of the full product, and so do those of
/// all points once they are computed.
fn compare(terms: &[Vec<(u32, f64)>], by_nodes: bool) {
    let mut system = system();
    let points: Vec<u32> = terms.iter().map(|terms| system.add_point(terms)).collect();
    assert_eq!(system.follows_nodes(), by_nodes);
    let mut impulses = vec![Vector3::zeros(); NODES];
    let velocity = |impulses: &[Vector3<f64>], point: usize| {
        let mut sum = Vector3::zeros();
        for (a, weight) in &terms[point] {
            let a = *a as usize;
            let pairs = impulses.iter().enumerate();
            sum += pairs.fold(free(a), |sum, (b, p)| sum + block(a, b) * p) * *weight;
        }
        sum
    };
    let spread = |impulses: &mut [Vector3<f64>], point: usize, p: &Vector3<f64>| {
        for (a, weight) in &terms[point] {
            impulses[*a as usize] += p * *weight;
        }
    };
    let impulse = |k: usize| Vector3::new(1.0, (k as f64).cos(), 0.3 * k as f64);
    let count = points.len();
    let mut loaded = vec![false; count];
    for k in 0..5 {
        let at = 7 * k % count;
        loaded[at] = true;
        spread(&mut impulses, at, &impulse(k));
        system.load(points[at], &impulse(k));
    }
    system.settle();
    for round in 0..3 {
        for k in 0..12 {
            let at = (5 * k + 11 * round) % count;
            loaded[at] = true;
            spread(&mut impulses, at, &impulse(k));
            system.push(points[at], &impulse(k));
            for a in (0..count).filter(|a| loaded[*a]) {
                let off = system.velocity(points[a]) - velocity(&impulses, a);
                assert!(off.norm() < 1e-11, "{round} {k} {a}: {off}");
            }
        }
        let stale = (0..count).filter(|a| !loaded[*a]);
        let off = |a: usize| (system.velocity(points[a]) - velocity(&impulses, a)).norm();
        assert!(stale.clone().map(off).fold(0.0, f64::max) > 0.1);
        system.settle();
        for (a, point) in points.iter().enumerate() {
            let off = system.velocity(*point) - velocity(&impulses, a);
            assert!(off.norm() < 1e-11, "{round} {a}: {off}");
        }
    }
}

#[test]
fn loaded_nodes_move_as_with_the_whole_compliance() {
    compare(
        &(0..NODES as u32)
            .map(|a| vec![(a, 1.0)])
            .collect::<Vec<_>>(),
        false,
    );
}

/// A point on one to nine nodes shared with other points, with weights of both signs.
fn sum_of_nodes(k: usize, stride: usize) -> Vec<(u32, f64)> {
    let count = 1 + k % 9;
    let term = |j: usize| {
        let weight = 1.3 / count as f64 - 0.2 * (j as f64 - (count - 1) as f64 / 2.0);
        (((stride * k + j) % NODES) as u32, weight)
    };
    (0..count).map(term).collect()
}

/// With fewer points than nodes the points are updated.
#[test]
fn loaded_points_move_as_with_the_whole_compliance() {
    let points: Vec<_> = (0..40).map(|k| sum_of_nodes(k, 2)).collect();
    compare(&points, false);
}

/// With more points than nodes the nodes are updated, so that memory does not grow with the square
/// of the number of points.
#[test]
fn nodes_of_many_points_move_as_with_the_whole_compliance() {
    let points: Vec<_> = (0..400).map(|k| sum_of_nodes(k, 1)).collect();
    compare(&points, true);
}

/// Points that are vertices of a facet, given by all its vertices, are single nodes.
#[test]
fn a_point_with_one_weight_is_its_node() {
    let mut system = system();
    assert_eq!(system.add_point(&[(3, 0.0), (7, 1.0), (8, 0.0)]), 7);
    assert_eq!(system.add_point(&[(7, 1.0)]), 7);
    assert!(!system.follows_nodes());
}
