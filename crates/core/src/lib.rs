//! The computing core of Fretwork: rigid bodies in dry contact, integrated in time by non-smooth contact
//! dynamics, with interface laws from plugins.
//!
//! Modules, in the order of their dependencies: [`geometry`] (dimension, algebra, shapes, distances),
//! [`bodies`], [`contact`] (detection and contact history), [`solve`] (the contact problem and its solvers),
//! [`laws`] (the plugin host), [`certify`] (tests of what a law declares), [`wear`], [`energy`] (the ledger
//! of a step), [`step`] (the time step), and [`process`] (actions on a simulation between steps).
//!
//! The core neither parses cases nor writes result files; the layers above it do.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod bodies;
pub mod certify;
pub mod code;
pub mod contact;
pub mod energy;
pub mod fields;
pub mod geometry;
pub mod laws;
pub mod process;
pub mod solve;
pub mod step;
pub mod wear;
