//! Heat along surfaces: sources that cover a part of a half-space, against closed forms (H. S.
//! Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 1959, 10.5), and quantities that a step of
//! any length conserves.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_math::diffusion::{
    ColumnAxis, Columns, DiffusionError, Graph, Grid, HalfSpace, Node, Store, step_with_columns,
};
use std::f64::consts::PI;

const CONDUCTIVITY: f64 = 50.0;
const CAPACITY: f64 = 7850.0 * 450.0;
const DIFFUSIVITY: f64 = CONDUCTIVITY / CAPACITY;

/// Creates a surface with a number of pieces of a width (m) along each axis, at 0 K, for steps of
/// `h` up to a time `t` (s).
fn surface(counts: &[u32], width: f64, periodic: bool, h: f64, t: f64) -> (Vec<Node>, Columns) {
    let first = 0.1 * (DIFFUSIVITY * h).sqrt();
    let depth = 6.0 * (DIFFUSIVITY * t).sqrt();
    let grid = Grid::graded(CONDUCTIVITY, CAPACITY, first, 1.1, depth).unwrap();
    let area = width.powi(counts.len() as i32);
    let count = counts.iter().product::<u32>() as usize;
    let node = Node::new(
        0.0,
        Store::HalfSpace(Box::new(HalfSpace::new(grid, area, 0.0))),
    );
    let axes = counts.iter().map(|count| ColumnAxis {
        count: *count,
        width,
        periodic,
    });
    let columns = Columns {
        nodes: 0..count,
        axes: axes.collect(),
        diffusivity: DIFFUSIVITY,
    };
    (vec![node; count], columns)
}

fn no_edges(nodes: usize) -> Graph {
    Graph::new(nodes, Vec::new())
}

/// Returns the exponential integral E1 by its series and, above 1, its continued fraction (M.
/// Abramowitz, I. Stegun, 5.1.11 and 5.1.22).
fn e1(x: f64) -> f64 {
    if x <= 1.0 {
        let mut term = 1.0;
        let mut sum = -0.577_215_664_901_532_9 - x.ln();
        for k in 1..40 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum;
    }
    let tail = (1..=60).rev().fold(0.0, |tail, k| {
        let k = f64::from(k);
        k / (1.0 + k / (x + tail))
    });
    (-x).exp() / (x + tail)
}

fn erf(x: f64) -> f64 {
    // The series is used, for the arguments below 3 that are needed here.
    let (mut term, mut sum) = (x, x);
    for k in 1..100 {
        let k = f64::from(k);
        term *= -x * x / k;
        sum += term / (2.0 * k + 1.0);
    }
    2.0 / PI.sqrt() * sum
}

/// Returns the relative error of the rise at the middle of a band of half-width b under a flux q
/// since a time t; the widths of the pieces are b/n.
fn band(n: u32, h: f64, theta: f64) -> f64 {
    let (b, q, t) = (1e-4, 1e8, 2e-3);
    let width = b / f64::from(n);
    let side = (6.0 * (DIFFUSIVITY * t).sqrt() / width).ceil() as u32;
    let (mut nodes, columns) = surface(&[2 * (side + n) + 1], width, false, h, t);
    let count = nodes.len();
    let middle = count / 2;
    // The band ends in the middle of a piece.
    let flux = |k: usize| match k.abs_diff(middle) as u32 {
        d if d < n => q * width,
        d if d == n => 0.5 * q * width,
        _ => 0.0,
    };
    let sources: Vec<f64> = (0..count).map(flux).collect();
    let graph = no_edges(count);
    for _ in 0..(t / h).round() as usize {
        step_with_columns(
            &mut nodes,
            (&graph, std::slice::from_ref(&columns)),
            &sources,
            h,
            theta,
        )
        .unwrap();
    }
    let root = (DIFFUSIVITY * t).sqrt();
    let u = b / (2.0 * root);
    let exact = q / CONDUCTIVITY * (2.0 * root / PI.sqrt() * erf(u) + b / PI * e1(u * u));
    nodes[middle].temperature / exact - 1.0
}

/// The rise is that of the closed form for any width of the pieces: without tangential flow it
/// would be 2.1 times as large.
#[test]
fn a_band_source_warms_the_same_for_any_width_of_pieces() {
    for n in [2, 4, 8] {
        let off = band(n, 2e-5, 1.0);
        assert!(off.abs() < 0.02, "{n} pieces per half-width: {off}");
    }
}

/// The flux begins at once, so that the first steps of theta = 1 dominate the error; theta = 1/2 is
/// more accurate with steps of the same length.
#[test]
fn the_error_falls_with_the_step() {
    let euler = [4e-5, 2e-5, 1e-5].map(|h| band(8, h, 1.0));
    assert!(
        euler[2].abs() < 0.01 && euler[2].abs() < euler[0].abs(),
        "{euler:?}"
    );
    let middle = band(8, 4e-5, 0.5);
    assert!(middle.abs() < 0.01, "{middle}");
}

