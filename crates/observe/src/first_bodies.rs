//! Wear of the individual first bodies.

use super::quantity::unit::{METRE, ONE, PASCAL, VOLUME, WEAR_RATE, WORD};
use fretwork_core::laws::Kind;
use fretwork_core::view::RunView;
use fretwork_scene::{LoadedCase, wear_motion};
use serde::Serialize;
use std::collections::BTreeMap;

crate::described! {
    /// Wear of a first body.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub struct BodyWear {
        /// Name of the body.
        pub body: String => WORD,
        /// Volume worn off the body.
        pub volume: f64 => VOLUME,
        /// Mean depth over the worn area; null if none of its surfaces recedes.
        pub depth_mean: Option<f64> => METRE,
        /// Largest depth; null if none of its surfaces recedes.
        pub depth_max: Option<f64> => METRE,
        /// Specific wear rate k = V/(P s), s the distance of slip; null without a friction test.
        pub specific_rate: Option<f64> => WEAR_RATE,
        /// Archard's coefficient K = k H (J. F. Archard 1953); null where the material of the body
        /// has no hardness.
        pub archard_coefficient: Option<f64> => ONE,
        /// Its hardness H.
        pub hardness: Option<f64> => PASCAL,
    }
}

/// Hardness with which the wear of a first body is expressed: that of its material, or of a softer
/// one that it wears with.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyHardness {
    /// Name of the body.
    pub body: String,
    /// Hardness (Pa).
    pub value: f64,
    /// As its file gives it, with the material: `260 HBW of rail_steel_r260`.
    pub text: String,
}

/// What wear is expressed with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WearMaterials {
    /// Density of the first bodies (kg/m^3), of which flows of mass count the worn volume.
    pub density: f64,
    /// Hardnesses, of the first bodies whose materials have one.
    pub hardness: Vec<BodyHardness>,
    /// Hardnesses of the first bodies by their own materials, with which the wear of grains that
    /// break off is expressed.
    pub own_hardness: Vec<BodyHardness>,
    /// Densities of the materials of the case in their order (kg/m^3).
    pub densities: Vec<f64>,
    /// First bodies without a surface in a case without grains, which wear each other in contacts
    /// that belong to no surface; empty with grains.
    pub without_surface: Vec<String>,
    /// Whether no body of the case has a surface.
    pub no_surface: bool,
    /// Coefficients that were measured in another motion than that of the case, in sentences.
    pub other_motion: Vec<String>,
}

impl WearMaterials {
    /// Returns those of a case; `any` is whether it has first bodies.
    pub fn of(loaded: &LoadedCase, run: &dyn RunView, any: bool) -> Self {
        let case = &loaded.case;
        let bodies = case.bodies.iter().map(|b| (&b.name, &b.material));
        let elastic = case.elastic.iter().map(|b| (&b.name, &b.material));
        let half_spaces = case.half_spaces.iter().map(|b| (&b.name, &b.material));
        let all = bodies.clone().chain(elastic).chain(half_spaces);
        // A law with K takes the hardness of the softer material of its interface.
        let worn = case
            .interfaces
            .iter()
            .filter(|i| i.laws.get(Kind::WEAR).is_some());
        let pairs: Vec<_> = worn.map(|i| &i.between).collect();
        let softest = |material: &String| {
            let others = pairs.iter().filter_map(|(a, b)| match material {
                m if m == a => Some(b),
                m if m == b => Some(a),
                _ => None,
            });
            let all = others.chain([material]).filter_map(|m| loaded.hardness(m));
            all.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let own = all.clone().filter_map(|(body, material)| {
            let (value, text) = loaded.hardness(material)?;
            Some(BodyHardness {
                body: body.clone(),
                value,
                text,
            })
        });
        let hardness = all.filter_map(|(body, material)| {
            loaded.hardness(material)?;
            let (value, text) = softest(material)?;
            Some(BodyHardness {
                body: body.clone(),
                value,
                text,
            })
        });
        let density = |name: &String| loaded.density(name).unwrap_or(0.0);
        let first = bodies.map(|b| b.1).next().filter(|_| any);
        Self {
            density: first.map_or(0.0, density),
            own_hardness: own.collect(),
            hardness: hardness.collect(),
            densities: case.materials.keys().map(density).collect(),
            without_surface: without_surface(run),
            no_surface: run.surfaces().is_empty() && run.system_count() == 0,
            other_motion: wear_motion::measured_otherwise(loaded, run),
        }
    }
}

impl WearMaterials {
    /// Returns what wears in contacts without a surface, as the end of a sentence.
    pub(crate) fn without_surface(&self) -> String {
        match self.without_surface.is_empty() {
            true => "between grains".to_owned(),
            false => format!("of {} together", self.without_surface.join(", ")),
        }
    }
}

/// Returns the first bodies without a surface of a case without grains.
fn without_surface(run: &dyn RunView) -> Vec<String> {
    if run.grain_flags().contains(&true) {
        return Vec::new();
    }
    let surfaces = run.surfaces();
    let driven = run.bodies().driven.iter();
    let bare = driven.filter(|d| surfaces.iter().all(|s| s.body != d.body));
    bare.map(|d| d.name.clone()).collect()
}

/// Returns the loss of each first body: volume and depths of its scars. A friction test adds the
/// specific wear rate.
pub fn wear(run: &dyn RunView) -> Vec<BodyWear> {
    let mut bodies: BTreeMap<u32, WornBody> = BTreeMap::new();
    let surfaces = run.surfaces();
    for (surface, volume) in run.worn() {
        if let Some(carried) = surfaces.get(*surface) {
            bodies.entry(carried.body).or_default().volume += volume;
        }
    }
    let scars = run.scars().into_iter().enumerate();
    for (k, scar) in scars.filter(|(_, scar)| scar.volume > 0.0) {
        let Some(carried) = surfaces.get(scar.surface) else {
            continue;
        };
        let worn = bodies.entry(carried.body).or_default();
        worn.scarred = true;
        worn.depth = worn.depth.max(scar.deepest);
        let vertices = run.scar_vertices(k).into_iter();
        for vertex in vertices.filter(|vertex| vertex.depth > 0.0) {
            worn.area += vertex.tributary;
            worn.put += vertex.tributary * vertex.depth;
        }
    }
    let summary = |(body, worn): (u32, WornBody)| BodyWear {
        body: name_of(run, body),
        volume: worn.volume,
        depth_mean: (worn.area > 0.0).then(|| worn.put / worn.area),
        depth_max: worn.scarred.then_some(worn.depth),
        specific_rate: None,
        archard_coefficient: None,
        hardness: None,
    };
    bodies.into_iter().map(summary).collect()
}

#[derive(Default)]
struct WornBody {
    volume: f64,
    /// Volume removed by its scars (m^3; m^3/m), and their area (m^2; m).
    put: f64,
    area: f64,
    depth: f64,
    scarred: bool,
}

/// Returns the name of a first body by its index.
pub(crate) fn name_of(run: &dyn RunView, body: u32) -> String {
    let bodies = run.bodies();
    let driven = bodies.driven.iter().find(|d| d.body == body);
    let carrier = bodies.carrier(body as usize);
    let system = carrier.and_then(|c| run.system(c.system as usize));
    match (driven, system) {
        (Some(driven), _) => driven.name.clone(),
        (None, Some(system)) => system.name().to_owned(),
        (None, None) => format!("body {}", bodies.id[body as usize]),
    }
}
