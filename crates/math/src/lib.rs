//! Mathematics of Fretwork: numbers in, numbers out.
//!
//! - [`diffusion`]: heat and current between nodes;
//! - [`design`]: points at which an experiment runs its model, [`sensitivity`]: which factors its
//!   outputs depend on;
//! - [`fit`]: the search for parameters, and how well data determine them;
//! - [`statistics`]: means with intervals, comparisons.
//!
//! The crate starts no run and reads no file, and does not know what a simulation is. A caller of
//! the last three modules gets points, makes the runs, and returns the outputs as tables of
//! `Option<f64>`, where `None` is a run that failed. All random choices follow from a seed by the
//! generator PCG, and inputs of runs are computed with additions, products, square roots and the
//! functions of the crate `libm`, so that all machines make the same runs.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod design;
pub mod diffusion;
pub mod fit;
pub mod sensitivity;
pub mod statistics;
