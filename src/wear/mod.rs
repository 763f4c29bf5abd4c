//! Wear and the tribological circuit: what first bodies lose, the scars it leaves, and where it goes.
pub mod circuit;
pub mod jump;
pub mod ledger;
pub mod scar;
pub mod shape;
pub mod ties;

pub use scar::{Scar, WornThrough};
pub use shape::Form;
