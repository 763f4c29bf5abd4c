//! One step of heat conduction, implicit in time.

use crate::diffusion::half_space::Eliminated;
use crate::diffusion::solve::System;
use crate::diffusion::{Columns, DiffusionError, Edge, Graph, Node, Store};

/// The heat of a step (J; J/m in 2D): `sources` + `surroundings` = `stored` + `fixed` + `residual`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Balance {
    /// Heat supplied by sources, including sources in nodes of fixed temperature.
    pub sources: f64,
    /// Heat received from surroundings.
    pub surroundings: f64,
    /// Heat stored in nodes.
    pub stored: f64,
    /// Heat received by nodes of fixed temperature.
    pub fixed: f64,
    /// Residual, by rounding of temperatures T by T 1e-16, so that the heat G h T 1e-16 through a
    /// conductance G to a node of fixed temperature may be lost.
    pub residual: f64,
    /// Heat through each edge that is not an element, from its second node to its first.
    pub through: Vec<f64>,
}

/// Advances the temperatures of all nodes by a step (s), with heat `sources` (W) of each node that
/// are constant over it; returns the heat of the step.
///
/// The scheme is (C/h) (T' - T) = -L (T + theta (T' - T)) + Q. With theta = 1 it is of first order,
/// and without sources no temperature leaves the range of the others, for any step; with theta =
/// 1/2 it is of second order, and oscillates for steps beyond the thermal times of contacts.
///
/// # Errors
/// A conductance, capacity or source is invalid, theta is outside 1/2 to 1, or the system cannot be
/// solved. Temperatures are then not changed.
pub fn step(
    nodes: &mut [Node],
    graph: &Graph,
    sources: &[f64],
    h: f64,
    theta: f64,
) -> Result<Balance, DiffusionError> {
    step_with_columns(nodes, (graph, &[]), sources, h, theta)
}

/// Makes a [`step`] with flow between the half-spaces of neighbouring pieces of surfaces. The flow
/// comes after all else for theta = 1; for a smaller theta half of it comes before and half after,
/// which keeps the order of the scheme.
///
/// # Errors
/// Returns the errors of [`step`], and an error for columns that do not fit their nodes.
pub fn step_with_columns(
    nodes: &mut [Node],
    (graph, columns): (&Graph, &[Columns]),
    sources: &[f64],
    h: f64,
    theta: f64,
) -> Result<Balance, DiffusionError> {
    check(nodes, graph, sources, h, theta)?;
    for each in columns {
        each.check(nodes)?;
    }
    let halves = theta < 1.0;
    let mut stored = 0.0;
    for each in columns.iter().filter(|_| halves) {
        stored += each.conduct(nodes, 0.5 * h, theta, false);
    }
    let mut balance = solve(nodes, graph, sources, h, theta)?;
    for each in columns {
        let span = if halves { 0.5 * h } else { h };
        stored += each.conduct(nodes, span, theta, halves);
    }
    balance.stored += stored;
    balance.residual -= stored;
    Ok(balance)
}

/// The flow through edges, to surroundings and along depths.
fn solve(
    nodes: &mut [Node],
    graph: &Graph,
    sources: &[f64],
    h: f64,
    theta: f64,
) -> Result<Balance, DiffusionError> {
    let w = theta * h;
    // Unknowns are the nodes whose temperature is not fixed.
    let mut unknown = vec![u32::MAX; nodes.len()];
    let mut list: Vec<usize> = Vec::new();
    for (k, node) in nodes.iter().enumerate() {
        if node.store != Store::Fixed {
            unknown[k] = list.len() as u32;
            list.push(k);
        }
    }
    let (mut own, mut right) = (vec![0.0; list.len()], vec![0.0; list.len()]);
    let mut below: Vec<Option<Eliminated>> = vec![None; list.len()];
    for (u, &k) in list.iter().enumerate() {
        let node = &nodes[k];
        match &node.store {
            Store::Fixed => {}
            Store::Lumped(capacity) => own[u] += capacity / w,
            Store::HalfSpace(space) => {
                let eliminated = space.eliminate(w);
                own[u] += eliminated.diagonal;
                right[u] += eliminated.right;
                below[u] = Some(eliminated);
            }
        }
        own[u] += node.surroundings;
        right[u] += sources[k] + node.surroundings * (node.ambient - node.temperature);
    }
    // Temperatures are copied to be contiguous, since nodes are large: first at the start of the
    // step, then at theta of it.
    let mut reached: Vec<f64> = nodes.iter().map(|node| node.temperature).collect();
    // Where all nodes are unknowns, edges between nodes are those between unknowns.
    let all_unknown = list.len() == nodes.len() && graph.elements.is_empty();
    let mut inner: Vec<Edge> = Vec::new();
    for e in graph.all() {
        let [a, b] = [e.nodes[0] as usize, e.nodes[1] as usize];
        let flow = e.conductance * (reached[b] - reached[a]);
        if all_unknown {
            right[a] += flow;
            right[b] -= flow;
            continue;
        }
        let [ua, ub] = [unknown[a], unknown[b]];
        for (u, flow) in [(ua, flow), (ub, -flow)] {
            if u != u32::MAX {
                right[u as usize] += flow;
            }
        }
        match (ua == u32::MAX, ub == u32::MAX) {
            (false, false) if ua != ub => inner.push(Edge {
                nodes: [ua, ub],
                conductance: e.conductance,
            }),
            (false, true) => own[ua as usize] += e.conductance,
            (true, false) => own[ub as usize] += e.conductance,
            _ => {}
        }
    }
    // The first guess is the rate of the step before.
    let guess: Vec<f64> = list.iter().map(|&k| w * nodes[k].rate).collect();
    let inner = if all_unknown { &graph.edges } else { &inner };
    let [mut change, left] = System::new(&own, inner, &right).complete(&guess)?;
    for ((change, left), k) in change.iter_mut().zip(left).zip(&list) {
        *change += left;
        reached[*k] += *change;
    }
    Ok(advance(
        nodes,
        graph,
        sources,
        &Solved {
            list: &list,
            change: &change,
            reached: &reached,
            below: &below,
        },
        h,
        theta,
    ))
}

