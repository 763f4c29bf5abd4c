//! Wear: volumes lost by first bodies, the resulting scars, and the mass balance.
pub mod bond_forest;
pub mod jump;
pub mod ledger;
pub mod scar;
pub mod shape;

pub use scar::{Scar, WornThrough};
pub use shape::ScarForm;
