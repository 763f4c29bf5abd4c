//! Fretwork: tribology of dry contacts by non-smooth contact dynamics, with interface laws loaded
//! at run time.
//!
//! # One step
//!
//! ```text
//!  case.ron ─► scene ─► bodies with shapes ─┐
//!                                           ▼
//!       ┌───────────────────────────► detect ─► contacts (memory: bonds, damage, variables of laws)
//!       │                                   ▼
//!       │                             laws: prepare (batches, plugin ABI)
//!       │                                   ▼
//!       │                             solve: standard local form ─► impulses, velocities
//!       │                                   ▼
//!       │                             laws: commit (damage, breaks, wear, dissipation)
//!       │                                   ▼
//!       │                             energy ledger
//!       │                                   ▼
//!       │                             advance the bodies to the end of the step
//!       │                                   ▼
//!       │                             processes after the move: wear lowers surfaces
//!       │                                   ▼
//!       │                             observers look at the step
//!       │                                   ▼
//!       │                             processes between steps: cycle jumps, circuit
//!       │                                   ▼
//!       └──────────────────────────── results, pictures
//! ```
//!
//! | word in the picture | module |
//! |---|---|
//! | case, scene | [`scene`]: [`load`](scene::load) a file, or make a case by a [`CaseBuilder`](scene::CaseBuilder) |
//! | bodies, shapes | [`bodies`]: columns of all [`Bodies`](bodies::Bodies); [`geometry`]: dimension, algebra, shapes |
//! | detect, contacts, memory | [`contact`]: the [`Network`](contact::Network) of all contacts |
//! | laws | [`laws`]: an [`Interface`](laws::Interface) of [`Plugin`](laws::Plugin)s, found by a [`SearchPath`](laws::SearchPath); [`certify`] tests what they promise |
//! | solve | [`solve`]: a [`Problem`](solve::Problem), its methods and the error that they reach |
//! | energy ledger | [`energy`]: [`Energy`](energy::Energy) |
//! | bodies that deform | [`elastic`]: finite elements as dynamical systems of the step |
//! | processes, wear | [`process`], [`wear`] |
//! | the step itself | [`step`]: a [`Simulation`](step::Simulation) of one dimension; [`AnySimulation`] of either, stepped by [`RunControl`] and read by [`RunView`] |
//! | observers, results | [`record`]: the run loop, analysis, `results.h5`, checkpoints |
//! | pictures | [`view`]: charts and pictures, reports |
//!
//! Each module re-exports a layer below: `fretwork-core`, `fretwork-scene`, `fretwork-observe`,
//! `fretwork-store`, `fretwork-view`, `fretwork-experiments`. This crate adds the command line
//! ([`cli`]), the shipped laws ([`shipped`]), processes that make runs for studies and fits
//! ([`experiments`]), and contact patches in closed form ([`contact_patch`]).
//!
//! # Features
//!
//! By default this crate builds the program; with `default-features = false` it is a library that
//! makes scenes and steps them. Features add `laws` ([`shipped`]), `results` (the run loop and its
//! files), `view`, `experiments`, `parquet` (tables of studies) and `program` ([`cli`],
//! [`interrupt`]). `docs/library.md` describes them, and lists short programs of the folder
//! `examples` to begin with.
//!
//! # A scene without files
//!
//! This example drops a ball on a plane, where it comes to rest; the plane carries its weight.
//!
//! ```
//! use fretwork::scene::case::{BodySpec, GrainSpec, InterfaceSpec, OneGrain, ShapeSpec};
//! use fretwork::scene::CaseBuilder;
//! use std::ops::ControlFlow;
//!
//! let mut simulation = CaseBuilder::in_space("a ball on a plane")
//!     .time(1e-3, 0.2)
//!     .gravity([0.0, 0.0, -9.81])
//!     .own_material("glass", 2500.0, "data sheet")
//!     .interface(InterfaceSpec::new("dry", ("glass", "glass"), "coulomb", &[("mu", 0.3)]))
//!     .body(BodySpec::new("floor", "glass", ShapeSpec::half_space([0.0, 0.0, 1.0], [])))
//!     .grains(GrainSpec::balls("glass", [OneGrain::new([0.0, 0.0, 0.02], 0.01)]))
//!     .build(&fretwork::shipped::search_path())?
//!     .simulation;
//! simulation.run_until(0.2, |_, _| ControlFlow::<()>::Continue(()))?;
//!
//! let [force, _] = simulation.contact_force_on("floor").ok_or("no floor")?;
//! let weight = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.01f64.powi(3) * 9.81;
//! assert!((-force[2] - weight).abs() < 1e-3 * weight, "{force:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// A failed write to a terminal or pipe must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

#[cfg(feature = "program")]
mod cache_folder;
#[cfg(feature = "program")]
pub mod cli;
#[cfg(feature = "program")]
pub mod interrupt;
pub mod record;
pub mod scene;
#[cfg(feature = "laws")]
pub mod shipped;

pub use fretwork_core::in_dimension;
pub use fretwork_core::view::{
    AnySimulation, FieldInfo, FieldKind, FieldValues, GrainFields, RunControl, RunView,
};
pub use fretwork_core::{
    bodies, certify, contact, energy, fields, geometry, heat, huge_pages, laws, out_of_memory,
    process, program, solve, step, threads, wear,
};
pub use fretwork_elastic as elastic;
#[cfg(feature = "experiments")]
pub use fretwork_experiments::{self as experiments, contact_patch};
#[cfg(feature = "view")]
pub use fretwork_view as view;
