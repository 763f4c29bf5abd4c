//! Heat in half-spaces, lumps and resistor networks against closed forms (H. S. Carslaw, J. C.
//! Jaeger, Conduction of Heat in Solids, 1959) and an independent dense solution.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_math::diffusion::{
    DiffusionError, Edge, Graph, Grid, HalfSpace, Node, Store, steady, step,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// Steel: conductivity (W/(m K)) and heat capacity of volume (J/(m^3 K)).
const CONDUCTIVITY: f64 = 50.0;
const CAPACITY: f64 = 7850.0 * 450.0;

fn edge(a: u32, b: u32, conductance: f64) -> Edge {
    Edge {
        nodes: [a, b],
        conductance,
    }
}

/// A half-space whose grid resolves steps of `h` up to a time of `t` (s).
fn half_space(conductivity: f64, capacity: f64, h: f64, t: f64, temperature: f64) -> Node {
    let diffusivity = conductivity / capacity;
    let (first, depth) = (
        0.05 * (diffusivity * h).sqrt(),
        8.0 * (diffusivity * t).sqrt(),
    );
    let grid = Grid::graded(conductivity, capacity, first, 1.05, depth).unwrap();
    let space = HalfSpace::new(grid, 1.0, temperature);
    Node::new(temperature, Store::HalfSpace(Box::new(space)))
}

/// Returns the relative error of the surface temperature of a half-space under a constant flux,
/// whose exact value is 2 q sqrt(t/pi)/e.
fn flux_error(steps: u32, theta: f64) -> f64 {
    let (q, t) = (1e6, 1e-3);
    let h = t / f64::from(steps);
    let mut nodes = [half_space(CONDUCTIVITY, CAPACITY, t / 400.0, t, 0.0)];
    let graph = Graph::new(1, Vec::new());
    for _ in 0..steps {
        step(&mut nodes, &graph, &[q], h, theta).unwrap();
    }
    let effusivity = (CONDUCTIVITY * CAPACITY).sqrt();
    let exact = 2.0 * q * (t / PI).sqrt() / effusivity;
    nodes[0].temperature / exact - 1.0
}

/// The solution is that of Carslaw and Jaeger, 2.9 (7). The flux begins at once, so that the error
/// of implicit Euler decreases with the first power of the step.
#[test]
fn a_half_space_is_warmed_by_a_constant_flux() {
    let euler: Vec<f64> = [50, 100, 200].map(|n| flux_error(n, 1.0)).to_vec();
    assert!(euler[2].abs() < 0.01, "{euler:?}");
    let order = (euler[0] / euler[2]).abs().log2() / 2.0;
    assert!((0.8..1.2).contains(&order), "{euler:?}: order {order}");
    // The surface oscillates where a flux begins at once.
    let middle = flux_error(200, 0.5);
    assert!(middle.abs() < 0.01, "{middle}");
}

/// Both surfaces reach the temperature (e1 T1 + e2 T2)/(e1 + e2) at once and keep it (Carslaw and
/// Jaeger, 2.15).
#[test]
fn two_half_spaces_meet_at_their_effusivities() {
    let (t, h) = (1e-3, 1e-6);
    let glass = (1.0, 2500.0 * 800.0);
    for (other, temperatures) in [
        ((CONDUCTIVITY, CAPACITY), [300.0, 400.0]),
        (glass, [900.0, 300.0]),
    ] {
        let mut nodes = [
            half_space(CONDUCTIVITY, CAPACITY, h, t, temperatures[0]),
            half_space(other.0, other.1, h, t, temperatures[1]),
        ];
        let graph = Graph::new(2, vec![edge(0, 1, 1e12)]);
        for _ in 0..1000 {
            step(&mut nodes, &graph, &[0.0; 2], h, 1.0).unwrap();
        }
        let e = [(CONDUCTIVITY * CAPACITY).sqrt(), (other.0 * other.1).sqrt()];
        let exact = (e[0] * temperatures[0] + e[1] * temperatures[1]) / (e[0] + e[1]);
        for node in &nodes {
            let off = (node.temperature - exact) / (temperatures[0] - temperatures[1]);
            assert!(off.abs() < 1e-3, "{} for {exact}", node.temperature);
        }
    }
}

/// The difference of two lumps decays as exp(-t G (1/C1 + 1/C2)): first order for theta = 1, second
/// for 1/2.
#[test]
fn two_lumps_approach_each_other() {
    let (c, g, t) = ([2.0, 3.0], 1.5, 1.0);
    let run = |steps: u32, theta: f64| {
        let mut nodes = [300.0, 400.0].map(|t| Node::new(t, Store::Lumped(0.0)));
        for (node, c) in nodes.iter_mut().zip(c) {
            node.store = Store::Lumped(c);
        }
        let graph = Graph::new(2, vec![edge(0, 1, g)]);
        for _ in 0..steps {
            step(&mut nodes, &graph, &[0.0; 2], t / f64::from(steps), theta).unwrap();
        }
        let exact = -100.0 * (-t * g * (1.0 / c[0] + 1.0 / c[1])).exp();
        (nodes[0].temperature - nodes[1].temperature - exact).abs()
    };
    for (theta, expected) in [(1.0, 1.0), (0.5, 2.0)] {
        let order = (run(20, theta) / run(80, theta)).log2() / 2.0;
        assert!((order - expected).abs() < 0.1, "theta {theta}: {order}");
    }
}

