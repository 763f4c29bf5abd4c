//! Reasons why a body cannot be created.

use crate::material::ElasticityError;
use crate::mesh::MeshError;

/// Reason why a body cannot be created.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// The mesh is invalid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The material is invalid.
    #[error(transparent)]
    Material(#[from] ElasticityError),
    /// The mesh has no such part.
    #[error("the mesh has no part `{0}`; its parts are {1}")]
    NoPart(String, String),
    /// One displacement has two different drives.
    #[error(
        "parts `{0}` and `{1}` share points that both drive along {2}: leave that axis out of one of them"
    )]
    Twice(String, String, &'static str),
    /// A drive imposes motion at one time and a force at another.
    #[error(
        "the drive of part `{0}` imposes motion at one time and a force at another; a deformable body cannot change that within a run"
    )]
    Changes(String),
    /// A touching part in pieces.
    #[error(
        "the part `{0}` is no single chain of segments with two ends, see the point at {1} m: name a part of the outline that is one, without its whole circumference"
    )]
    NoChain(String, String),
    /// The facets form no surface.
    #[error("the part `{0}` cannot touch as a surface: {1}")]
    NoSurface(String, String),
    /// Damping is negative or not finite.
    #[error("factors of Rayleigh damping must not be negative, got {0:e} 1/s and {1:e} s")]
    Damping(f64, f64),
    /// Nothing prevents rotation of the body.
    #[error(
        "nothing keeps the body `{0}` from turning, and small strain cannot follow a rotation: hold one of its parts along one axis more, or give it `strain: Corotational` or `strain: NeoHookean`"
    )]
    Turns(String),
    /// A motion out of the plane of a body in 2D.
    #[error(
        "the body `{0}` lies in a plane: its velocity has two components, along x and y, and its spin one, about z"
    )]
    OutOfPlane(String),
    /// A spin in small strain.
    #[error(
        "the body `{0}` spins, and small strain cannot follow a rotation: give it `strain: Corotational` or `strain: NeoHookean`"
    )]
    Spins(String),
}
