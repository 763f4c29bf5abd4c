//! Bodies that deform, as dynamical systems of the core: finite elements in small strain, in large
//! rotation, and in large strain, and elastic half-spaces; and contact patches in closed form.

pub mod any;
pub mod body;
pub mod corotational;
pub mod element;
pub mod error;
mod facet_spin;
pub mod freedom;
pub mod generate;
pub mod grain;
pub mod half_space;
pub mod large_strain;
pub mod material;
pub mod matrix;
pub mod mesh;
mod model;
pub mod neo_hookean;
mod newton;
mod panels;
pub mod patch;
pub mod rigid;
pub mod small_strain;
pub mod spec;
pub mod strain;
pub mod support;
pub mod surface;
mod touching_surface;

pub use any::AnyMesh;
pub use body::ElasticBody;
pub use error::BodyError;
pub use grain::{ElasticGrain, ElasticGrainSpec, GrainShape};
pub use half_space::{HalfSpace, HalfSpaceSpec};
pub use material::Elasticity;
pub use mesh::Mesh;
pub use spec::{BodySpec, Touching};
pub use strain::Strain;
pub use support::{Rayleigh, Support};
