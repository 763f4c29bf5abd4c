//! The stepper's part of heat and current: temperatures for the laws at the start of a step, and the heat of the step at its end.

use super::answers::relative_velocity;
use super::fields::{heat_of_contacts, heat_of_grains};
use super::{Simulation, StepError};
use crate::bodies::Nodes;
use crate::contact::{Bond, Contact, ContactHeat, ContactTemperature, HeatSide};
use crate::geometry::space::{Space, VectorLike};
use crate::heat::{BodyNodes, CircuitState, DiffusionError, Heat, HeatState, Imposed, Store};
use crate::threads::{fill, pays};
use fretwork_math::diffusion::{Edge, Graph, steady, step_with_columns};
use std::sync::Arc;

/// Of a node that is of no first body.
const NONE: u32 = u32::MAX;

/// About what it takes to find the temperatures of a contact, and the heat of what it dissipated (ns).
const SEES: f64 = 20.0;
const WARMS: f64 = 3.0;

/// Where the heat of a contact enters one of its bodies, and the temperature there (K), without meaning where it is insulated.
#[derive(Clone, Copy, Default)]
struct End {
    side: HeatSide,
    temperature: f64,
}

impl End {
    fn insulated(&self) -> bool {
        self.side == HeatSide::Insulated
    }
}

impl<S: Space> Simulation<S> {
    /// Computes heat, and current where there is a circuit, from here on.
    pub fn set_heat(&mut self, heat: Heat, state: HeatState) {
        self.fields.grains.add(heat_of_grains());
        for field in heat_of_contacts() {
            self.fields.contacts.add(field);
        }
        self.heat = Some(heat);
        self.state.heat = Some(state);
    }

    /// Temperature of a body (K): the mean over the nodes of its surface, or by capacity over its mesh; `None` where it has none or no heat is
    /// computed.
    pub fn temperature(&self, body: usize) -> Option<f64> {
        self.mean_temperature(self.heat.as_ref()?.nodes.get(body)?.range())
    }

