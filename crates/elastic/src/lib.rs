//! Bodies that deform, as dynamical systems of the core: finite elements of linear elasticity, and elastic half-spaces.

pub mod body;
pub mod compiled;
pub mod element;
pub mod error;
pub mod freedom;
pub mod generate;
pub mod half_space;
pub mod material;
pub mod matrix;
pub mod mesh;
mod model;
pub mod rigid;
pub mod support;
pub mod surface;

pub use body::{BodySpec, ElasticBody, Touching};
pub use compiled::Deformable;
pub use error::BodyError;
pub use half_space::{HalfSpace, HalfSpaceSpec};
pub use material::Elasticity;
pub use mesh::Mesh;
pub use support::{Rayleigh, Support};
