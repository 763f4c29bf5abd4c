//! Interface laws: plugins found by name, combined by the case, and called in batches.
mod batch;
pub mod bench;
mod bonds;
pub mod built_in;
mod call;
pub mod child;
pub mod columns;
pub mod commit;
pub mod demand;
pub mod error;
pub mod evaluator;
mod formation;
mod gather;
mod guarded;
mod history;
pub mod interface;
pub mod kind;
pub mod library;
mod outputs;
mod plugin_table;
mod prepare;
mod range;
mod rate;
mod reach;
#[cfg(test)]
pub(crate) mod sample_laws;
pub mod search;
mod spring;
pub mod static_memory;
mod step_result;
mod trust;
pub mod watch;

pub use built_in::BuiltInLaws;
pub use error::LawError;
pub use history::LawHistory;
pub use interface::{AreaRule, BondOpening, BondRule, Interface, Loaded};
pub use kind::{Kind, KindSpec};
pub use library::{Call, Plugin};
pub use plugin_table::Field;

pub use range::Range;
pub use rate::{FrictionAt, Step};
pub use search::{Place, SearchPath};
pub use spring::{SpringForm, SpringStep};
pub use step_result::{ContactStep, MomentStep, SolvedStep, Totals, Velocities};
