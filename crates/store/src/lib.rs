//! Files of a run of Fretwork: `results.h5`, checkpoints, FCLIB problems, and the summary.

#![warn(missing_docs)]
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod checkpoint;
pub mod fclib;
pub mod results;
pub mod series;
pub mod shapes;
pub mod summary;
pub mod views;
pub mod warnings;

pub use summary::Summary;
