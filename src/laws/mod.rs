//! Interface laws: libraries found by name, composed by the case, called in batches.
pub mod bench;
mod bonds;
pub mod columns;
mod commit;
pub mod demand;
mod gather;
pub mod interface;
pub mod library;
pub mod pass;
pub mod search;

pub use interface::{AreaRule, BondRule, Interface, Loaded};
pub use library::{Call, Kind, LawError, Plugin};
pub use pass::{Site, Totals, Turn, Velocities};
pub use search::SearchPath;
