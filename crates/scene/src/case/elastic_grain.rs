//! Grains that deform, in a case.

use super::elastic::some;
use fretwork_elastic::Rayleigh;
use serde::{Deserialize, Serialize};

/// Lets the grains of a material deform: balls, polygons and polyhedra, however they were made.
/// Density, Young's modulus and Poisson's ratio are those of the material.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ElasticGrainSpec {
    /// Name of the material in this case; its file has the properties `young` and `poisson`.
    pub material: String,
    /// Elements along the radius of a grain; 4 in 2D and 2 in 3D by default.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub elements: Option<usize>,
    /// Their damping; none by default.
    #[serde(default)]
    pub damping: Rayleigh,
}