/// Solution of a step: changes of the unknowns at theta of the step, and the temperatures of all
/// nodes there.
struct Solved<'a> {
    list: &'a [usize],
    change: &'a [f64],
    reached: &'a [f64],
    below: &'a [Option<Eliminated>],
}

fn advance(
    nodes: &mut [Node],
    graph: &Graph,
    sources: &[f64],
    solved: &Solved<'_>,
    h: f64,
    theta: f64,
) -> Balance {
    let reached = solved.reached;
    let mut balance = Balance {
        through: Vec::with_capacity(graph.edges.len()),
        ..Balance::default()
    };
    for ((node, source), reached) in nodes.iter().zip(sources).zip(reached) {
        balance.sources += h * source;
        if node.store == Store::Fixed {
            balance.fixed += h * source;
        } else {
            balance.surroundings += h * node.surroundings * (node.ambient - reached);
        }
    }
    let fixes = solved.list.len() < nodes.len();
    for e in graph.all() {
        let [a, b] = [e.nodes[0] as usize, e.nodes[1] as usize];
        let flow = h * e.conductance * (reached[b] - reached[a]);
        balance.through.push(flow);
        if fixes {
            for (k, flow) in [(a, flow), (b, -flow)] {
                if nodes[k].store == Store::Fixed {
                    balance.fixed += flow;
                }
            }
        }
    }
    for (u, &k) in solved.list.iter().enumerate() {
        let node = &mut nodes[k];
        let change = solved.change[u];
        match &mut node.store {
            Store::Fixed => {}
            Store::Lumped(capacity) => balance.stored += *capacity * (change / theta),
            Store::HalfSpace(space) => {
                if let Some(eliminated) = &solved.below[u] {
                    balance.stored += space.advance(eliminated, change, theta);
                }
            }
        }
        node.change(change / theta);
        node.rate = change / (theta * h);
        if let Store::HalfSpace(space) = &node.store {
            node.temperature = space.temperature[0];
        }
    }
    balance.through.truncate(graph.edges.len());
    balance.residual = balance.sources + balance.surroundings - balance.stored - balance.fixed;
    balance
}

fn check(
    nodes: &[Node],
    graph: &Graph,
    sources: &[f64],
    h: f64,
    theta: f64,
) -> Result<(), DiffusionError> {
    graph.check()?;
    let refuse = |what, node, value, expected| {
        Err(DiffusionError::Number {
            what,
            node,
            value,
            expected,
        })
    };
    if !(h > 0.0 && h.is_finite()) {
        return refuse("the time step", 0, h, "a number above zero");
    }
    if !(0.5..=1.0).contains(&theta) {
        return refuse("theta", 0, theta, "1/2 to 1");
    }
    for (k, (node, source)) in nodes.iter().zip(sources).enumerate() {
        if !source.is_finite() {
            return refuse("the heat source", k, *source, "a finite number");
        }
        if !node.temperature.is_finite() {
            return refuse("the temperature", k, node.temperature, "a finite number");
        }
        if !(node.surroundings >= 0.0 && node.surroundings.is_finite()) {
            return refuse(
                "the conductance to surroundings",
                k,
                node.surroundings,
                "a finite number, not negative",
            );
        }
        let capacity = match &node.store {
            Store::Fixed => continue,
            Store::Lumped(capacity) => *capacity,
            Store::HalfSpace(space) => space.area,
        };
        if !(capacity > 0.0 && capacity.is_finite()) {
            return refuse(
                "the heat capacity or the area",
                k,
                capacity,
                "a number above zero",
            );
        }
    }
    Ok(())
}
