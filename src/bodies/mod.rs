//! Rigid bodies: their state, inertia, and the degrees of freedom that are driven.
pub mod drive;
pub mod state;

pub use drive::{Dof, Driven, TimeFunction};
pub use state::Bodies;
