//! Bodies of either dimension, from descriptions with vectors of three components.

use crate::body::ElasticBody;
use crate::error::BodyError;
use crate::generate::{Grid, mapped_grid};
use crate::half_space::{self, HalfSpace, HalfSpaceError, HalfSpaceSpec};
use crate::material::Elasticity;
use crate::mesh::{Mesh, MeshError};
use crate::spec::{BodySpec, Touching};
use crate::strain::Strain;
use crate::support::{Rayleigh, Support};
use fretwork_core::assembly::AnySystem;
use fretwork_core::bodies::{Dof, DynamicalSystem, TimeFunction};
use fretwork_core::geometry::space::{Dim2, Dim3, Space, VectorLike};
use std::collections::BTreeMap;

/// A mesh of the plane or of space.
#[derive(Clone, Debug)]
pub enum AnyMesh {
    /// In two dimensions.
    Plane(Mesh<Dim2>),
    /// In three dimensions.
    Space(Mesh<Dim3>),
}

impl AnyMesh {
    /// A mesh in so many dimensions, see [`Mesh::new`].
    ///
    /// # Errors
    /// As [`Mesh::new`].
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

    /// The cells of a grid of so many dimensions, whose points are moved; see [`mapped_grid`].
    ///
    /// # Errors
    /// As [`mapped_grid`].
    pub fn mapped(
        dimension: usize,
        grid: &Grid,
        map: &dyn Fn([f64; 3]) -> [f64; 3],
    ) -> Result<Self, MeshError> {
        Ok(match dimension {
            2 => Self::Plane(mapped_grid(grid, moved::<Dim2>(map))?),
            _ => Self::Space(mapped_grid(grid, moved::<Dim3>(map))?),
        })
    }
}

fn vectors<S: Space>(points: &[[f64; 3]]) -> Vec<S::Vector> {
    points.iter().map(|p| S::Vector::from_slice(p)).collect()
}

fn moved<S: Space>(map: &dyn Fn([f64; 3]) -> [f64; 3]) -> impl Fn(&S::Vector) -> S::Vector + '_ {
    move |p| S::Vector::from_slice(&map(p.padded()))
}

/// A body of finite elements, see [`BodySpec`].
#[derive(Clone, Debug)]
pub struct AnyBodySpec<'a> {
    /// What a user calls it.
    pub name: &'a str,
    /// Its mesh.
    pub mesh: AnyMesh,
    /// Where the origin of the mesh is (m).
    pub position: [f64; 3],
    /// Its material.
    pub material: Elasticity,
    /// How its strain is measured.
    pub strain: Strain,
    /// Its damping.
    pub damping: Rayleigh,
    /// What holds and drives it.
    pub supports: &'a [Support],
    /// What of it touches.
    pub touching: Touching<'a>,
    /// Index of the material for interface laws.
    pub surface_material: u16,
    /// Its velocity at the start (m/s), of all that is not held.
    pub velocity: [f64; 3],
    /// Its angular velocity at the start about its centre of mass (rad/s), about the third axis in
    /// 2D; none in small strain, and of parts that move as one.
    pub spin: [f64; 3],
}

impl AnyBodySpec<'_> {
    /// Makes the body, see [`ElasticBody::new`].
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn build(self) -> Result<AnySystem, BodyError> {
        Ok(match self.mesh.clone() {
            AnyMesh::Plane(mesh) => AnySystem::Plane(self.with(mesh)?),
            AnyMesh::Space(mesh) => AnySystem::Space(self.with(mesh)?),
        })
    }

    fn with<S: Space>(self, mesh: Mesh<S>) -> Result<Box<dyn DynamicalSystem<S>>, BodyError> {
        let spin = match S::D {
            2 => S::Spin::from_slice(&self.spin[2..]),
            _ => S::Spin::from_slice(&self.spin),
        };
        Ok(Box::new(ElasticBody::new(BodySpec {
            name: self.name,
            mesh: mesh.moved(&S::Vector::from_slice(&self.position)),
            material: self.material,
            strain: self.strain,
            damping: self.damping,
            supports: self.supports,
            touching: self.touching,
            surface_material: self.surface_material,
            velocity: S::Vector::from_slice(&self.velocity),
            spin,
        })?))
    }
}

/// An elastic half-space, see [`HalfSpaceSpec`].
#[derive(Clone, Debug)]
pub struct AnyHalfSpaceSpec<'a> {
    /// Number of dimensions.
    pub dimension: usize,
    /// What a user calls it.
    pub name: &'a str,
    /// Its material; the density has no effect.
    pub material: Elasticity,
    /// Where it is.
    pub fills: half_space::Fills,
    /// Where the origin of its plane and of the grid is (m).
    pub position: [f64; 3],
    /// The cells that may be loaded.
    pub grid: half_space::Grid,
    /// How far it reaches.
    pub reach: half_space::Reach,
    /// Whether the surface repeats along x with the extent of its cells (2D), in a scene with that
    /// period.
    pub repeats: bool,
    /// Shape of its surface.
    pub profile: half_space::Profile,
    /// Mass that moves with it (kg; kg/m in 2D), zero for none.
    pub mass: f64,
    /// Its drive along each axis; a force (N; N/m in 2D) is that on the whole.
    pub axes: &'a [Dof],
    /// Velocity of its material along x through the cells (m/s).
    pub rolling: Option<TimeFunction>,
    /// How it touches.
    pub touching: half_space::Cells,
    /// Index of the material for interface laws.
    pub surface_material: u16,
}

impl AnyHalfSpaceSpec<'_> {
    /// Makes the half-space, see [`HalfSpace::new`].
    ///
    /// # Errors
    /// See [`HalfSpaceError`].
    pub fn build(self) -> Result<AnySystem, HalfSpaceError> {
        Ok(match self.dimension {
            2 => AnySystem::Plane(self.in_dimension()?),
            _ => AnySystem::Space(self.in_dimension()?),
        })
    }

    fn in_dimension<S: Space>(self) -> Result<Box<dyn DynamicalSystem<S>>, HalfSpaceError> {
        Ok(Box::new(HalfSpace::new(HalfSpaceSpec {
            name: self.name,
            material: self.material,
            fills: self.fills,
            position: S::Vector::from_slice(&self.position),
            grid: self.grid,
            reach: self.reach,
            repeats: self.repeats,
            profile: self.profile,
            mass: self.mass,
            axes: self.axes,
            rolling: self.rolling,
            touching: self.touching,
            surface_material: self.surface_material,
        })?))
    }
}
