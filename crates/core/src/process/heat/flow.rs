//! Heat in a step: supplied by dissipation, current and the surroundings, it flows through contacts
//! and bodies.

use super::has_begun;
use crate::contact::{ContactHeat, HeatSide};
use crate::geometry::space::Space;
use crate::heat::{CircuitState, DiffusionError, Heat, HeatState, ImposedHeatFlow};
use crate::step::Simulation;
use crate::threads::{fill, worth_dividing};
use fretwork_math::diffusion::{Edge, Graph, steady, step_with_columns};

/// Index of the first body of a node that belongs to a grain.
const NONE: u32 = u32::MAX;
/// Approximate time to compute the heat dissipated at a contact (ns).
const SOURCE_TIME: f64 = 3.0;

/// Adds the heat of the solved step, and computes its flow.
pub(super) fn conduct<S: Space>(heat: &Heat, s: &mut Simulation<S>) -> Result<(), DiffusionError> {
    let (Some(mut state), Some(mut thermal)) =
        (s.state.heat.take(), s.state.network.thermal.take())
    else {
        return Ok(());
    };
    let done = heat_of_step(s, heat, &mut state, &mut thermal);
    s.state.heat = Some(state);
    s.state.network.thermal = Some(thermal);
    done
}

fn heat_of_step<S: Space>(
    s: &Simulation<S>,
    heat: &Heat,
    state: &mut HeatState,
    thermal: &mut ContactHeat,
) -> Result<(), DiffusionError> {
    let contacts = &s.state.network.contacts;
    let span = heat.clock * s.options.scheme.h;
    let dissipation = s.state.network.dissipation.as_ref();
    let dissipation = dissipation.filter(|_| has_begun(heat, s));
    let divide = worth_dividing(s.options.solver.parallel, contacts.len(), SOURCE_TIME);
    fill(divide, &mut thermal.source, contacts.len(), |k| {
        dissipation.map_or(0.0, |dissipation| heat.shares.heat(&dissipation[k]))
    });
    if !has_begun(heat, s) {
        return Ok(());
    }
    state.ledger.dissipated += thermal.source.iter().sum::<f64>();
    flow_of_current(s, heat, state, thermal, span)?;
    let first_bodies = nodes_of_first_bodies(heat, state.nodes.len());
    let mut warm = |node: usize, part: f64| {
        state.pending[node] += part;
        if let Some(received) = state.received.get_mut(first_bodies[node] as usize) {
            *received += part;
        }
    };
    for (seen, source) in thermal.temperatures.iter().zip(&thermal.source) {
        if *source == 0.0 {
            continue;
        }
        let share = match seen.sides {
            [HeatSide::Insulated, HeatSide::Insulated] => {
                state.ledger.fixed += source;
                continue;
            }
            [_, HeatSide::Insulated] => 1.0,
            [HeatSide::Insulated, _] => 0.0,
            _ => heat.share(seen.pair as usize),
        };
        state.ledger.pending += source;
        for (side, part) in seen.sides.iter().zip([share, 1.0 - share]) {
            match side {
                HeatSide::Insulated => {}
                HeatSide::Node(node) => warm(*node as usize, part * source),
                HeatSide::Between(_) => {
                    let terms = thermal.terms(*side);
                    terms.for_each(|(node, weight)| warm(node, weight * part * source));
                }
            }
        }
    }
    for ImposedHeatFlow { body, node, flow } in &heat.imposed {
        let removed = |body: u32| s.state.bodies.removed.get(body as usize);
        if body.and_then(removed).is_some_and(|removed| *removed) {
            continue;
        }
        state.pending[*node as usize] += flow * span;
        state.ledger.imposed += flow * span;
        state.ledger.pending += flow * span;
    }
    state.pending_time += span;
    state.pending_steps += 1;
    if state.pending_steps >= heat.every {
        conduct_pending(heat, state, thermal, &first_bodies)?;
    }
    state.ledger.close(&state.received);
    Ok(())
}

