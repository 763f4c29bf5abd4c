//! What of a dynamical system touches, and the nodes that a contact there acts on.

use crate::geometry::space::Space;
use std::cmp::Ordering;

/// A part of a system that can touch: it stands as a body of its own among [`super::Bodies`], which follows the system and has
/// no inertia of its own. Detection, laws, bonds and files treat it as any other body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contactor {
    /// The nodes that carry its origin.
    pub nodes: Nodes,
    /// Radius of a ball about the origin (m); of other shapes a length of their size, which laws take for a radius.
    pub radius: f64,
    /// What touches.
    pub shape: ContactorShape,
    /// Index of the material of a ball, a point or a surface.
    pub material: u16,
}

/// The shape of a contactor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactorShape {
    /// A ball about the origin.
    Ball,
    /// The origin itself: a point of a surface, which touches balls, pieces and surfaces but no other point.
    Point,
    /// A surface that deforms with the system, see [`super::DynamicalSystem::surface`].
    Surface,
    /// A grain: a closed surface that deforms, and the vertices of it as points, see [`super::DynamicalSystem::point_areas`].
    Grain,
    /// Shapes that the caller gives to the body.
    Given,
}

/// Where a contactor stands and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactorMotion<S: Space> {
    /// Origin of its frame (m).
    pub position: S::Vector,
    /// Its orientation.
    pub rotation: S::Rotation,
    /// Velocity of the origin (m/s).
    pub velocity: S::Vector,
    /// Angular velocity of the frame (rad/s).
    pub spin: S::Spin,
}

/// A point of a system as a weighted sum of nodes: u = sum w_a u_a, and an impulse p there is w_a p on each of them. The
/// weights are shape functions, or the affine coordinates of a point in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nodes {
    ids: [u32; Self::MAX],
    weights: [f64; Self::MAX],
    count: u8,
}

impl Nodes {
    /// Nodes of a point at most: those of a facet with quadratic shape functions.
    pub const MAX: usize = 8;

    /// A node itself.
    pub fn one(node: u32) -> Self {
        let mut nodes = Self {
            ids: [0; Self::MAX],
            weights: [0.0; Self::MAX],
            count: 1,
        };
        (nodes.ids[0], nodes.weights[0]) = (node, 1.0);
        nodes
    }

    /// A weighted sum of different nodes; none of more than [`Nodes::MAX`], or of no node.
    pub fn sum(terms: &[(u32, f64)]) -> Option<Self> {
        if terms.is_empty() || terms.len() > Self::MAX {
            return None;
        }
        let mut nodes = Self::one(0);
        for (k, (node, weight)) in terms.iter().enumerate() {
            (nodes.ids[k], nodes.weights[k]) = (*node, *weight);
        }
        nodes.count = terms.len() as u8;
        Some(nodes)
    }

    /// An order of points, by nodes and weights; equal where both are.
    pub fn order(&self, other: &Self) -> Ordering {
        let key = |p: &Self| (p.count, p.ids);
        let weights = self.weights.iter().zip(&other.weights);
        key(self).cmp(&key(other)).then_with(|| {
            weights.fold(Ordering::Equal, |order, (a, b)| {
                order.then_with(|| a.total_cmp(b))
            })
        })
    }

    /// The nodes and their weights.
    pub fn terms(&self) -> impl Iterator<Item = (u32, f64)> {
        let terms = self.ids.iter().copied().zip(self.weights.iter().copied());
        terms.take(usize::from(self.count))
    }
}
