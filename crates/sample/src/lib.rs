//! Generation of grain samples: lattices, random deposits, size distributions, Voronoi cells, rough
//! surfaces.
//!
//! Numerical work only, from numbers to numbers: the layer above, `fretwork-scene`, reads what a
//! case asks for, and is compiled without optimisation.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod cutting;
pub mod deposit;
pub mod lattice;
pub mod profile;
pub mod sizes;
pub mod voronoi;
pub mod voronoi_space;
