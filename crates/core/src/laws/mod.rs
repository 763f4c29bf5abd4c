//! Interface laws: plugins found by name, combined by the case, and called in batches.
pub mod bench;
mod bonds;
pub mod built_in;
mod call;
pub mod child;
pub mod columns;
pub mod commit;
pub mod demand;
mod gather;
mod guarded;
pub mod interface;
pub mod kind;
pub mod library;
pub mod pass;
mod range;
pub mod search;
pub mod static_memory;
mod trust;
pub mod watch;

pub use built_in::BuiltInLaws;
pub use interface::{AreaRule, BondRule, Interface, Loaded};
pub use kind::{Kind, KindSpec};
pub use library::{Call, LawError, Plugin};
pub use pass::{ContactStep, MomentStep, Totals, Velocities};
pub use range::Range;
pub use search::{Place, SearchPath};
