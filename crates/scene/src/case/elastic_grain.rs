//! Deformable grains in a case.

use super::elastic::some;
use fretwork_elastic::Rayleigh;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Makes the grains of a material deformable: balls, polygons and polyhedra, from any source.
/// Density, Young's modulus and Poisson's ratio are those of the material.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticGrainSpec {
    /// Name of the material in this case; its file has the properties `young` and `poisson`.
    pub material: String,
    /// Number of elements along the radius of a grain; 4 in 2D and 2 in 3D by default.
    #[serde(
        default,
        deserialize_with = "some",
        skip_serializing_if = "Option::is_none"
    )]
    pub elements: Option<usize>,
    /// Damping of the grains; none by default.
    #[serde(default)]
    pub damping: Rayleigh,
}
