//! Experiments: runs of a case in separate processes, and the questions that they answer.
//!
//! ```text
//!  file of a study or a fit, options of a trade
//!        ▼
//!  factors: what varies, with its levels or its range      factor
//!        ▼
//!  settings: a level of each factor                        study::design, trade::plan, fit::search
//!        ▼
//!  runs: changes of the case, and a seed                   changes, runs
//!        ▼
//!  a process and a folder for each, kept by its key        runs::{launcher, key, stored}
//!        ▼
//!  tables: a row a run or a setting                        table
//!        ▼
//!  answers: effects, errors, estimates                     study::analysis, trade::compare, fit::outcome
//! ```
//!
//! [`study`] varies the values of a case, [`fit`] finds those for which it reproduces measured
//! curves, [`trade`] compares accuracy with cost, [`contact_patch`] relates a patch in closed form
//! to the runs of a window of it, [`patch`] solves a patch with the laws of an interface. The
//! mathematics is that of [`fretwork_math`].

#![deny(clippy::print_stdout, clippy::print_stderr)]

mod amounts;
mod case;
mod changes;
pub mod contact_patch;
pub mod duration;
mod error;
pub mod factor;
pub mod fit;
pub mod folder;
mod limits;
pub mod new_case;
mod page;
pub mod patch;
pub mod runs;
pub mod shell;
pub mod spec;
pub mod study;
pub mod table;
pub mod trade;

pub use case::{build, load};
pub use error::Error;

use fretwork_core::view::RunView;
use fretwork_observe::Observers;
use fretwork_scene::{InputError, LoadedCase};

/// Laws, plugins and observers of the runs of an experiment.
#[derive(Clone, Debug)]
pub struct RunSetup {
    /// Search path of laws.
    pub search: fretwork_core::laws::SearchPath,
    /// Arguments of each run for the same plugins.
    pub plugins: Vec<String>,
    /// Observers of the runs of a case: what they report is what experiments compare.
    pub observers: fn(&LoadedCase, &dyn RunView) -> Observers,
    /// Refuses a case whose run has two columns, files or tables of events of the same name, by its
    /// observers.
    pub check_names: fn(&LoadedCase, &Observers) -> Result<(), InputError>,
}
