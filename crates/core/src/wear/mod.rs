//! Wear: volumes lost by first bodies, the resulting scars, and the mass balance.
pub mod jump;
pub mod ledger;
pub mod scar;
pub mod shape;
pub mod ties;

pub use scar::{Scar, WornThrough};
pub use shape::ScarForm;
