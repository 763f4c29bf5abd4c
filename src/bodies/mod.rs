//! Rigid bodies: their state, inertia, and the degrees of freedom that are driven.
pub mod drive;
pub mod stages;
pub mod state;

pub use drive::{Dof, Driven, TimeFunction};
pub use stages::Stage;
pub use state::Bodies;
