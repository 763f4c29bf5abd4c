//! The bodies, compiled once for each dimension, so that dependent crates do not compile them again.

use crate::body::{BodyError, BodySpec, ElasticBody};
use fretwork_core::bodies::DynamicalSystem;
use fretwork_core::geometry::space::{Dim2, Dim3, Space};

/// A dimension for which this crate compiles its bodies.
pub trait Deformable: Space {
    /// A body of finite elements, see [`ElasticBody::new`].
    ///
    /// # Errors
    /// See [`BodyError`].
    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError>;
}

impl Deformable for Dim2 {
    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError> {
        Ok(Box::new(ElasticBody::new(spec)?))
    }
}

impl Deformable for Dim3 {
    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError> {
        Ok(Box::new(ElasticBody::new(spec)?))
    }
}