/// A surface in moving air: T - T_air falls as exp(-t G/C).
#[test]
fn surroundings_take_heat() {
    let mut node = Node::new(400.0, Store::Lumped(10.0));
    (node.surroundings, node.ambient) = (2.0, 300.0);
    let mut nodes = [node];
    let graph = Graph::new(1, Vec::new());
    let mut lost = 0.0;
    for _ in 0..1000 {
        lost -= step(&mut nodes, &graph, &[0.0], 5e-3, 0.5)
            .unwrap()
            .surroundings;
    }
    let exact = 300.0 + 100.0 * (-1.0f64).exp();
    assert!((nodes[0].temperature - exact).abs() < 1e-3);
    assert!((lost - 10.0 * (400.0 - nodes[0].temperature)).abs() < 1e-9);
}

/// A random network with two electrodes against a dense solution.
#[test]
fn a_random_network_is_solved() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
    let n = 60usize;
    let mut edges = Vec::new();
    for a in 0..n as u32 {
        for b in 0..a {
            if random.random::<f64>() < 0.1 || b + 1 == a {
                edges.push(edge(a, b, 10f64.powf(4.0 * random.random::<f64>() - 2.0)));
            }
        }
    }
    let graph = Graph::new(n, edges);
    let mut fixed = vec![None; n];
    (fixed[3], fixed[41]) = (Some(1.0), Some(-2.0));
    let mut injected = vec![0.0; n];
    injected[20] = 0.7;
    let found = steady(&graph, &fixed, &injected).unwrap();

    let mut matrix = DMatrix::<f64>::zeros(n, n);
    let mut right = DVector::from_vec(injected.clone());
    for e in &graph.edges {
        let [a, b] = e.nodes.map(|k| k as usize);
        matrix[(a, a)] += e.conductance;
        matrix[(b, b)] += e.conductance;
        matrix[(a, b)] -= e.conductance;
        matrix[(b, a)] -= e.conductance;
    }
    for (k, v) in fixed
        .iter()
        .enumerate()
        .filter_map(|(k, v)| Some((k, (*v)?)))
    {
        matrix.row_mut(k).fill(0.0);
        matrix[(k, k)] = 1.0;
        right[k] = v;
    }
    let exact = matrix.lu().solve(&right).unwrap();
    for k in 0..n {
        assert!((found.potential[k] - exact[k]).abs() < 1e-12, "{k}");
    }
    // The currents of the electrodes and the injected ones sum to zero.
    let sum: f64 = found.given.iter().sum::<f64>() + 0.7;
    assert!(sum.abs() < 1e-12, "{sum}");
}

/// Resistances in series are added, and conductances in parallel.
#[test]
fn series_and_parallel() {
    let between = |edges: Vec<Edge>, nodes: usize| {
        let graph = Graph::new(nodes, edges);
        let mut fixed = vec![None; nodes];
        (fixed[0], fixed[nodes - 1]) = (Some(1.0), Some(0.0));
        steady(&graph, &fixed, &vec![0.0; nodes]).unwrap().given[0]
    };
    let chain: Vec<Edge> = (0..100).map(|k| edge(k, k + 1, f64::from(k + 1))).collect();
    let resistance: f64 = (1..=100).map(|k| 1.0 / f64::from(k)).sum();
    assert!((between(chain, 101) * resistance - 1.0).abs() < 1e-12);
    let pair = (1..=100).map(|k| edge(0, 1, f64::from(k))).collect();
    assert!((between(pair, 2) / 5050.0 - 1.0).abs() < 1e-12);
}

/// Nodes without a path to an electrode carry no current, and current into them is refused.
#[test]
fn what_is_not_joined_carries_no_current() {
    let graph = Graph::new(5, vec![edge(0, 1, 1.0), edge(2, 3, 1.0), edge(3, 4, 0.0)]);
    let fixed = [Some(5.0), None, None, None, None];
    let found = steady(&graph, &fixed, &[0.0; 5]).unwrap();
    assert_eq!(found.potential, [5.0, 5.0, 0.0, 0.0, 0.0]);
    assert!(found.current.iter().all(|i| *i == 0.0));
    let refused = steady(&graph, &fixed, &[0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(
        refused,
        Err(DiffusionError::NoOutlet {
            node: 2,
            source_rate: 1.0
        })
    );
}
