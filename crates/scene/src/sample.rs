//! Samples of grains: what a case says of them, tables of grains, and the generators of the layer
//! below, `fretwork-sample`.

pub mod spec;
pub mod table;

pub use fretwork_sample::{cutting, deposit, lattice, sizes, voronoi, voronoi_space};
