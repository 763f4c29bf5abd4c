//! The files of a run of Fretwork: `results.h5`, checkpoints, problems of the FCLIB collection, and the summary.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod checkpoint;
pub mod fclib;
pub mod results;
pub mod shapes;
pub mod views;
pub mod warnings;

pub use fretwork_observe::{series, summary};
pub use summary::Summary;
