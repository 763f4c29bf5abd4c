//! Heat and electric current of a case.

use fretwork_core::heat::{HeatShares, Partition, Supply};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Heat of a case: initial temperatures, conversion of dissipated energy, and thermal behaviour of
/// first bodies. Materials then need `conductivity` and `heat_capacity`; heat flows through the
/// contacts of interfaces with a `transport` law.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeatSpec {
    /// Initial temperature of all bodies (K).
    pub initial: f64,
    /// Initial temperature of the grains of a material (K), by the names of this case; `initial`
    /// for the others.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub grains: BTreeMap<String, f64>,
    /// Convection at the surfaces of all grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convection: Option<ConvectionSpec>,
    /// Thermal behaviour of first bodies, by their names; a body that is not named has a fixed
    /// temperature.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bodies: BTreeMap<String, BodyHeatSpec>,
    /// Share of each dissipated energy that becomes heat at its contact.
    pub shares: HeatShares,
    /// Split of the heat of a contact between its sides.
    pub partition: Partition,
    /// Ratio of thermal to mechanical time: in each step heat flows for `clock` times as long,
    /// while the supplied heat does not change.
    pub clock: f64,
    /// Number of steps of the mechanics per step of the heat.
    pub every: u64,
    /// Time from which heat flows and is supplied (s); 0 by default. Energy dissipated before it,
    /// for example in a compaction, heats nothing.
    pub start: f64,
    /// Theta of the heat's time scheme, 1/2 to 1.
    pub theta: f64,
    /// Whether bodies expand by the `expansion` (1/K) of their materials, relative to their size at
    /// the start: rigid grains, first bodies of balls, polygons or polyhedra that are `Lumped`, and
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
    /// Returns 20 degrees Celsius for all bodies, and full conversion of all energies except that
    /// of fracture.
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

/// Heat flow to surroundings, proportional to the difference of temperature.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConvectionSpec {
    /// Heat transfer coefficient (W/(m^2 K)).
    pub coefficient: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
}

/// Thermal behaviour of a first body.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BodyHeatSpec {
    /// Store of its heat: `Fixed` (the default), `Insulated`, `Lumped(...)`, `HalfSpace(...)`, or
    /// for finite elements `Mesh(...)`.
    pub store: StoreSpec,
    /// Initial temperature (K); by default that of the case.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Heat flow into it from outside (W; W/m in 2D), at the surfaces of its pieces.
    #[serde(skip_serializing_if = "is_zero")]
    pub power: f64,
    /// Convection at a face of it; for a half-space at the surfaces of its pieces, since nothing
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
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceSpec {
    /// Heat transfer coefficient (W/(m^2 K)).
    pub coefficient: f64,
    /// Area of the face (m^2; in 2D its length, m).
    pub area: f64,
    /// Temperature of the surroundings (K).
    pub ambient: f64,
}

/// Store of the heat of a first body.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub enum StoreSpec {
    /// The temperature of the body is constant.
    #[default]
    Fixed,
    /// No heat enters the body: all heat of its contacts goes to the other side.
    Insulated,
    /// The body has one temperature.
    Lumped {
        /// Heat capacity (J/K; J/(K m) in 2D); from the material where the body has balls, polygons
        /// or polyhedra.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        capacity: Option<f64>,
    },
    /// A half-space below each piece of its surface, in which heat flows along the depth:
    /// `HalfSpace(x: 40)`.
    HalfSpace(DepthSpec),
    /// Heat flows in the finite elements of the body; for bodies of `elastic` only: `Mesh()`.
    Mesh(MeshHeatSpec),
}

/// Boundary conditions of a body of finite elements, by the names of its parts; no heat flows
/// through the rest, except at contacts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshHeatSpec {
    /// Temperatures of parts with a fixed temperature (K).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub fixed: BTreeMap<String, f64>,
    /// Parts with convection.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub convection: BTreeMap<String, ConvectionSpec>,
    /// Heat flux into parts from outside (W/m^2).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub flux: BTreeMap<String, f64>,
}

/// A half-space below each piece of a surface.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DepthSpec {
    /// Number of pieces along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<u32>,
    /// Number of pieces along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<u32>,
    /// Number of pieces along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<u32>,
    /// Start and end of the pieces along each of these axes (m), in the axes of the body; by
    /// default the period, or the extent of the body's profiles, balls and polygons.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<(f64, f64)>,
    /// Depth of the half-space (m); by default six times the diffusion length of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// First spacing of the grid below the surface (m); by default 0.3 of the diffusion length of a
    /// step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Ratio of successive spacings; 1.2 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
}

/// An electric current between two first bodies.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElectricSpec {
    /// Name of the body that the current enters.
    pub from: String,
    /// Name of the body that the current leaves, with potential 0.
    pub to: String,
    /// `Voltage(V)`, or `Current(current: A, limit: V)`: a current source with a limit of its
    /// voltage.
    pub supply: Supply,
}
