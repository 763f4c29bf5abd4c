//! Samples of grains: specifications in cases, tables of grains, and calls of the generators in
//! `fretwork-sample`.

pub mod spec;
pub mod table;

pub use fretwork_sample::{cutting, deposit, lattice, sizes, voronoi, voronoi_space};
