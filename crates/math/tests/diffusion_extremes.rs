//! Heat is conserved, and temperatures stay between the initial ones, for any conductances and any
//! step.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_math::diffusion::{Edge, Graph, Grid, HalfSpace, Node, Store, step};
use rand::{RngExt, SeedableRng};

/// Creates 200 lumps with capacities over six decades and conductances over twelve, some of them
/// isolated, two half-spaces and a fixed node.
fn scene(seed: u64) -> (Vec<Node>, Graph) {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let mut decades = |low: f64, high: f64| 10f64.powf(low + (high - low) * random.random::<f64>());
    let mut nodes: Vec<Node> = (0..200)
        .map(|_| Node::new(0.0, Store::Lumped(decades(-3.0, 3.0))))
        .collect();
    let grid = Grid::graded(50.0, 3.5e6, 1e-6, 1.3, 1e-2).unwrap();
    for area in [1e-4, 1.0] {
        let space = HalfSpace::new(grid.clone(), area, 0.0);
        nodes.push(Node::new(0.0, Store::HalfSpace(Box::new(space))));
    }
    nodes.push(Node::new(0.0, Store::Fixed));
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed + 1);
    for node in &mut nodes {
        let temperature = 1000.0 * random.random::<f64>();
        node.temperature = temperature;
        if let Store::HalfSpace(space) = &mut node.store {
            space.temperature.fill(temperature);
        }
    }
    let mut edges = Vec::new();
    for _ in 0..600 {
        let a = random.random_range(0..203);
        let b = random.random_range(20..203);
        let conductance = 10f64.powf(-6.0 + 12.0 * random.random::<f64>());
        if a >= 20 {
            edges.push(Edge {
                nodes: [a, b],
                conductance,
            });
        }
    }
    (nodes, Graph::new(203, edges))
}

fn range(nodes: &[Node]) -> (f64, f64) {
    let inner = |node: &Node| match &node.store {
        Store::HalfSpace(space) => space.temperature.clone(),
        _ => vec![node.temperature],
    };
    let all: Vec<f64> = nodes.iter().flat_map(inner).collect();
    let fold = |f: fn(f64, f64) -> f64| all.iter().copied().reduce(f).unwrap();
    (fold(f64::min), fold(f64::max))
}

#[test]
fn heat_is_kept_for_any_conductances_and_steps() {
    for (seed, h) in [(1, 1e-9), (2, 1e-3), (3, 1.0), (4, 1e6), (5, 1e12)] {
        let (mut nodes, graph) = scene(seed);
        let (low, high) = range(&nodes);
        let scale: f64 = nodes.iter().map(|n| n.heat(0.0)).sum();
        for _ in 0..5 {
            let isolated = nodes[7].temperature;
            let balance = step(&mut nodes, &graph, &[0.0; 203], h, 1.0).unwrap();
            // Temperatures are rounded, and so are the flows through conductances.
            let rounding: f64 = graph
                .edges
                .iter()
                .map(|e| 1e-15 * e.conductance * h * high)
                .sum();
            assert!(
                balance.residual.abs() < 1e-11 * scale + rounding,
                "step {h:e}: {balance:?} of {scale:e}"
            );
            let (now_low, now_high) = range(&nodes);
            let slack = 1e-9 * high;
            assert!(
                now_low >= low - slack && now_high <= high + slack,
                "step {h:e}: {now_low} to {now_high} from {low} to {high}"
            );
            assert_eq!(nodes[7].temperature, isolated);
        }
    }
}

#[test]
fn sources_are_stored() {
    let (mut nodes, graph) = scene(9);
    nodes.pop();
    let edges: Vec<Edge> = graph
        .edges
        .iter()
        .copied()
        .filter(|e| e.nodes.iter().all(|n| *n < 202))
        .collect();
    let graph = Graph::new(202, edges);
    let sources: Vec<f64> = (0..202).map(|k| f64::from(k % 7)).collect();
    let before: f64 = nodes.iter().map(|n| n.heat(0.0)).sum();
    for theta in [0.5, 0.7, 1.0] {
        step(&mut nodes, &graph, &sources, 0.1, theta).unwrap();
    }
    let after: f64 = nodes.iter().map(|n| n.heat(0.0)).sum();
    let put: f64 = 0.3 * sources.iter().sum::<f64>();
    assert!(
        (after - before - put).abs() < 1e-11 * before,
        "{}",
        after - before - put
    );
}

#[test]
fn wrong_numbers_are_refused_and_change_nothing() {
    let (nodes, graph) = scene(3);
    type Change<'a> = &'a dyn Fn(&mut [Node], &mut Graph, &mut [f64]);
    let refused = |change: Change<'_>| {
        let (mut nodes, mut graph, mut sources) = (nodes.clone(), graph.clone(), vec![0.0; 203]);
        change(&mut nodes, &mut graph, &mut sources);
        let before = nodes.clone();
        let said = step(&mut nodes, &graph, &sources, 1e-3, 1.0)
            .unwrap_err()
            .to_string();
        // NaN is not equal to itself.
        assert_eq!(format!("{before:?}"), format!("{nodes:?}"));
        said
    };
    assert!(
        refused(&|_, g, _| g.edges[3].conductance = -1.0)
            .contains("must be finite and not negative")
    );
    assert!(refused(&|n, _, _| n[5].store = Store::Lumped(0.0)).contains("capacity"));
    assert!(refused(&|n, _, _| n[5].temperature = f64::NAN).contains("temperature of node 5"));
    assert!(refused(&|_, _, s| s[8] = f64::INFINITY).contains("heat source of node 8"));
}
