//! Wear: what first bodies lose, the scars it leaves, and where the mass goes.
pub mod jump;
pub mod ledger;
pub mod scar;
pub mod shape;
pub mod ties;

pub use scar::{Scar, WornThrough};
pub use shape::Form;