/// The step of the heat.
fn conduct_pending(
    heat: &Heat,
    state: &mut HeatState,
    thermal: &ContactHeat,
    first_bodies: &[u32],
) -> Result<(), DiffusionError> {
    let span = state.pending_time;
    let mut graph = Graph::new(
        state.nodes.len(),
        Vec::with_capacity(thermal.temperatures.len()),
    );
    graph.elements.clone_from(&heat.elements);
    for (seen, [conductance, _]) in thermal.temperatures.iter().zip(&thermal.conductance) {
        if *conductance == 0.0 {
            continue;
        }
        let sides = &seen.sides;
        if let [HeatSide::Node(a), HeatSide::Node(b)] = *sides {
            graph.edges.push(Edge {
                nodes: [a, b],
                conductance: *conductance,
            });
            continue;
        }
        for (a, one) in thermal.terms(sides[0]) {
            for (b, other) in thermal.terms(sides[1]) {
                // Each pair is limited separately, so that no conductance is negative; rounding may
                // make a shape function negative.
                let weight = (one * other).max(0.0);
                graph.edges.push(Edge {
                    nodes: [a as u32, b as u32],
                    conductance: weight * conductance,
                });
            }
        }
    }
    let sources: Vec<f64> = state.pending.iter().map(|q| q / span).collect();
    let balance = step_with_columns(
        &mut state.nodes,
        (&graph, &heat.columns),
        &sources,
        span,
        heat.theta,
    )?;
    let mut exchanged = 0.0;
    for (edge, &flow) in graph.edges.iter().zip(&balance.through) {
        let [a, b] = edge.nodes.map(|n| n as usize);
        exchanged += flow.abs();
        for (node, flow) in [(a, flow), (b, -flow)] {
            if first_bodies[node] != NONE {
                state.received[first_bodies[node] as usize] += flow;
            }
        }
    }
    state.ledger.add_step(&balance, exchanged);
    state.pending.fill(0.0);
    (state.pending_time, state.pending_steps) = (0.0, 0);
    Ok(())
}

/// Finds the potentials of the circuit, and adds Joule's heat of each contact to its sources.
fn flow_of_current<S: Space>(
    s: &Simulation<S>,
    heat: &Heat,
    state: &mut HeatState,
    thermal: &mut ContactHeat,
    span: f64,
) -> Result<(), DiffusionError> {
    let Some(circuit) = &heat.circuit else {
        return Ok(());
    };
    let contacts = &s.state.network.contacts;
    let conducting = contacts.iter().zip(&thermal.conductance);
    let conducting: Vec<(usize, Edge)> = conducting
        .enumerate()
        .filter(|(_, (_, conductance))| conductance[1] > 0.0)
        .map(|(k, (contact, conductance))| {
            let edge = Edge {
                nodes: contact.bodies,
                conductance: conductance[1],
            };
            (k, edge)
        })
        .collect();
    let graph = Graph::new(
        s.state.bodies.len(),
        conducting.iter().map(|(_, edge)| *edge).collect(),
    );
    let mut fixed = vec![None; graph.nodes];
    fixed[circuit.from as usize] = Some(1.0);
    fixed[circuit.to as usize] = Some(0.0);
    // The potentials are linear in the voltage: those for 1 V give the conductance.
    let unit = steady(&graph, &fixed, &vec![0.0; graph.nodes])?;
    let conductance = unit.given[circuit.from as usize].max(0.0);
    let voltage = circuit.voltage(conductance);
    state.circuit = CircuitState {
        voltage,
        current: voltage * conductance,
        conductance,
        potential: unit.potential.iter().map(|v| v * voltage).collect(),
    };
    let mut joule = 0.0;
    for ((k, edge), current) in conducting.iter().zip(&unit.current) {
        let source = (voltage * current).powi(2) / edge.conductance * span;
        thermal.source[*k] += source;
        joule += source;
    }
    state.ledger.joule += joule;
    Ok(())
}

/// Returns the index of the first body of each node, `NONE` for nodes of grains.
fn nodes_of_first_bodies(heat: &Heat, nodes: usize) -> Vec<u32> {
    let mut of = vec![NONE; nodes];
    for ((_, range), place) in heat.first_bodies.iter().zip(0..) {
        of[range.clone()].fill(place);
    }
    of
}
