//! Deformable bodies in a case.

use super::WearSpec;
use super::half_space::{hurst, straight};
use fretwork_core::bodies::Dof;
use fretwork_elastic::{Rayleigh, Strain};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// A body of finite elements; in 2D the strain is plane. Its density, Young's modulus and Poisson's
/// ratio are those of its material.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticSpec {
    /// Name.
    pub name: String,
    /// Name of its material in this case; its file has the properties `young` and `poisson`.
    pub material: String,
    /// Mesh of the body.
    pub mesh: MeshSpec,
    /// Measure of strain; small strain by default.
    #[serde(default)]
    pub strain: Strain,
    /// Position of the origin of the mesh (m); the origin by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position: Vec<f64>,
    /// Velocity at the start (m/s); at rest by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
    /// Angular velocity at the start about the centre of mass (rad/s), in 3D with three components;
    /// not in small strain.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin: Vec<f64>,
    /// Supports and drives of parts of the boundary.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub supports: Vec<SupportSpec>,
    /// Contact surface: `Surface("top")` or `Points("bottom")`; none by default.
    #[serde(default)]
    pub touches: TouchSpec,
    /// Wear of the contact surface; it does not recede by default.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub wears: Option<WearSpec>,
    /// Damping of the body; none by default.
    #[serde(default)]
    pub damping: Rayleigh,
}

/// The mesh of a deformable body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum MeshSpec {
    /// A block with its sides along the axes. Its sides are the parts `left`, `right` (x),
    /// `bottom`, `top` (y in 2D, z in 3D), `front`, `back` (y in 3D).
    Block {
        /// Points along x.
        x: LineSpec,
        /// Points along y.
        y: LineSpec,
        /// Points along z (3D).
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        z: Option<LineSpec>,
        /// A side that is not flat.
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        round: Option<RoundSpec>,
        /// A side with a profile, in place of `round`.
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        profile: Option<Box<MeshProfileSpec>>,
        /// Cells that join along the side too as their height grows with the distance from it.
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        coarsen: Option<Box<CoarsenSpec>>,
    },
    /// A mesh in Gmsh's format (version 2.2 or 4.1, as text) with triangles (2D) or tetrahedra
    /// (3D); its parts are the named physical groups of lines or triangles.
    Gmsh {
        /// The file, beside the case.
        file: String,
        /// Length of the unit of the file (m).
        #[serde(default = "one")]
        scale: f64,
    },
}

/// The points of a block along an axis (m).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineSpec {
    /// The lowest.
    pub from: f64,
    /// The highest.
    pub to: f64,
    /// Size of an element.
    pub size: f64,
    /// Range of coordinates where elements have this size; outside they grow. Everywhere by
    /// default.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub fine: Option<(f64, f64)>,
    /// Ratio of the sizes of neighbouring elements where they grow.
    #[serde(default = "growth")]
    pub growth: f64,
}

/// Columns of cells of a block that join in pairs with the distance from a side.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoarsenSpec {
    /// The side, of which all cells are kept.
    pub from: String,
    /// Largest ratio of the width of a joined pair to the height of its row.
    #[serde(default = "one")]
    pub ratio: f64,
}

/// A side of a block as part of a circle (2D), a sphere or a cylinder (3D), whose middle touches
/// the flat side that it replaces.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoundSpec {
    /// `top` or `bottom`.
    pub side: String,
    /// Radius (m).
    pub radius: f64,
    /// Whether the side in 3D is part of a cylinder along y instead of a sphere.
    #[serde(default)]
    pub cylinder: bool,
}

/// A side of a block with heights over the flat side that it replaces.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshProfileSpec {
    /// `top` or `bottom`.
    pub side: String,
    /// Heights of the side, outward.
    pub shape: ProfileShape,
}

/// Heights over a flat side.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ProfileShape {
    /// A wave with a crest at the origin of the mesh.
    Wave {
        /// Amplitude of the wave (m).
        amplitude: f64,
        /// Wavelength along x (m).
        #[serde(default = "straight")]
        x: f64,
        /// Wavelength along y (3D, m): the surface is a product of both waves.
        #[serde(default = "straight")]
        y: f64,
    },
    /// Self-affine roughness with random phases from the seed, over the length of the block (2D).
    Rough {
        /// Root mean square height (m).
        rms: f64,
        /// Hurst exponent.
        #[serde(default = "hurst")]
        hurst: f64,
        /// Longest wave (m); the length of the block by default.
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        longest: Option<f64>,
        /// Shortest wave (m).
        shortest: f64,
    },
    /// A table of positions `x` and heights `z` (m), with linear interpolation (2D): a measured
    /// profile, or one that a run wrote.
    Table {
        /// The file, beside the case.
        file: String,
    },
}

/// A part of the boundary in a holder that does not rotate, see [`fretwork_elastic::Support`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SupportSpec {
    /// Name of the part.
    pub part: String,
    /// Drive along x: `Free` as a whole, `Fixed`, `Velocity(...)`, `Displacement(...)` or
    /// `Force(...)`; by default each point moves by itself.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub x: Option<Dof>,
    /// Drive along y.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub y: Option<Dof>,
    /// Drive along z (3D).
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub z: Option<Dof>,
}

/// Contact surface of a deformable body. Where two such bodies meet, one of them must touch by its
/// points.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TouchSpec {
    /// The body does not touch.
    #[default]
    Nothing,
    /// The points of a part: against balls, pieces and surfaces.
    Points(String),
    /// A part as a surface: against grains and points.
    Surface(String),
}

/// Deserializes a value without `Some(...)` around it.
pub(super) fn some<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    from: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(from).map(Some)
}

pub(super) fn one() -> f64 {
    1.0
}

fn growth() -> f64 {
    1.2
}
