//! Fretwork: tribology of dry contacts by non-smooth contact dynamics, with interface laws loaded at
//! run time.
//!
//! This crate is the program, and names all layers below it: a [`scene`] makes [`bodies`] with [`geometry`]; each [`step`] detects
//! [`contact`]s, asks the [`laws`], [`solve`]s, commits; [`process`]es act between steps, and a run is [`record`]ed.
//! Who needs a layer alone names its crate: `fretwork-core`, `fretwork-scene`, `fretwork-observe`, `fretwork-store` or
//! `fretwork-plot`.

// A terminal or pipe that takes no more must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod cli;
pub mod interrupt;
pub mod record;
pub mod scene;
pub mod shipped;
pub mod trade;

pub use fretwork_core::{
    bodies, certify, contact, energy, geometry, laws, process, solve, step, wear,
};
pub use fretwork_plot as report;
