//! Fretwork: tribology of dry contacts by non-smooth contact dynamics, with interface laws loaded at
//! run time.
//!
//! The folders mirror the step: a [`scene`] makes [`bodies`] with [`geometry`]; each [`step`] detects
//! [`contact`]s, asks the [`laws`], [`solve`]s, commits, and [`record`]s.

// A terminal or pipe that takes no more must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod bodies;
pub mod certify;
pub mod cli;
pub mod contact;
pub mod geometry;
pub mod interrupt;
pub mod laws;
pub mod record;
pub mod report;
pub mod scene;
pub mod solve;
pub mod step;
pub mod trade;
pub mod wear;
