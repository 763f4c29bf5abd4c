//! Positions of the shapes and contacts of a simulation.

pub use crate::contact::BondState;
use crate::contact::{Contact, Key};
use crate::geometry::convex::{ConvexCollider, Core};
use crate::geometry::space::Space;
use crate::step::Simulation;

/// Returns the centre of a convex part (m).
pub fn piece_centre<S: Space>(s: &Simulation<S>, piece: &ConvexCollider<S>) -> S::Vector {
    crate::contact::detect::piece_centre(piece, &s.state.bodies)
}

/// Returns the corners of a convex part (m): its outline in 2D, its faces in 3D.
pub fn piece_outline<S: Space>(
    s: &Simulation<S>,
    piece: &ConvexCollider<S>,
) -> Vec<Vec<S::Vector>> {
    let rotation = &s.state.bodies.rotation[piece.body as usize];
    let faces = piece.core.turned(rotation).outline(piece.rounding);
    let centre = s.shapes.periodic.wrapped(piece_centre(s, piece));
    let moved = |face: Vec<S::Vector>| face.iter().map(|c| *c + centre).collect();
    faces.into_iter().map(moved).collect()
}

/// Whether a body is a first body.
pub fn is_first<S: Space>(s: &Simulation<S>, body: u32) -> bool {
    s.state.bodies.driven.iter().any(|d| d.body == body)
}

/// The state of the bond of a contact.
pub fn bond_state<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> BondState {
    s.state.network.bond_state(contact)
}

/// Returns the end points of a contact: the candidate's centre, and the antagonist's centre or the
/// closest point on its surface.
pub fn ends<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> (S::Vector, S::Vector) {
    let key = &contact.key;
    let (Some(candidate), 0) = (key.ball(), key.antagonist & Key::PIECE) else {
        return ends_of_piece(s, contact);
    };
    let ball = &s.shapes.balls[candidate];
    let a = crate::contact::detect::centre(ball, &s.state.bodies);
    let length = match key.surface() {
        Some(_) => ball.radius + contact.gap,
        None => {
            let other = &s.shapes.balls[key.antagonist as usize];
            ball.radius + other.radius + contact.gap
        }
    };
    (a, a - contact.normal * length)
}

/// Returns the end points of a contact with a convex part; the contact point is the end at a first
/// body.
fn ends_of_piece<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> (S::Vector, S::Vector) {
    let centre = s.state.bodies.position[contact.bodies[0] as usize];
    let at = centre + contact.arms[0];
    let closest_point = at - contact.normal * contact.gap;
    let [first, other] = contact.bodies.map(|b| is_first(s, b));
    let a = if first { at } else { centre };
    let b = if other || contact.key.surface().is_some() {
        closest_point
    } else {
        closest_point - contact.arms[1]
    };
    (a, b)
}
