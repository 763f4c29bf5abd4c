//! Potentials of nodes without capacity: electric current.

use crate::diffusion::solve::System;
use crate::diffusion::{DiffusionError, Edge, Graph};

/// A steady state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Steady {
    /// Potential of each node (V); 0 for nodes without a path to a fixed one.
    pub potential: Vec<f64>,
    /// Current through each edge from its first node to its second (A).
    pub current: Vec<f64>,
    /// Current supplied by each fixed node (A); 0 for the others.
    pub given: Vec<f64>,
}

/// Finds the potentials of connected nodes, where `fixed` is the potential of those that are held
/// (V) and `injected` the current into the others (A).
///
/// # Errors
/// A conductance or number is invalid, or current flows into nodes without a path to a fixed one.
pub fn steady(
    graph: &Graph,
    fixed: &[Option<f64>],
    injected: &[f64],
) -> Result<Steady, DiffusionError> {
    graph.check()?;
    for (node, value) in injected.iter().chain(fixed.iter().flatten()).enumerate() {
        if !value.is_finite() {
            return Err(DiffusionError::Number {
                what: "a potential or current",
                node,
                value: *value,
                expected: "a finite number",
            });
        }
    }
    let component = graph.components();
    let mut held = vec![false; graph.nodes];
    let mut put_in = vec![0.0; graph.nodes];
    let mut largest = vec![0.0f64; graph.nodes];
    for k in 0..graph.nodes {
        held[component[k]] |= fixed[k].is_some();
        put_in[component[k]] += injected[k];
        largest[component[k]] = largest[component[k]].max(injected[k].abs());
    }
    let floats = |k: usize| !held[component[k]];
    if let Some(node) =
        (0..graph.nodes).find(|&k| floats(k) && put_in[k].abs() > 1e-12 * largest[k])
    {
        return Err(DiffusionError::NoOutlet {
            node,
            source_rate: put_in[node],
        });
    }
    // A floating component has the potential 0 at its first node.
    let value = |k: usize| match fixed[k] {
        Some(v) => Some(v),
        None if floats(k) && component[k] == k => Some(0.0),
        None => None,
    };
    let mut unknown = vec![u32::MAX; graph.nodes];
    let mut list = Vec::new();
    let mut potential = vec![0.0; graph.nodes];
    for k in 0..graph.nodes {
        match value(k) {
            Some(v) => potential[k] = v,
            None => {
                unknown[k] = list.len() as u32;
                list.push(k);
            }
        }
    }
    let mut own = vec![0.0; list.len()];
    let mut right: Vec<f64> = list.iter().map(|&k| injected[k]).collect();
    let mut inner = Vec::with_capacity(graph.edges.len());
    for e in &graph.edges {
        let [a, b] = e.nodes.map(|n| n as usize);
        for (k, other) in [(a, b), (b, a)] {
            let u = unknown[k];
            if u != u32::MAX && unknown[other] == u32::MAX {
                own[u as usize] += e.conductance;
                right[u as usize] += e.conductance * potential[other];
            }
        }
        if unknown[a] != u32::MAX && unknown[b] != u32::MAX && a != b {
            inner.push(Edge {
                nodes: [unknown[a], unknown[b]],
                conductance: e.conductance,
            });
        }
    }
    let solved = System::new(&own, &inner, &right).solve()?;
    for (&k, v) in list.iter().zip(solved) {
        potential[k] = v;
    }
    let mut given = vec![0.0; graph.nodes];
    let mut current = Vec::with_capacity(graph.edges.len());
    for e in &graph.edges {
        let [a, b] = e.nodes.map(|n| n as usize);
        let flow = e.conductance * (potential[a] - potential[b]);
        current.push(flow);
        for (k, flow) in [(a, flow), (b, -flow)] {
            if fixed[k].is_some() {
                given[k] += flow;
            }
        }
    }
    for k in (0..graph.nodes).filter(|&k| fixed[k].is_some()) {
        given[k] -= injected[k];
    }
    Ok(Steady {
        potential,
        current,
        given,
    })
}
