//! The temperatures of contacts at the start of the step, which laws receive.

use super::has_begun;
use crate::bodies::Nodes;
use crate::contact::{Bond, Contact, ContactTemperature, HeatSide};
use crate::geometry::space::{Space, VectorLike};
use crate::heat::{BodyNodes, Heat};
use crate::step::Simulation;
use crate::threads::{fill, worth_dividing};
use std::sync::Arc;

/// Approximate time to compute the temperatures of a contact (ns).
const TEMPERATURE_TIME: f64 = 20.0;

/// Node at which the heat of a contact enters one of its bodies, and the temperature there (K);
/// undefined where it is insulated.
#[derive(Clone, Copy, Default)]
struct HeatEntry {
    side: HeatSide,
    temperature: f64,
}

impl HeatEntry {
    fn insulated(&self) -> bool {
        self.side == HeatSide::Insulated
    }
}

/// Returns the nodes at which the heat of a contact enters a body that is a mesh whose nodes begin
/// at `first`.
fn mesh_side<S: Space>(
    s: &Simulation<S>,
    first: u32,
    (contact, side): (&Contact<S>, usize),
    between: &mut Vec<Nodes>,
) -> HeatSide {
    let Some(carrier) = s.state.bodies.carrier(contact.bodies[side] as usize) else {
        return HeatSide::Insulated;
    };
    // The nearest position on the facet is used, whose shape functions are not negative; weights of
    // a mean position may be.
    let systems = &s.state.systems;
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

/// Passes the temperatures of the contacts at the start of the step to the laws.
pub(super) fn gather_temperatures<S: Space>(heat: &Heat, s: &mut Simulation<S>) {
    let mut thermal = s.state.network.thermal.take().unwrap_or_default();
    let Some(state) = &s.state.heat else {
        return;
    };
    let contacts = &s.state.network.contacts;
    thermal.current = heat.circuit.is_some();
    thermal.conducts = thermal.current || state.pending_steps + 1 >= heat.every;
    thermal.conductance.clear();
    thermal.conductance.resize(contacts.len(), [0.0; 2]);
    thermal.between.clear();
    thermal.pairs = Arc::clone(&heat.pairs);
    let flash = heat.flash.is_some() && has_begun(heat, s);
    let temperature = |node: usize| state.nodes[node].temperature;
    let of_node = |node: u32| HeatEntry {
        side: HeatSide::Node(node),
        temperature: temperature(node as usize),
    };
    // Entries of bodies with one temperature are contiguous; bodies with several nodes have none.
    let ends: Vec<Option<HeatEntry>> = heat
        .nodes
        .iter()
        .map(|nodes| match nodes {
            BodyNodes::Insulated => Some(HeatEntry::default()),
            BodyNodes::One(node) => Some(of_node(*node)),
            BodyNodes::Pieces(..) | BodyNodes::Mesh(..) => None,
        })
        .collect();
    let end = |contact: &Contact<S>, side: usize| {
        let body = contact.bodies[side] as usize;
        if let Some(end) = ends[body] {
            return end;
        }
        let place = || S::unrotate(&s.state.bodies.rotation[body], &contact.arms[side]);
        heat.nodes[body]
            .at::<S>(place)
            .map_or(HeatEntry::default(), of_node)
    };
    let temperatures_of = |contact: &Contact<S>, first: HeatEntry, second: HeatEntry| {
        let pair = heat.pair(contact.bodies);
        // An insulated body has the temperature of the other body.
        let [a, b] = match (first.insulated(), second.insulated()) {
            (false, false) => [first.temperature, second.temperature],
            (false, true) => [first.temperature; 2],
            (true, false) => [second.temperature; 2],
            (true, true) => [heat.initial; 2],
        };
        // Two half-spaces of these temperatures in contact have this surface temperature.
        let mut mean = b + heat.pairs[pair].share * (a - b);
        if flash {
            mean += flash_rise(s, heat, contact, s.options.scheme.h);
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
    let mut seen = std::mem::take(&mut thermal.temperatures);
    let divide = worth_dividing(s.options.solver.parallel, contacts.len(), TEMPERATURE_TIME);
    fill(divide, &mut seen, contacts.len(), |k| {
        let contact = &contacts[k];
        if meshes && contact.bodies.iter().any(|b| of_mesh(*b).is_some()) {
            // The temperature is computed below.
            return ContactTemperature::default();
        }
        temperatures_of(contact, end(contact, 0), end(contact, 1))
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
                    let side = mesh_side(s, first, (contact, side), &mut thermal.between);
                    let temperature = thermal.temperature_of(side, temperature);
                    let temperature = temperature.unwrap_or(0.0);
                    HeatEntry { side, temperature }
                }
            });
            *seen = temperatures_of(contact, ends[0], ends[1]);
        }
    }
    thermal.temperatures = seen;
    s.state.network.thermal = Some(thermal);
}

/// Returns the flash temperature of a contact (K), from its force in the last step and its sliding
/// speed at the start of this one, both in thermal time; 0 where it does not slide, or a bond holds
/// it, whose force is not friction.
fn flash_rise<S: Space>(s: &Simulation<S>, heat: &Heat, contact: &Contact<S>, h: f64) -> f64 {
    let bonded = s.state.network.bond(contact).is_some_and(Bond::intact);
    if !contact.slides || bonded {
        return 0.0;
    }
    let force = contact.impulse * (1.0 / h);
    let velocity = contact.relative_velocity(&s.state.bodies);
    let sliding = S::tangential(&contact.normal, &velocity) * (1.0 / heat.clock);
    let friction = S::tangential(&contact.normal, &force);
    let power = -friction.dot(&sliding);
    let normal = contact.normal.dot(&force);
    let rise = heat.flash_rise::<S>(contact.bodies, normal, sliding.norm(), power);
    if rise.is_finite() { rise } else { 0.0 }
}
