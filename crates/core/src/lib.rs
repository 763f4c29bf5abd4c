//! The computing core of Fretwork: rigid bodies in dry contact, stepped by non-smooth contact dynamics, with interface laws
//! from plugins.
//!
//! Modules in the order in which they build on each other: [`geometry`] (dimension, algebra, shapes, distances), [`bodies`],
//! [`contact`] (detection and what each contact remembers), [`solve`] (the contact problem and its solvers), [`laws`] (the
//! plugin host), [`certify`] (what a law promises, tested), [`wear`], [`energy`] (the ledger of a step), [`step`] (the time
//! step), and [`process`] (what acts on a simulation between its steps).
//!
//! It reads no case text and writes no result files: those are layers above it, which it does not know.

#![warn(missing_docs)]
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod bodies;
pub mod certify;
pub mod contact;
pub mod energy;
pub mod geometry;
pub mod laws;
pub mod process;
pub mod solve;
pub mod step;
pub mod wear;