/// A square of half-width b under a flux q reaches 4 b q asinh(1)/(pi k) in its middle (Carslaw and
/// Jaeger, 10.5); the rest of the way after a time t is the flow of a point source, 2 b b q/(k
/// pi^(3/2) sqrt(D t)).
#[test]
fn a_square_source_on_a_surface_in_three_dimensions() {
    let (b, q, t, h, n) = (1e-4, 1e8, 1e-3, 1e-5, 4u32);
    let width = b / f64::from(n);
    let side = (3.5 * (DIFFUSIVITY * t).sqrt() / width).ceil() as u32;
    let along = 2 * (side + n) + 1;
    let (mut nodes, columns) = surface(&[along, along], width, false, h, t);
    let share = |k: u32| match k.abs_diff(along / 2) {
        d if d < n => 1.0,
        d if d == n => 0.5,
        _ => 0.0,
    };
    let places = (0..along).flat_map(|x| (0..along).map(move |y| (x, y)));
    let sources: Vec<f64> = places
        .map(|(x, y)| q * width * width * share(x) * share(y))
        .collect();
    let graph = no_edges(nodes.len());
    for _ in 0..(t / h).round() as usize {
        step_with_columns(
            &mut nodes,
            (&graph, std::slice::from_ref(&columns)),
            &sources,
            h,
            1.0,
        )
        .unwrap();
    }
    let steady = 4.0 * b * q / (PI * CONDUCTIVITY) * 1.0f64.asinh();
    let missing = 4.0 * b * b * q / (2.0 * CONDUCTIVITY * PI.powf(1.5) * (DIFFUSIVITY * t).sqrt());
    let reached = nodes[nodes.len() / 2].temperature;
    let off = reached / (steady - missing) - 1.0;
    assert!(off.abs() < 0.03, "{off}");
}

/// Any step conserves heat and, with theta = 1, the range of temperatures; a uniform temperature
/// does not change; a long step leaves one temperature at each depth. On a ring a rotated pattern
/// gives the rotated result.
#[test]
fn steps_of_any_length_keep_heat_and_range() {
    for (counts, periodic) in [
        (vec![7u32], true),
        (vec![7], false),
        (vec![2], true),
        (vec![1], true),
        (vec![3, 5], true),
    ] {
        for h in [1e-15, 1e-6, 1.0, 1e9, 1e30] {
            for theta in [0.5, 1.0] {
                let (mut nodes, columns) = surface(&counts, 1e-3, periodic, 1e-4, 1e-3);
                for (k, node) in nodes.iter_mut().enumerate() {
                    let t = 300.0 + 100.0 * ((k * k) % 5) as f64;
                    *node = match &node.store {
                        Store::HalfSpace(space) => {
                            let space = HalfSpace::new(space.grid.clone(), space.area, t);
                            Node::new(t, Store::HalfSpace(Box::new(space)))
                        }
                        _ => unreachable!(),
                    };
                }
                let heat = |nodes: &[Node]| nodes.iter().map(|n| n.heat(0.0)).sum::<f64>();
                let before = heat(&nodes);
                let count = nodes.len();
                let balance = step_with_columns(
                    &mut nodes,
                    (&no_edges(count), std::slice::from_ref(&columns)),
                    &vec![0.0; count],
                    h,
                    theta,
                )
                .unwrap();
                let change = heat(&nodes) - before;
                let what = format!("{counts:?} {periodic} {h:e} {theta}: {change:e}");
                assert!(change.abs() < 1e-13 * before, "{what}");
                assert!(balance.residual.abs() < 1e-13 * before, "{what}");
                let range = 300.0 - 1e-9..=700.0 + 1e-9;
                let kept = nodes.iter().all(|n| range.contains(&n.temperature));
                assert!(kept || theta < 1.0, "{what}: {nodes:?}");
                if h > 1e6 && theta == 1.0 && count > 1 {
                    let first = nodes[0].temperature;
                    let even = nodes.iter().all(|n| (n.temperature - first).abs() < 1e-5);
                    assert!(even, "{what}");
                }
            }
        }
    }
}

/// On a ring all pieces are equivalent.
#[test]
fn a_ring_has_no_first_piece() {
    let run = |warm: usize| {
        let (mut nodes, columns) = surface(&[9], 1e-4, true, 1e-5, 1e-3);
        let mut sources = vec![0.0; 9];
        sources[warm] = 1e3;
        for _ in 0..20 {
            step_with_columns(
                &mut nodes,
                (&no_edges(9), std::slice::from_ref(&columns)),
                &sources,
                1e-4,
                1.0,
            )
            .unwrap();
        }
        let turned = (0..9).map(|k| nodes[(k + warm) % 9].temperature);
        turned.collect::<Vec<f64>>()
    };
    let first = run(0);
    for warm in 1..9 {
        for (a, b) in first.iter().zip(run(warm)) {
            assert!((a - b).abs() < 1e-10 * first[0], "{warm}: {a} {b}");
        }
    }
}

#[test]
fn columns_that_do_not_fit_are_told() {
    let (mut nodes, mut columns) = surface(&[4], 1e-4, true, 1e-5, 1e-3);
    columns.nodes = 0..3;
    let said = step_with_columns(&mut nodes, (&no_edges(4), &[columns]), &[0.0; 4], 1e-4, 1.0);
    assert!(
        matches!(said, Err(DiffusionError::Number { .. })),
        "{said:?}"
    );
}
