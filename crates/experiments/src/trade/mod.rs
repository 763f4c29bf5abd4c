//! Accuracy against cost: settings of a case are varied, and each is compared with a reference at
//! the finest setting, over several seeds.
//!
//! A [`request`] is checked ([`refuse`]) and becomes a trade: [`presets`], [`listed`] and
//! [`variant`] make the [`varied`] [`parameters`], [`ordered`] the levels of a step or a tolerance,
//! [`deformability`] those that change which bodies deform. [`plan`] determines which settings run,
//! by their [`cost_law`], [`execute`] runs them, [`combinations`] adds promising combinations of
//! levels, [`chaos`] tests whether runs scatter where the seed changes nothing. [`output`]
//! describes the numbers that are compared and their wanted errors, [`compare`] compares them with
//! the reference, [`frontier`] finds the non-dominated settings, [`verdict`] the cheapest one for a
//! wanted error, and [`table`], [`files`] and [`figure`] report the result.

mod chaos;
mod combination;
mod combinations;
mod compare;
mod cost_law;
mod deformability;
mod execute;
mod figure;
mod files;
pub(crate) mod frontier;
mod listed;
mod ordered;
mod output;
mod parameters;
mod plan;
mod presets;
mod refuse;
mod request;
pub mod table;
mod variant;
mod varied;
mod verdict;

pub use execute::Event;
pub use files::write;
pub use plan::{Findings, Trade};
pub use request::Request;

use crate::folder::Owner;

/// The owner of folders of trades.
pub const OWNER: Owner = Owner {
    command: "fretwork trade",
    lock_file: "trade.lock",
    files: &["plan.json", "trade.json"],
};
