//! Rigid bodies: state, inertia, and driven degrees of freedom.
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
