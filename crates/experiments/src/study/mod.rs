//! Studies: one case run at many points of its factors, here or by another engine, and gathered in
//! one table.
//!
//! [`spec`] is the file, [`design`] says at which points, [`plan`] has the numbered runs,
//! [`forecast`] what they will take, [`execute`] makes them on this machine and [`export`] writes
//! what other engines take, [`rows`] gathers them in a table, [`analysis`] says what it shows, for
//! the [`settings`], the [`page`] and the [`figures`]; [`files`] writes them, [`answers`] says it
//! on a terminal.

mod analysis;
pub mod answers;
mod design;
pub mod execute;
pub mod export;
mod figures;
mod files;
pub mod forecast;
mod page;
pub mod plan;
pub mod rows;
mod settings;
pub mod spec;

pub use files::write;

use crate::folder::Owner;

/// The owner of folders of studies.
pub const OWNER: Owner = Owner {
    command: "fretwork study",
    mark: "study.lock",
    files: &["study.json"],
};
