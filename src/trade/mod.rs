//! What accuracy costs: settings of a case are varied, and each is compared with a reference at the finest, over seeds.
//!
//! [`knobs`] says what is varied, [`study`] plans within a budget, [`child`] has each setting run by a process of its own and
//! keeps what it leaves, [`output`] reads the wanted numbers, [`compare`] sets them against the reference with Student
//! [`interval`]s, [`frontier`] finds what nothing dominates, [`verdict`] the cheapest for a wanted error, and [`table`],
//! [`files`] and [`figure`] tell it.

pub mod chaos;
pub mod child;
mod combinations;
pub mod compare;
pub mod figure;
pub mod files;
pub mod forecast;
pub mod frontier;
pub mod interval;
pub mod knobs;
pub mod lock;
pub mod offer;
pub mod output;
pub mod setting;
pub mod study;
pub mod table;
pub mod verdict;

use crate::report::ReportError;
use crate::scene::InputError;
use std::path::{Path, PathBuf};

/// Why a study cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// The case, or a value that a knob gives it.
    #[error(transparent)]
    Input(#[from] InputError),
    /// What was asked for.
    #[error("{0}")]
    Usage(String),
    /// Every run of the reference failed.
    #[error("{0}")]
    Reference(String),
    /// A file or folder.
    #[error("cannot write {}: {reason}; choose another folder with --out or make room", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The figure.
    #[error(transparent)]
    Figure(#[from] ReportError),
}

impl TradeError {
    /// A file that could not be written.
    pub(super) fn write(path: &Path, reason: &dyn std::fmt::Display) -> Self {
        Self::Write {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}
