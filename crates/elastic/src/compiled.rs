//! The bodies, compiled once for each dimension, so that dependent crates do not compile them
//! again.

use crate::body::ElasticBody;
use crate::error::BodyError;
use crate::grain::{ElasticGrain, ElasticGrainSpec};
use crate::half_space::{HalfSpace, HalfSpaceError, HalfSpaceSpec};
use crate::spec::BodySpec;
use fretwork_core::bodies::DynamicalSystem;
use fretwork_core::geometry::mesh::Mesh;
use fretwork_core::geometry::polyline::Polyline;
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::{Dim2, Dim3, Space};

/// A dimension for which this crate compiles its bodies.
pub trait Deformable: Space {
    /// The surface of vertices (m) and, in space, of triangles between them; in the plane with a
    /// period along x (m), of which the last vertex is the image of the first.
    ///
    /// # Errors
    /// Why they form no surface.
    fn surface(
        vertices: Vec<Self::Vector>,
        facets: &[[u32; 3]],
        period: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String>;

    /// The surface around a solid, of vertices (m), in the plane clockwise, and triangles between
    /// them.
    ///
    /// # Errors
    /// Why they form no surface.
    fn closed_surface(
        vertices: Vec<Self::Vector>,
        facets: &[[u32; 3]],
    ) -> Result<Box<dyn Surface<Self>>, String>;

    /// A grain that deforms, see [`ElasticGrain::new`].
    ///
    /// # Errors
    /// What is out of range.
    fn elastic_grain(
        spec: ElasticGrainSpec<Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, String>;

    /// A body of finite elements, see [`ElasticBody::new`].
    ///
    /// # Errors
    /// See [`BodyError`].
    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError>;

    /// An elastic half-space, see [`HalfSpace::new`].
    ///
    /// # Errors
    /// See [`HalfSpaceError`].
    fn half_space(
        spec: HalfSpaceSpec<'_, Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, HalfSpaceError>;
}

impl Deformable for Dim2 {
    fn surface(
        vertices: Vec<Self::Vector>,
        _facets: &[[u32; 3]],
        period: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let profile = Polyline::new(vertices, period).map_err(|e| e.to_string())?;
        Ok(Box::new(profile))
    }

    fn closed_surface(
        vertices: Vec<Self::Vector>,
        _facets: &[[u32; 3]],
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let surface = Polyline::closed(vertices).map_err(|e| e.to_string())?;
        Ok(Box::new(surface))
    }

    fn elastic_grain(
        spec: ElasticGrainSpec<Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, String> {
        Ok(Box::new(ElasticGrain::new(spec)?))
    }

    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError> {
        Ok(Box::new(ElasticBody::new(spec)?))
    }

    fn half_space(
        spec: HalfSpaceSpec<'_, Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, HalfSpaceError> {
        Ok(Box::new(HalfSpace::new(spec)?))
    }
}

impl Deformable for Dim3 {
    fn surface(
        vertices: Vec<Self::Vector>,
        facets: &[[u32; 3]],
        _period: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let mesh = Mesh::new(vertices, facets.to_vec()).map_err(|e| e.to_string())?;
        Ok(Box::new(mesh.with_wear()))
    }

    fn closed_surface(
        vertices: Vec<Self::Vector>,
        facets: &[[u32; 3]],
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let surface = Mesh::closed(vertices, facets.to_vec()).map_err(|e| e.to_string())?;
        Ok(Box::new(surface))
    }

    fn elastic_grain(
        spec: ElasticGrainSpec<Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, String> {
        Ok(Box::new(ElasticGrain::new(spec)?))
    }

    fn elastic_body(spec: BodySpec<'_, Self>) -> Result<Box<dyn DynamicalSystem<Self>>, BodyError> {
        Ok(Box::new(ElasticBody::new(spec)?))
    }

    fn half_space(
        spec: HalfSpaceSpec<'_, Self>,
    ) -> Result<Box<dyn DynamicalSystem<Self>>, HalfSpaceError> {
        Ok(Box::new(HalfSpace::new(spec)?))
    }
}
