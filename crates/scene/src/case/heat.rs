//! Heat and electric current of a case.

use fretwork_core::heat::{HeatShares, Partition, Supply};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Heat of a case: what is warm at the start, what becomes of dissipated energy, and what first
/// bodies do with heat. Materials then have `conductivity` and `heat_capacity`; heat flows through
/// the contacts of interfaces with a `transport` law.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct HeatSpec {
    /// Temperature of everything at the start (K).
    pub initial: f64,
    /// Temperature at the start of the grains of a material (K), by the names of this case;
    /// `initial` for the others.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub grains: BTreeMap<String, f64>,
    /// Convection at the surfaces of all grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convection: Option<ConvectionSpec>,
    /// What first bodies do with heat, by their names; one that is not named keeps its temperature.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bodies: BTreeMap<String, BodyHeatSpec>,
    /// Share of each dissipated energy that becomes heat at its contact.
    pub shares: HeatShares,
    /// How the heat of a contact is split between its sides.
    pub partition: Partition,
    /// Thermal time over mechanical time: each step lets heat flow for `clock` times as long, while
    /// what it puts in stays the same.
    pub clock: f64,
    /// Steps of the mechanics per step of the heat.
    pub every: u64,
    /// Time from which on heat flows and is put in (s); 0 by default. What dissipates before, as in
    /// a compaction, warms nothing.
    pub start: f64,
    /// Theta of the heat's time scheme, 1/2 to 1.
    pub theta: f64,
    /// Whether bodies expand by the `expansion` (1/K) of their materials, from their size at the
    /// start: rigid grains, first bodies of balls, polygons or polyhedra that are `Lumped`, and
    /// bodies of `elastic`.
    #[serde(skip_serializing_if = "is_false")]
    pub expansion: bool,
    /// Hardness (Pa) of the softer bodies, from which the flash temperature of sliding spots
    /// follows; without it contacts have the temperature of their bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flash: Option<f64>,
    /// An electric current between two first bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub circuit: Option<ElectricSpec>,
}

impl Default for HeatSpec {
    /// All at 20 degrees Celsius; all energy but that of fracture becomes heat.
    fn default() -> Self {
        Self {
            initial: 293.15,
            grains: BTreeMap::new(),
            convection: None,
            bodies: BTreeMap::new(),
            shares: HeatShares::default(),
            partition: Partition::default(),
            clock: 1.0,
            every: 1,
            start: 0.0,
            theta: 1.0,
            expansion: false,
            flash: None,
            circuit: None,
        }
    }
}

/// Heat flow to surroundings in proportion to the difference of temperature.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ConvectionSpec {
    /// Heat transfer coefficient (W/(m^2 K)).
    pub coefficient: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
}

/// What a first body does with heat.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodyHeatSpec {
    /// Where its heat goes: `Fixed` (the default), `Insulated`, `Lumped(...)`, `HalfSpace(...)`, or
    /// of finite elements `Mesh(...)`.
    pub store: StoreSpec,
    /// Its temperature at the start (K); that of the case without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Heat that flows into it from outside (W; W/m in 2D), at the surfaces of its pieces.
    #[serde(skip_serializing_if = "is_zero")]
    pub power: f64,
    /// Convection at a face of it; of a half-space at the surfaces of its pieces, since nothing
    /// leaves at its depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convection: Option<FaceSpec>,
}

fn is_false(x: &bool) -> bool {
    !x
}

fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

/// Convection at a face of a lumped body, or at the surface of a half-space.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct FaceSpec {
    /// Heat transfer coefficient (W/(m^2 K)).
    pub coefficient: f64,
    /// Area of the face (m^2; in 2D its length, m).
    pub area: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
}

/// Where the heat of a first body goes.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub enum StoreSpec {
    /// It keeps its temperature.
    #[default]
    Fixed,
    /// No heat enters it: that of its contacts all goes to the other side.
    Insulated,
    /// It has one temperature.
    Lumped {
        /// Heat capacity (J/K; J/(K m) in 2D); from the material where the body has balls, polygons
        /// or polyhedra.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        capacity: Option<f64>,
    },
    /// A half-space below each piece of its surface, in which heat flows along the depth:
    /// `HalfSpace(x: 40)`.
    HalfSpace(DepthSpec),
    /// Heat flows in its finite elements; of the bodies of `elastic` only: `Mesh()`.
    Mesh(MeshHeatSpec),
}

/// What happens at the boundary of a body of finite elements, by the names of its parts; no heat
/// flows through the rest, but for contacts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct MeshHeatSpec {
    /// Parts that keep a temperature (K).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub fixed: BTreeMap<String, f64>,
    /// Parts with convection.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub convection: BTreeMap<String, ConvectionSpec>,
    /// Parts with a heat flux from outside (W/m^2).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub flux: BTreeMap<String, f64>,
}

/// A half-space below each piece of a surface.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct DepthSpec {
    /// Number of pieces along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<u32>,
    /// Along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<u32>,
    /// Along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<u32>,
    /// Where the pieces begin and end along each of these axes (m), in the axes of the body; by
    /// default over the period, or over the extent of the body's profiles, balls and polygons.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<(f64, f64)>,
    /// Depth to which heat can go (m); by default six times the distance that it comes during the
    /// run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// First spacing of the grid below the surface (m); by default 0.3 of the distance that heat
    /// comes in a step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Factor from each spacing to the next; 1.2 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
}

/// An electric current between two first bodies.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ElectricSpec {
    /// Name of the body that the current enters.
    pub from: String,
    /// Name of the body that it leaves, of potential 0.
    pub to: String,
    /// `Voltage(V)`, or `Current(current: A, limit: V)`: a current source with the voltage that it
    /// does not exceed.
    pub supply: Supply,
}
