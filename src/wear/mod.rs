//! What wear leaves on first bodies.
pub mod scar;
pub mod shape;

pub use scar::{Scar, WornThrough};
pub use shape::Form;
