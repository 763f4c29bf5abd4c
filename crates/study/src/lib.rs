//! Mathematics of studies of many runs, and of fits of parameters to measurements.
//!
//! Numbers in, numbers out: the crate starts no run and reads no file, and does not know what a simulation is. A caller takes
//! points of a [`design`], runs them, and hands the outputs back as tables of `Option<f64>`, where `None` is a run that failed.
//!
//! All random choices follow from a seed by the generator PCG, and what becomes the input of a run is computed with additions,
//! products, square roots and the functions of the crate `libm`, so that all machines make the same runs.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod bootstrap;
pub mod design;
mod distribution;
pub mod fit;
pub mod interval;
mod jacobi;
mod least_squares;
mod random;
pub mod response;
pub mod sensitivity;
pub mod tournament;
