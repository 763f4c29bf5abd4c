//! Observers of a run of Fretwork, which produce rows, tables and charts: the friction test and its
//! cycles, fretting, biaxial tests, third bodies, wear scars, and the measured quantities of a
//! case.
//!
//! They read the simulation of `fretwork-core` and the case of `fretwork-scene`. Charts are data
//! here ([`chart`], [`output`]); higher layers write and draw them.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod accuracy;
pub mod biaxial;
mod case_checks;
pub mod chart;
pub mod choice;
pub mod circuit;
pub mod coordination;
pub mod cycle;
pub mod deformable;
pub mod error_estimate;
mod figures;
pub mod first_bodies;
pub mod fracture;
pub mod fretting;
pub mod friction;
pub mod friction_report;
pub mod friction_test;
mod grain_bonds;
pub mod heat;
pub mod jump;
mod law_tables;
pub mod layer;
pub mod loops;
pub mod measure;
pub mod mesh_fields;
pub mod nearest_places;
pub mod observer;
mod onset;
pub mod output;
pub mod picture;
pub use fretwork_core::view::placement;
pub mod quantity;
pub mod resolution;
pub mod run_state;
pub mod scars;
pub mod scatter;
pub mod series;
mod sets;
pub mod solving;
pub mod standard;
pub mod statistics;
pub mod steady;
pub mod strain;
pub mod stress;
pub mod summary;
pub mod tractions;
pub mod warning;
pub mod wear;

pub use fretwork_core::encoding;
pub use observer::{Observer, Observers, RunEnd};
