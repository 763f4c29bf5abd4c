//! Contacts in rows, over which the solver iterates, and the exact solution of one contact.
//!
//! A row has a state (normal and impulse), a law and the motion of its two bodies; a [`RowKind`] is
//! a pair of law and motion. Each is written once, over lanes: the same source is compiled for one
//! contact and for several at a time. A contact of two balls has W_nt = 0, W_nn = 1/m_i + 1/m_j and
//! an isotropic W_tt, so that its law is solved in closed form, part by part; with lever arms it
//! has a full block of W.

mod block;
mod cone;
mod full;
mod kind;
mod law;
mod moment;
mod motion;
mod plain;
mod response;
mod rigid_bodies;
mod solver_bodies;
mod state;
mod system;
#[cfg(test)]
mod tests;
mod visit;

pub(super) use block::{Bonded, Unbonded};
pub(super) use cone::HELD;
pub(super) use full::Full;
pub(super) use kind::{Row, RowKind};
pub use moment::{MomentForm, MomentSolution};
pub(super) use moment::{MomentRow, turning};
pub(super) use plain::Plain;
pub(super) use rigid_bodies::RigidBodies;
pub(super) use solver_bodies::SolverBodies;
pub use solver_bodies::SolverBody;
pub(super) use state::{Moving, Parts, restore, store};
pub(super) use system::{SystemRow, Term};
pub(super) use visit::{Free, Load, MeasureErrors, Update, Visit, noise, visit};
