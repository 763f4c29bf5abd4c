//! Wear of the individual first bodies.

use super::quantity::unit::{METRE, VOLUME, WEAR_RATE, WORD};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use serde::Serialize;
use std::collections::BTreeMap;

crate::described! {
    /// Wear of a first body.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub struct BodyWear {
        /// Its name.
        pub body: String => WORD,
        /// Volume worn off the body.
        pub volume: f64 => VOLUME,
        /// Mean depth over the worn area; null if none of its surfaces recedes.
        pub depth_mean: Option<f64> => METRE,
        /// Largest depth; null if none of its surfaces recedes.
        pub depth_max: Option<f64> => METRE,
        /// Specific wear rate k = V/(P s); null without a friction test.
        pub specific_rate: Option<f64> => WEAR_RATE,
    }
}

/// What each first body lost: volume and depths of its scars. A friction test adds the specific
/// wear rate.
pub fn wear<S: Space>(s: &Simulation<S>) -> Vec<BodyWear> {
    let mut bodies: BTreeMap<u32, Worn> = BTreeMap::new();
    for (surface, volume) in &s.state.network.worn {
        if let Some(carried) = s.shapes.surfaces.get(*surface) {
            bodies.entry(carried.body).or_default().volume += volume;
        }
    }
    for scar in s.state.scars.iter().filter(|scar| scar.volume() > 0.0) {
        let Some(carried) = s.shapes.surfaces.get(scar.surface) else {
            continue;
        };
        let worn = bodies.entry(carried.body).or_default();
        worn.scarred = true;
        worn.depth = worn.depth.max(scar.deepest());
        for (vertex, depth) in scar.vertices().filter(|(_, depth)| *depth > 0.0) {
            worn.area += vertex.tributary;
            worn.put += vertex.tributary * depth;
        }
    }
    let summary = |(body, worn): (u32, Worn)| BodyWear {
        body: name(s, body),
        volume: worn.volume,
        depth_mean: (worn.area > 0.0).then(|| worn.put / worn.area),
        depth_max: worn.scarred.then_some(worn.depth),
        specific_rate: None,
    };
    bodies.into_iter().map(summary).collect()
}

/// Sums over the surfaces of a body.
#[derive(Default)]
struct Worn {
    volume: f64,
    /// Volume removed by its scars (m^3; m^3/m), and their area (m^2; m).
    put: f64,
    area: f64,
    depth: f64,
    scarred: bool,
}

fn name<S: Space>(s: &Simulation<S>, body: u32) -> String {
    let driven = s.state.bodies.driven.iter().find(|d| d.body == body);
    let carrier = s.state.bodies.carrier(body as usize);
    let system = carrier.and_then(|c| s.state.systems.get(c.system as usize));
    match (driven, system) {
        (Some(driven), _) => driven.name.clone(),
        (None, Some(system)) => system.name().to_owned(),
        (None, None) => format!("body {}", s.state.bodies.id[body as usize]),
    }
}
