//! Fretwork: tribology of dry contacts by non-smooth contact dynamics, with interface laws loaded at run
//! time.
//!
//! This crate is the program, and re-exports all layers below it. A [`scene`] creates [`bodies`] with
//! [`geometry`]; each [`step`] detects [`contact`]s, evaluates the interface [`laws`], [`solve`]s the contact
//! problem and advances the bodies; [`process`]es act between steps, and [`record`] writes the run's results.
//! To use a single layer, depend on its crate: `fretwork-core`, `fretwork-scene`, `fretwork-observe`,
//! `fretwork-store` or `fretwork-plot`.

// A failed write to a terminal or pipe must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod cli;
pub mod interrupt;
pub mod record;
pub mod scene;
pub mod shipped;
pub mod trade;

pub use fretwork_core::{
    bodies, certify, contact, energy, fields, geometry, laws, process, solve, step, wear,
};
pub use fretwork_plot as report;

/// The page of the documentation on the library: its code is run as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
pub struct LibraryPage;
