//! Bodies of either dimension, from descriptions with vectors of three components.

use crate::body::ElasticBody;
use crate::error::BodyError;
use crate::generate::{BlockGrid, mapped_grid};
use crate::half_space::{HalfSpace, HalfSpaceError, HalfSpaceSpec};
use crate::mesh::{Mesh, MeshError};
use crate::spec::BodySpec;
use fretwork_core::assembly::AnySystem;
use fretwork_core::geometry::space::{Dim2, Dim3, Space, VectorLike};
use std::collections::BTreeMap;

/// A mesh of the plane or of space.
#[derive(Clone, Debug)]
pub enum AnyMesh {
    /// Mesh in two dimensions.
    Plane(Mesh<Dim2>),
    /// Mesh in three dimensions.
    Space(Mesh<Dim3>),
}

impl AnyMesh {
    /// Creates a mesh in a dimension, see [`Mesh::new`].
    ///
    /// # Errors
    /// Returns the errors of [`Mesh::new`].
    pub fn new(
        dimension: usize,
        points: &[[f64; 3]],
        elements: Vec<u32>,
        parts: &BTreeMap<String, Vec<u32>>,
    ) -> Result<Self, MeshError> {
        Ok(match dimension {
            2 => Self::Plane(Mesh::new(vectors::<Dim2>(points), elements, parts)?),
            _ => Self::Space(Mesh::new(vectors::<Dim3>(points), elements, parts)?),
        })
    }

    /// Creates the mesh of a grid in a dimension, whose points are moved; see [`mapped_grid`].
    ///
    /// # Errors
    /// Returns the errors of [`mapped_grid`].
    pub fn mapped(
        dimension: usize,
        grid: &BlockGrid,
        map: &dyn Fn([f64; 3]) -> [f64; 3],
    ) -> Result<Self, MeshError> {
        Ok(match dimension {
            2 => Self::Plane(mapped_grid(grid, moved::<Dim2>(map))?),
            _ => Self::Space(mapped_grid(grid, moved::<Dim3>(map))?),
        })
    }

    /// The mesh, moved by a vector (m).
    #[must_use]
    pub fn moved(self, by: &[f64; 3]) -> Self {
        match self {
            Self::Plane(mesh) => Self::Plane(mesh.moved(&VectorLike::from_slice(by))),
            Self::Space(mesh) => Self::Space(mesh.moved(&VectorLike::from_slice(by))),
        }
    }
}

fn vectors<S: Space>(points: &[[f64; 3]]) -> Vec<S::Vector> {
    points.iter().map(|p| S::Vector::from_slice(p)).collect()
}

fn moved<S: Space>(map: &dyn Fn([f64; 3]) -> [f64; 3]) -> impl Fn(&S::Vector) -> S::Vector + '_ {
    move |p| S::Vector::from_slice(&map(p.padded()))
}

impl BodySpec<'_, AnyMesh> {
    /// Makes the body, see [`ElasticBody::new`].
    ///
    /// # Errors
    /// Returns the errors that [`BodyError`] lists.
    pub fn build(self) -> Result<AnySystem, BodyError> {
        Ok(match self.mesh.clone() {
            AnyMesh::Plane(mesh) => AnySystem::Plane(Box::new(ElasticBody::new(self.of(mesh))?)),
            AnyMesh::Space(mesh) => AnySystem::Space(Box::new(ElasticBody::new(self.of(mesh))?)),
        })
    }
}

impl HalfSpaceSpec<'_> {
    /// Creates the half-space in a dimension, see [`HalfSpace::new`].
    ///
    /// # Errors
    /// Returns the errors that [`HalfSpaceError`] lists.
    pub fn build(self, dimension: usize) -> Result<AnySystem, HalfSpaceError> {
        Ok(match dimension {
            2 => AnySystem::Plane(Box::new(HalfSpace::new(self)?)),
            _ => AnySystem::Space(Box::new(HalfSpace::new(self)?)),
        })
    }
}
