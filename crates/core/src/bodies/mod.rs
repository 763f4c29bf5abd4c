//! Rigid bodies: their state, inertia, and the degrees of freedom that are driven.
pub mod delay;
pub mod drive;
pub mod integral;
pub mod path;
pub mod pressure;
pub mod stages;
pub mod state;
pub mod tensor;

pub use drive::{Dof, Driven, TimeFunction};
pub use stages::Stage;
pub use state::Bodies;
