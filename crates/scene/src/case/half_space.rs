//! Elastic half-spaces in a case.

use super::elastic::{one, some};
use super::{Side, WearSpec};
use fretwork_core::bodies::{Dof, TimeFunction};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A body that is large compared with its contacts: its surface deforms as that of a half-space,
/// instantaneously and without inertia. Young's modulus and Poisson's ratio are those of its
/// material; in 2D the strain is plane.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfSpaceSpec {
    /// Name.
    pub name: String,
    /// Name of its material in this case; its file has the properties `young` and `poisson`.
    pub material: String,
    /// Side of the surface that is solid.
    #[serde(default = "below")]
    pub side: Side,
    /// Position of the origin of the surface (m); the origin by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position: Vec<f64>,
    /// Cells of the surface along x.
    pub x: CellSpec,
    /// Cells of the surface along y (3D).
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub y: Option<CellSpec>,
    /// Depth below a load at which the displacement is zero (m): required in 2D and where the cells
    /// are periodic; infinite in 3D.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub depth: Option<f64>,
    /// Whether the cells and their loads are periodic along the surface; the surface itself is,
    /// too, where the case is periodic along x.
    #[serde(default)]
    pub periodic: bool,
    /// Shape of the surface without load; flat by default.
    #[serde(default)]
    pub profile: HalfSpaceProfile,
    /// Mass that moves with the half-space (kg; kg/m in 2D): required where it is free or under a
    /// force.
    #[serde(default)]
    pub mass: f64,
    /// Supports and drives of the distant holder.
    #[serde(default)]
    pub dofs: HolderSpec,
    /// Velocity of the material along x through the cells (m/s), for a rolling surface.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub rolling: Option<TimeFunction>,
    /// How the cells of the surface touch.
    pub touches: CellTouch,
    /// Wear of the surface; it does not recede by default.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub wears: Option<WearSpec>,
}

/// The cells of a surface along an axis (m).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellSpec {
    /// Start of the cells (m).
    pub from: f64,
    /// End of the cells (m).
    pub to: f64,
    /// Size of a cell (m), rounded so that a whole number fits.
    pub size: f64,
}

/// The shape of the surface of a half-space without load.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum HalfSpaceProfile {
    /// A plane.
    #[default]
    Flat,
    /// A summit at the origin with radii of curvature (m): a cylinder where one is omitted, a
    /// sphere where both are equal.
    Summit {
        /// Radius in the plane of x (m).
        #[serde(default = "straight")]
        x: f64,
        /// Radius in the plane of y (3D, m).
        #[serde(default = "straight")]
        y: f64,
    },
    /// A wave with a crest at the origin.
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
    /// Self-affine roughness with random phases from the seed, over the extent of the cells (2D).
    Rough {
        /// Root mean square height (m).
        rms: f64,
        /// Hurst exponent.
        #[serde(default = "hurst")]
        hurst: f64,
        /// Longest wave (m); the extent of the cells by default.
        #[serde(
            default,
            deserialize_with = "some",
            skip_serializing_if = "Option::is_none"
        )]
        longest: Option<f64>,
        /// Shortest wave (m).
        shortest: f64,
    },
    /// Outward heights over the plane (m) of each cell: row by row along x. A file has them as
    /// numbers, in lines along x.
    Heights {
        /// The file, beside the case.
        file: String,
        /// Length of the unit of the heights (m).
        #[serde(default = "one")]
        scale: f64,
    },
}

/// Supports and drives of a half-space: fixed along each axis by default.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HolderSpec {
    /// Drive along x.
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

/// How the cells of a half-space touch. Where two deformable bodies meet, one of them must touch by
/// its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum CellTouch {
    /// The middle of each cell touches balls, pieces and surfaces.
    Points,
    /// The cells form a surface, which touches grains and points.
    Surface,
}

fn below() -> Side {
    Side::Below
}

pub(super) fn straight() -> f64 {
    f64::INFINITY
}

pub(super) fn hurst() -> f64 {
    0.8
}
