//! Studies of accuracy against cost: settings of a case are varied, and each is compared with a reference at
//! the finest setting, over several seeds.
//!
//! [`parameters`] defines the varied parameters, [`rung`] and [`form`] those that change the model, [`study`] plans within a budget of [`runs`](crate::runs), [`output`] says which numbers are compared and how well, [`compare`] compares them
//! with the reference, with Student [`interval`]s, [`frontier`] finds the non-dominated settings, [`verdict`]
//! the cheapest one for a wanted error, and [`table`], [`files`] and [`figure`] report the result.

pub mod chaos;
mod combinations;
pub mod compare;
pub mod figure;
pub mod files;
pub mod forecast;
pub mod form;
pub mod frontier;
pub mod output;
pub mod parameters;
pub mod rung;
pub mod setting;
pub mod study;
pub mod table;
pub mod verdict;

pub use fretwork_study::interval;

use crate::runs::RunsError;
use crate::runs::lock::Owner;
use fretwork_scene::InputError;
use fretwork_view::DrawError;
use std::path::Path;

/// The owner of folders of studies.
pub const OWNER: Owner = Owner {
    command: "fretwork trade",
    mark: "trade.lock",
    files: &["plan.json", "trade.json"],
};

/// Reason why a study cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// The case, or a value that a parameter gives it, is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The arguments are wrong.
    #[error("{0}")]
    Usage(String),
    /// Every run of the reference failed.
    #[error("{0}")]
    Reference(String),
    /// A run cannot be made or kept.
    #[error(transparent)]
    Runs(#[from] RunsError),
    /// The figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] DrawError),
}

impl TradeError {
    /// Error for a file that cannot be written.
    pub(super) fn write(path: &Path, reason: &dyn std::fmt::Display) -> Self {
        Self::Runs(RunsError::write(path, reason))
    }
}
