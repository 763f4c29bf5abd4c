//! A deformable grain: a rigid body with elastic modes relative to it (floating frame of
//! reference).
//!
//! With the position c of its frame, its orientation R and the amplitudes eta of its modes, the
//! point X of the grain has the position and velocity
//!
//! ```text
//! x = c + R (X + u),  u = sum_k phi_k(X) eta_k
//! dx/dt = V + w x R (X + u) + R sum_k phi_k(X) deta_k/dt
//! ```
//!
//! Frame and modes have the energies M V^2/2 + w . J w/2 + sum (deta_k^2 + lambda_k eta_k^2)/2 with
//! the inertia J of the grain without load: the inertial coupling of rotation and modes is
//! neglected, which causes strains of the order rho w^2 R^2/E. Momentum and energy of this system
//! are conserved to rounding as those of rigid bodies are. Strain in the frame is small; rotations
//! are not.
//!
//! Source: A. A. Shabana, Dynamics of Multibody Systems, 4th ed. (2013), chapters 5 and 6; for
//! modes of free bodies section 6.1 of T. J. R. Hughes, The Finite Element Method (1987), chapter
//! 9.

mod dynamics;
pub mod mesh;
pub mod shape;

pub use shape::GrainShape;

use crate::material::Elasticity;
use crate::support::Rayleigh;
use crate::touching_surface::closed_surface;
use fretwork_core::bodies::tensor::InertiaTensor;
use fretwork_core::bodies::{Contactor, ContactorShape, Nodes};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Parameters of a deformable grain.
#[derive(Clone, Debug)]
pub struct ElasticGrainSpec<S: Space> {
    /// Name in messages.
    pub name: String,
    /// Shape.
    pub shape: Arc<GrainShape<S>>,
    /// Length of the unit of its shape (m).
    pub size: f64,
    /// Radius of the ball (2D: disk) of the same mass (m): for a ball its radius, for other shapes
    /// the radius of the ball of the same volume.
    pub radius: f64,
    /// Material.
    pub material: Elasticity,
    /// Damping.
    pub damping: Rayleigh,
    /// Index of the material for interface laws.
    pub surface_material: u16,
    /// Position of the centre of mass (m).
    pub position: S::Vector,
    /// Orientation.
    pub rotation: S::Rotation,
    /// Velocity (m/s).
    pub velocity: S::Vector,
    /// Angular velocity (rad/s).
    pub spin: S::Spin,
    /// Displacements of the points of the mesh in the frame (m), and their rates (m/s); empty for a
    /// grain without strain.
    pub displacement: [Vec<S::Vector>; 2],
}

/// Data that depend on the length of a step.
#[derive(Debug)]
struct ModalResponse {
    /// Values of h and theta.
    of: [f64; 2],
    /// 1/(1 + h theta c_k + h^2 theta^2 lambda_k) for each mode.
    over: Vec<f64>,
    /// Elastic compliance of the coordinates of the surface in the frame (1/kg), column by column
    /// as they are touched.
    columns: Vec<OnceLock<Vec<f64>>>,
}

/// Constant data, shared by copies.
#[derive(Debug)]
struct GrainModel<S: Space> {
    name: String,
    shape: Arc<GrainShape<S>>,
    size: f64,
    material: Elasticity,
    damping: Rayleigh,
    contactor: Contactor,
    mass: f64,
    /// Moments of inertia in the frame, and their inverse (kg m^2).
    inertia: S::Tensor,
    inverse: S::Tensor,
    /// Inertia tensor, where the moments of inertia differ by axis.
    tensor: Option<InertiaTensor<S>>,
    /// The displacement of a mode of the shape at an amplitude of 1 (m).
    scale: f64,
    /// Squared angular frequency lambda of each mode (1/s^2).
    rates: Vec<f64>,
    /// Position and orientation at which the grain was created.
    origin: (S::Vector, S::Rotation),
}

/// The state of a grain between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct GrainState<S: Space> {
    position: S::Vector,
    rotation: S::Rotation,
    /// Angular momentum (kg m^2/s).
    momentum: S::Spin,
    amplitudes: Vec<f64>,
    /// Velocity of the frame, its angular velocity, and the rates of the amplitudes.
    velocity: Vec<f64>,
}

/// A grain at q_m, before contacts act.
#[derive(Clone, Debug)]
struct GrainAtDetection<S: Space> {
    rotation: S::Rotation,
    /// Angular velocity at q_m by free rotation from the start of the step, which contacts see
    /// (rad/s).
    spin: S::Spin,
    /// Angular velocity at the end of the step without contacts (rad/s).
    free: S::Spin,
}

/// A deformable grain.
#[derive(Clone, Debug)]
pub struct ElasticGrain<S: Space> {
    model: Arc<GrainModel<S>>,
    formed: Option<Arc<ModalResponse>>,
    state: GrainState<S>,
    /// State at the start of the step.
    start: GrainState<S>,
    middle: GrainAtDetection<S>,
    /// Positions of the vertices of the surface in the frame (m).
    vertices: Vec<S::Vector>,
}

