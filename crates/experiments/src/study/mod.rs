//! Studies: one case run at many points of its factors, here or by another engine, with the results
//! in one table.
//!
//! [`spec`] reads the file, [`of_case`] makes one of a case, [`design`] determines the points,
//! [`plan`] numbers the runs, [`forecast`] estimates their duration, [`execute`] makes them on this
//! machine and [`export`] writes scripts for other engines, [`rows`] collects them in a table,
//! [`analysis`] evaluates it for the [`settings`], the [`page`] and the [`figures`], [`law_table`]
//! makes the tables that laws read of it; [`files`] writes them, [`answers`] formats them for a
//! terminal.

mod analysis;
pub mod answers;
mod design;
pub mod execute;
pub mod export;
mod figures;
mod files;
pub mod forecast;
mod law_table;
mod of_case;
mod page;
pub mod plan;
pub mod rows;
mod settings;
pub mod spec;

pub use files::{Written, write};
pub use of_case::of_case;

use crate::folder::Owner;

/// The owner of folders of studies.
pub const OWNER: Owner = Owner {
    command: "fretwork study",
    lock_file: "study.lock",
    files: &["study.json"],
};