    /// Mean temperature of some nodes (K): by their capacities where they have one; `None` of no node.
    pub fn mean_temperature(&self, nodes: std::ops::Range<usize>) -> Option<f64> {
        let nodes = self.state.heat.as_ref()?.nodes.get(nodes)?;
        if let [node] = nodes {
            return Some(node.temperature);
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for node in nodes {
            let weight = match &node.store {
                Store::Lumped(capacity) => *capacity,
                Store::HalfSpace(_) => 1.0,
                // A held part of a mesh, unless all of it is held.
                Store::Fixed => 1e-300,
            };
            sum += weight * node.temperature;
            weights += weight;
        }
        (!nodes.is_empty()).then(|| sum / weights)
    }

    /// Keeps a body that was taken away from its surroundings: its heat leaves with it.
    pub(super) fn insulate(&mut self, body: usize) {
        if let (Some(heat), Some(state)) = (&self.heat, &mut self.state.heat) {
            for node in &mut state.nodes[heat.nodes[body].range()] {
                node.surroundings = 0.0;
            }
        }
    }

    /// The nodes at which the heat of a contact enters a body that is a mesh of which the nodes begin at `first`.
    fn mesh_side(
        &self,
        first: u32,
        (contact, side): (&Contact<S>, usize),
        between: &mut Vec<Nodes>,
    ) -> HeatSide {
        let Some(carrier) = self.state.bodies.carrier(contact.bodies[side] as usize) else {
            return HeatSide::Insulated;
        };
        // The nearest place of the facet, whose shape functions are not negative; weights of a mean place may be.
        let systems = &self.state.systems;
        let nodes = systems.contact_nodes(carrier, &contact.arms[side]);
        let terms = nodes.terms().map(|(node, weight)| (first + node, weight));
        let terms: Vec<(u32, f64)> = terms.collect();
        match (&terms[..], Nodes::sum(&terms)) {
            ([(node, _)], _) => HeatSide::Node(*node),
            (_, Some(nodes)) => {
                between.push(nodes);
                HeatSide::Between(between.len() as u32 - 1)
            }
            (_, None) => HeatSide::Insulated,
        }
    }

    /// Gives the laws the temperatures of the contacts, as at the start of the step.
    pub(super) fn gather_temperatures(&mut self) {
        let (Some(heat), Some(state)) = (&self.heat, &self.state.heat) else {
            return;
        };
        let contacts = &self.state.network.contacts;
        let mut thermal = self.state.network.thermal.take().unwrap_or_default();
        thermal.current = heat.circuit.is_some();
        thermal.conducts = thermal.current || state.pending_steps + 1 >= heat.every;
        thermal.conductance.clear();
        thermal.conductance.resize(contacts.len(), [0.0; 2]);
        thermal.between.clear();
        thermal.pairs = Arc::clone(&heat.pairs);
        let flash = heat.flash.is_some() && self.begun(heat);
        let temperature = |node: usize| state.nodes[node].temperature;
        let of_node = |node: u32| End {
            side: HeatSide::Node(node),
            temperature: temperature(node as usize),
        };
        // Ends of bodies of one temperature, contiguous; none of those of several nodes.
        let ends: Vec<Option<End>> = heat
            .nodes
            .iter()
            .map(|nodes| match nodes {
                BodyNodes::Insulated => Some(End::default()),
                BodyNodes::One(node) => Some(of_node(*node)),
                BodyNodes::Pieces(..) | BodyNodes::Mesh(..) => None,
            })
            .collect();
        let end = |contact: &Contact<S>, side: usize| {
            let body = contact.bodies[side] as usize;
            if let Some(end) = ends[body] {
                return end;
            }
            let place = || S::unrotate(&self.state.bodies.rotation[body], &contact.arms[side]);
            heat.nodes[body]
                .at::<S>(place)
                .map_or(End::default(), of_node)
        };
        let see = |contact: &Contact<S>, first: End, second: End| {
            let pair = heat.pair(contact.bodies);
            // An insulated body has the temperature of what it touches.
            let [a, b] = match (first.insulated(), second.insulated()) {
                (false, false) => [first.temperature, second.temperature],
                (false, true) => [first.temperature; 2],
                (true, false) => [second.temperature; 2],
                (true, true) => [heat.initial; 2],
            };
            // Two half-spaces of these temperatures meet at this one.
            let mut mean = b + heat.pairs[pair].share * (a - b);
            if flash {
                mean += self.flash_rise(heat, contact, self.options.scheme.h);
            }
            ContactTemperature {
                temperature: [mean, a, b],
                sides: [first.side, second.side],
                pair: pair as u32,
            }
        };
        let of_mesh = |body: u32| match heat.nodes[body as usize] {
            BodyNodes::Mesh(first, _) => Some(first),
            _ => None,
        };
        let meshes = (heat.nodes.iter()).any(|nodes| matches!(nodes, BodyNodes::Mesh(..)));
        let mut seen = std::mem::take(&mut thermal.seen);
        let divide = pays(self.options.solver.parallel, contacts.len(), SEES);
        fill(divide, &mut seen, contacts.len(), |k| {
            let contact = &contacts[k];
            if meshes && contact.bodies.iter().any(|b| of_mesh(*b).is_some()) {
                // Found below.
                return ContactTemperature::default();
            }
            see(contact, end(contact, 0), end(contact, 1))
        });
        if meshes {
            for (contact, seen) in contacts.iter().zip(&mut seen) {
                let own = contact.bodies.map(of_mesh);
                if own == [None; 2] {
                    continue;
                }
                let ends = [0, 1].map(|side| match own[side] {
                    None => end(contact, side),
                    Some(first) => {
                        let side = self.mesh_side(first, (contact, side), &mut thermal.between);
                        let temperature = thermal.temperature_of(side, temperature);
                        let temperature = temperature.unwrap_or(0.0);
                        End { side, temperature }
                    }
                });
                *seen = see(contact, ends[0], ends[1]);
            }
        }
        thermal.seen = seen;
        self.state.network.thermal = Some(thermal);
    }

    /// Whether the heat has begun: a step belongs to where its middle is.
    pub(super) fn begun(&self, heat: &Heat) -> bool {
        self.state.time + 0.5 * self.options.scheme.h >= heat.start
    }

    /// Flash temperature of a contact (K), by its force in the last step and its sliding speed at the start of this one, both of thermal time; 0 where
    /// it does not slide, or a bond holds it, whose force is not friction.
    fn flash_rise(&self, heat: &Heat, contact: &Contact<S>, h: f64) -> f64 {
        let bonded = self.state.network.bond(contact).is_some_and(Bond::intact);
        if !contact.slides || bonded {
            return 0.0;
        }
        let force = contact.impulse * (1.0 / h);
        let velocity = relative_velocity(&self.state.bodies, contact);
        let sliding = S::tangential(&contact.normal, &velocity) * (1.0 / heat.clock);
        let friction = S::tangential(&contact.normal, &force);
        let power = -friction.dot(&sliding);
        let normal = contact.normal.dot(&force);
        let rise = heat.flash_rise::<S>(contact.bodies, normal, sliding.norm(), power);
        if rise.is_finite() { rise } else { 0.0 }
    }

    /// Puts in the heat of the solved step, and has it flow.
    pub(super) fn conduct(&mut self) -> Result<(), StepError> {
        let Some(heat) = self.heat.take() else {
            return Ok(());
        };
        let done = self.conduct_by(&heat);
        self.heat = Some(heat);
        done.map_err(|source| StepError::Heat {
            step: self.state.steps + 1,
            time: self.state.time,
            source,
        })
    }

    fn conduct_by(&mut self, heat: &Heat) -> Result<(), DiffusionError> {
        let (Some(mut state), Some(mut thermal)) =
            (self.state.heat.take(), self.state.network.thermal.take())
        else {
            return Ok(());
        };
        let done = self.heat_of_step(heat, &mut state, &mut thermal);
        self.state.heat = Some(state);
        self.state.network.thermal = Some(thermal);
        done
    }

    fn heat_of_step(
        &self,
        heat: &Heat,
        state: &mut HeatState,
        thermal: &mut ContactHeat,
    ) -> Result<(), DiffusionError> {
        let contacts = &self.state.network.contacts;
        let span = heat.clock * self.options.scheme.h;
        let dissipation = self.state.network.dissipation.as_ref();
        let dissipation = dissipation.filter(|_| self.begun(heat));
        let divide = pays(self.options.solver.parallel, contacts.len(), WARMS);
        fill(divide, &mut thermal.source, contacts.len(), |k| {
            dissipation.map_or(0.0, |dissipation| heat.shares.heat(&dissipation[k]))
        });
        if !self.begun(heat) {
            return Ok(());
        }
        state.ledger.dissipated += thermal.source.iter().sum::<f64>();
        self.flow_of_current(heat, state, thermal, span)?;
        let first_bodies = nodes_of_first_bodies(heat, state.nodes.len());
        let mut warm = |node: usize, part: f64| {
            state.pending[node] += part;
            if let Some(received) = state.received.get_mut(first_bodies[node] as usize) {
                *received += part;
            }
        };
        for (seen, source) in thermal.seen.iter().zip(&thermal.source) {
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
        for Imposed { body, node, flow } in &heat.imposed {
            let removed = |body: u32| self.state.bodies.removed.get(body as usize);
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
            self.conduct_pending(heat, state, thermal, &first_bodies)?;
        }
        state.ledger.close(&state.received);
        Ok(())
    }

    /// The step of the heat.
    fn conduct_pending(
        &self,
        heat: &Heat,
        state: &mut HeatState,
        thermal: &ContactHeat,
        first_bodies: &[u32],
    ) -> Result<(), DiffusionError> {
        let span = state.pending_time;
        let mut graph = Graph::new(state.nodes.len(), Vec::with_capacity(thermal.seen.len()));
        graph.elements.clone_from(&heat.elements);
        for (seen, [conductance, _]) in thermal.seen.iter().zip(&thermal.conductance) {
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
                    // Each pair by itself, so that no conductance is negative; rounding may make a shape function so.
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
        state.ledger.book(&balance, exchanged);
        state.pending.fill(0.0);
        (state.pending_time, state.pending_steps) = (0.0, 0);
        Ok(())
    }

    /// Finds the potentials of the circuit, and adds Joule's heat of each contact to its sources.
    fn flow_of_current(
        &self,
        heat: &Heat,
        state: &mut HeatState,
        thermal: &mut ContactHeat,
        span: f64,
    ) -> Result<(), DiffusionError> {
        let Some(circuit) = &heat.circuit else {
            return Ok(());
        };
        let contacts = &self.state.network.contacts;
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
            self.state.bodies.len(),
            conducting.iter().map(|(_, edge)| *edge).collect(),
        );
        let mut fixed = vec![None; graph.nodes];
        fixed[circuit.from as usize] = Some(1.0);
        fixed[circuit.to as usize] = Some(0.0);
        // The potentials are linear in the voltage: those of 1 V give the conductance.
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
}

/// For each node the place of its first body, `NONE` where it is of a grain.
fn nodes_of_first_bodies(heat: &Heat, nodes: usize) -> Vec<u32> {
    let mut of = vec![NONE; nodes];
    for ((_, range), place) in heat.first_bodies.iter().zip(0..) {
        of[range.clone()].fill(place);
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use fretwork_math::diffusion::Node;

    /// By capacity; nodes of fixed temperature, of which there is no finite store, count only where there is nothing else.
    #[test]
    fn the_mean_temperature_is_that_of_the_heat_that_is_stored() {
        let mut s = Simulation::<Dim2>::of_disks(&[]);
        let lumped = |t, c| Node::new(t, Store::Lumped(c));
        let fixed = |t| Node::new(t, Store::Fixed);
        let nodes = vec![
            fixed(900.0),
            fixed(100.0),
            lumped(300.0, 1.0),
            lumped(400.0, 3.0),
        ];
        s.state.heat = Some(HeatState::new(nodes, 0));
        let mean = |range| s.mean_temperature(range);
        assert_eq!(mean(2..4), Some(375.0));
        assert_eq!(mean(1..3), Some(300.0));
        assert_eq!(mean(0..4), Some(375.0));
        assert!((mean(0..2).unwrap() - 500.0).abs() < 1e-9);
        assert_eq!(mean(0..1), Some(900.0));
        assert_eq!((mean(1..1), mean(3..5)), (None, None));
    }
}