impl<S: Space> ElasticGrain<S> {
    /// Builds a grain.
    ///
    /// # Errors
    /// A property of the material is out of range, or the shape has no surface.
    pub fn new(spec: ElasticGrainSpec<S>) -> Result<Self, String> {
        spec.material.check().map_err(|e| e.to_string())?;
        let (shape, size) = (&spec.shape, spec.size);
        let Elasticity { young, density, .. } = spec.material;
        let mass = density * S::ball_volume(spec.radius);
        // A mesh within a ball has less volume.
        let density = mass / (shape.volume() * size.powi(S::D as i32));
        let inertia = shape.inertia().scaled(density * size.powi(S::D as i32 + 2));
        let tensor = InertiaTensor::<S>::new(inertia);
        let uniform = S::Tensor::uniform(fretwork_core::bodies::tensor::mean::<S>(&inertia));
        let inertia = if tensor.is_some() { inertia } else { uniform };
        let inverse = inertia
            .inverse()
            .ok_or("its mesh has no moment of inertia")?;
        let rate = young / (density * size * size);
        let model = GrainModel {
            contactor: Contactor {
                nodes: Nodes::one(0),
                radius: spec.radius,
                shape: ContactorShape::Grain,
                material: spec.surface_material,
            },
            scale: 1.0 / (density * size.powi(S::D as i32)).sqrt(),
            rates: shape.rates().iter().map(|r| rate * r).collect(),
            origin: (spec.position, spec.rotation),
            name: spec.name,
            shape: Arc::clone(shape),
            size,
            material: spec.material,
            damping: spec.damping,
            mass,
            inertia,
            inverse,
            tensor,
        };
        let mut velocity: Vec<f64> = (0..S::D).map(|k| spec.velocity[k]).collect();
        velocity.extend((0..S::Spin::N).map(|k| spec.spin[k]));
        let amplitudes = |of: &[S::Vector]| {
            let own = model.shape.amplitudes(of).into_iter();
            own.map(|a| a / model.scale).collect::<Vec<f64>>()
        };
        let [amplitudes, rates] = spec.displacement.each_ref().map(|of| match of.is_empty() {
            true => vec![0.0; model.rates.len()],
            false => amplitudes(of),
        });
        velocity.extend(rates);
        let state = GrainState {
            position: spec.position,
            rotation: spec.rotation,
            momentum: S::turned_tensor(&spec.rotation, &model.inertia).apply(&spec.spin),
            amplitudes,
            velocity,
        };
        let mut grain = Self {
            model: Arc::new(model),
            formed: None,
            start: state.clone(),
            middle: GrainAtDetection {
                rotation: spec.rotation,
                spin: spec.spin,
                free: spec.spin,
            },
            state,
            vertices: Vec::new(),
        };
        grain.place_vertices();
        let at = grain.vertices.clone();
        closed_surface::<S>(at, grain.model.shape.facets())?;
        Ok(grain)
    }

    /// Computes the positions of the vertices in the frame.
    fn place_vertices(&mut self) {
        let model = &self.model;
        let moved = model.shape.of_vertices(&self.state.amplitudes);
        let at = model.shape.vertices().zip(moved);
        self.vertices = at.map(|(x, u)| x * model.size + u * model.scale).collect();
    }

    /// Returns the displacements of all points of the mesh in the frame (m).
    fn displacements(&self) -> Vec<S::Vector> {
        let moved = self.model.shape.displacements(&self.state.amplitudes);
        moved.into_iter().map(|u| u * self.model.scale).collect()
    }

    /// Returns velocity and angular velocity of the frame, from generalised velocities.
    fn of_frame(velocity: &[f64]) -> (S::Vector, S::Spin) {
        let spin = &velocity[S::D..S::D + S::Spin::N];
        (
            S::Vector::from_slice(&velocity[..S::D]),
            S::Spin::from_slice(spin),
        )
    }

    /// Returns the rates of the amplitudes, from generalised velocities.
    fn of_modes(velocity: &[f64]) -> &[f64] {
        &velocity[S::D + S::Spin::N..]
    }

    /// Returns the damping of a mode, alpha + beta lambda (1/s).
    fn damping(&self, rate: f64) -> f64 {
        self.model.damping.mass + self.model.damping.stiffness * rate
    }

    /// A tensor of the frame in world axes.
    fn turned(&self, tensor: &S::Tensor) -> S::Tensor {
        S::turned_tensor(&self.state.rotation, tensor)
    }

    /// The vertices and weights of a place on the surface, in the frame (m).
    fn nodes_at(&self, at: &S::Vector) -> Nodes {
        let facets = self.model.shape.facets().iter();
        let (vertices, weights) = facets
            .map(|facet| {
                let corners = facet.map(|v| self.vertices[v as usize]);
                let (far, weights) = crate::surface::on_facet::<S>(at, &corners);
                (far, (facet, weights))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or((&[0; 3], [1.0, 0.0, 0.0]), |(_, found)| found);
        let terms = vertices.iter().zip(weights).take(S::D);
        let terms: Vec<(u32, f64)> = terms.map(|(v, w)| (*v, w)).collect();
        Nodes::on_facet(&terms).unwrap_or_else(|| Nodes::one(vertices[0]))
    }
}
