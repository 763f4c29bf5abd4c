//! Interface laws: libraries found by name, composed by the case, called in batches.
pub mod bench;
mod bonds;
mod call;
pub mod columns;
mod commit;
pub mod demand;
mod gather;
pub mod interface;
pub mod library;
pub mod pass;
pub mod search;
mod trust;
pub mod watch;

pub use interface::{AreaRule, BondRule, Interface, Loaded};
pub use library::{Call, Kind, LawError, Plugin};
pub use pass::{Site, Totals, Turn, Velocities};
pub use search::SearchPath;
