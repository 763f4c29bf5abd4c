//! Sides of a contact: the points on which an impulse acts.

use crate::bodies::Nodes;
use crate::geometry::space::Space;

/// One side of a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum Side<S: Space> {
    /// A point of a rigid body, at an arm from its centre in world axes (m).
    Rigid {
        /// Index of the body.
        body: u32,
        /// Vector from the centre of the body to the contact (m).
        arm: S::Vector,
    },
    /// A point of a dynamical system, a weighted sum of its nodes.
    Nodes {
        /// Index of the system among those of the problem.
        system: u32,
        /// The nodes and their weights.
        nodes: Nodes,
    },
}
