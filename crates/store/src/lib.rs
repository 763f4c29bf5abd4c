//! Files of a run of Fretwork: `results.h5`, checkpoints, FCLIB problems, and the summary.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod checkpoint;
pub mod fclib;
pub mod folder_lock;
pub mod meshes;
pub mod results;
pub mod shapes;
pub mod views;
mod write_advice;

pub use fretwork_observe::{series, summary};
pub use results::maps;
pub use summary::Summary;
pub use write_advice::write_advice;
