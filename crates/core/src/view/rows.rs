//! Rows of a view: plain data with three components.

use crate::bodies::{Carrier, Driven};
use crate::contact::{BondState, Key, SlideStatistics};
use crate::geometry::space::{VectorLike, Vectors};
use nalgebra::Vector3;

/// Columns of the bodies, grains first, then first bodies. In 2D masses are per metre of depth.
#[derive(Clone, Copy, Debug)]
pub struct BodyColumns<'a> {
    /// Stable identities.
    pub id: &'a [u64],
    /// Centres of mass (m).
    pub position: Vectors<'a>,
    /// Velocities of the centres of mass (m/s).
    pub velocity: Vectors<'a>,
    /// Angular velocities (rad/s).
    pub spin: Vectors<'a>,
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Inverse masses along each axis, zero where motion is imposed (1/kg).
    pub inverse_mass: Vectors<'a>,
    /// Moments of inertia (kg m^2); the mean where they differ by axis.
    pub inertia: &'a [f64],
    /// Inverse moments of inertia, zero where rotation is imposed (1/(kg m^2)).
    pub inverse_inertia: &'a [f64],
    /// Length that scales spins to velocities: the radius of a grain (m).
    pub length: &'a [f64],
    /// Whether each body has been removed.
    pub removed: &'a [bool],
    /// The driven first bodies.
    pub driven: &'a [Driven],
    /// Contactors of dynamical systems that bodies represent; empty without systems.
    pub carriers: &'a [Option<Carrier>],
}

impl<'a> BodyColumns<'a> {
    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Returns whether there are no bodies.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Returns the contactor that a body represents, if any.
    pub fn carrier(&self, body: usize) -> Option<Carrier> {
        self.carriers.get(body).copied().flatten()
    }

    /// The driven first body of a name.
    pub fn driven_named(&self, name: &str) -> Option<&'a Driven> {
        self.driven.iter().find(|d| d.name == name)
    }
}

/// Position and motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyMotion {
    /// Centre of mass (m).
    pub position: [f64; 3],
    /// Orientation: an angle (rad) and zeros in the plane, a unit quaternion (w, x, y, z) in space.
    pub rotation: [f64; 4],
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
}

impl BodyMotion {
    /// Returns the magnitude of the velocity (m/s).
    pub fn speed(&self) -> f64 {
        VectorLike::norm(&Vector3::from(self.velocity))
    }
}

/// A ball of a body, or a surface point of a deformable body, which has radius zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallView {
    /// Index of its body.
    pub body: u32,
    /// Index of its material.
    pub material: u16,
    /// Radius (m).
    pub radius: f64,
    /// Centre (m).
    pub centre: [f64; 3],
    /// Centre in the frame of the body (m).
    pub offset: [f64; 3],
    /// Tributary area of a point of a surface, along its outward normal (m^2; m in 2D); zero for
    /// balls.
    pub area: [f64; 3],
}

/// A convex piece of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceView {
    /// Index of its body.
    pub body: u32,
    /// Index of its material.
    pub material: u16,
    /// Radius of the ball (2D: disk) of the same volume (m).
    pub size: f64,
    /// Radius of the ball about the piece's centre that contains it (m).
    pub bound: f64,
    /// Rounding radius (m).
    pub rounding: f64,
    /// Centre (m).
    pub centre: [f64; 3],
    /// Centre in the frame of the body (m).
    pub offset: [f64; 3],
}

/// A surface of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceView {
    /// Index of its body.
    pub body: u32,
    /// Index of its material.
    pub material: u16,
    /// Origin in the frame of the body (m).
    pub offset: [f64; 3],
    /// Whether the surface encloses a deformable grain.
    pub closed: bool,
    /// Whether the surface is bounded, unlike a plane.
    pub bounded: bool,
    /// Outward normal of a plane, in its own frame.
    pub flat: Option<[f64; 3]>,
}

/// A line of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Index of the body.
    pub body: u32,
    /// Points (m).
    pub points: Vec<[f64; 3]>,
}

/// A surface that recedes by wear.
#[derive(Clone, Debug, PartialEq)]
pub struct ScarView<'a> {
    /// Name of its body.
    pub name: &'a str,
    /// Index of the surface.
    pub surface: usize,
    /// Depth at which it is worn through (m).
    pub thickness: f64,
    /// Number of its vertices.
    pub vertices: usize,
    /// Worn volume (m^3; m^2 in 2D).
    pub volume: f64,
    /// Greatest depth (m).
    pub deepest: f64,
    /// Position of the greatest depth, in the frame of the surface before any wear (m).
    pub deepest_at: [f64; 3],
}

/// A vertex of a scar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScarVertex {
    /// Position of the vertex, in the frame of the surface before any wear (m).
    pub at: [f64; 3],
    /// Tributary area of the vertex (m^2; length in 2D, m).
    pub tributary: f64,
    /// Worn depth (m).
    pub depth: f64,
}

/// A contact at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactView {
    /// Index of the contact among the contacts of the step.
    pub place: usize,
    /// Key in the scene.
    pub key: Key,
    /// The bodies: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface in the case.
    pub interface: u16,
    /// Contact point on the candidate's side (m).
    pub point: [f64; 3],
    /// Vectors from the centres of mass of the bodies to the contact points (m).
    pub arms: [[f64; 3]; 2],
    /// Unit normal, from the antagonist to the candidate.
    pub normal: [f64; 3],
    /// Distance at detection (m), positive when open.
    pub gap: f64,
    /// Reduced radius (m); zero where unknown.
    pub radius: f64,
    /// Impulse of the last step on the candidate (N s; N s/m in 2D); the antagonist has its
    /// opposite.
    pub impulse: [f64; 3],
    /// Mean force of the last step on the candidate (N; N/m in 2D).
    pub force: [f64; 3],
    /// Component of the force along the normal (N; N/m in 2D), positive in compression.
    pub normal_force: f64,
    /// Whether friction is at its bound.
    pub slides: bool,
    /// Whether its forces pass through the centres of both bodies.
    pub central: bool,
    /// Time at which the contact formed (s).
    pub formed_at: f64,
    /// The state of its bond.
    pub bond: BondState,
    /// Whether the contact is within the alert distance or bonded, or was predicted and has an
    /// impulse.
    pub counts: bool,
}

/// The bonds of an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BondCounts {
    /// Number of bonds formed so far.
    pub made: u64,
    /// Number of bonds broken so far.
    pub broken: u64,
    /// How far bonds opened or slid in a step.
    pub slides: SlideStatistics,
}
