//! Studies: one case run at many points of its factors, here or by another engine, and gathered in one table.
//!
//! [`spec`] is the file, [`factor`] what varies and [`design`] at which points, [`plan`] the numbered runs, [`forecast`] what they
//! will take, [`execute`] makes them on this machine and [`export`] writes what other engines take, [`table`] gathers them, [`csv`] and [`parquet`]
//! write the table, [`analysis`] says what it shows, for the [`page`] and the [`figures`].

pub mod analysis;
pub mod csv;
pub mod design;
pub mod execute;
pub mod export;
pub mod factor;
pub mod figures;
pub mod forecast;
pub mod page;
pub mod parquet;
pub mod plan;
pub mod spec;
pub mod table;

use crate::runs::RunsError;
use crate::runs::lock::Owner;
use fretwork_scene::InputError;

/// The owner of folders of studies.
pub const OWNER: Owner = Owner {
    command: "fretwork study",
    mark: "study.lock",
    files: &["study.json"],
};

/// Reason why a study cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study or its case is wrong, at a place of a file.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A run cannot be made or kept, or a file cannot be written.
    #[error(transparent)]
    Runs(#[from] RunsError),
    /// What was asked for does not fit the study.
    #[error("{0}")]
    Usage(String),
}
