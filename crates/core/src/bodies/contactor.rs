//! Contactors: the parts of a dynamical system that can touch, and the nodes on which their
//! contacts act.

use super::nodes::Nodes;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// A part of a system that can touch. It is represented by a body in [`super::Bodies`] that follows
/// the system and has no inertia of its own. Detection, laws, bonds and files treat it like any
/// other body.
#[derive(Clone, Debug, PartialEq)]
pub struct Contactor {
    /// The nodes that carry its origin.
    pub nodes: Nodes,
    /// Radius of a ball about the origin (m). For a point, half of its tributary length, in space
    /// the radius of a disk of its tributary area, from which the area of contacts is computed; for
    /// other shapes a characteristic length.
    pub radius: f64,
    /// Shape.
    pub shape: ContactorShape,
    /// Index of the material of a ball, a point or a surface.
    pub material: u16,
}

/// The shape of a contactor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactorShape {
    /// A ball about the origin.
    Ball,
    /// The origin itself: a point of a surface, which touches balls, pieces and surfaces but no
    /// other point.
    Point,
    /// A surface that deforms with the system, see [`super::DynamicalSystem::surface`].
    Surface,
    /// A grain: a closed surface that deforms, and the vertices of it as points, see
    /// [`super::DynamicalSystem::point_areas`].
    Grain,
    /// Shapes that the caller gives to the body.
    Given,
}

/// Position and motion of a contactor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactorMotion<S: Space> {
    /// Origin of its frame (m).
    pub position: S::Vector,
    /// Orientation.
    pub rotation: S::Rotation,
    /// Velocity of the origin (m/s).
    pub velocity: S::Vector,
    /// Angular velocity of the frame (rad/s).
    pub spin: S::Spin,
}

/// The contactor that a body represents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Carrier {
    /// Index of the system.
    pub system: u32,
    /// Index of the contactor in it.
    pub contactor: u32,
    /// Whether contactors of the system can touch each other.
    pub touches_itself: bool,
    /// Whether it is a grain that deforms: it touches by its surface and by its points, so that a
    /// contact of two of them is found from both sides.
    pub grain: bool,
}
