//! Cases and materials: reads and checks them, and builds simulations from them.
//!
//! [`load`] reads a case file and [`LoadedCase::build`] builds from it a simulation of the layer
//! below, `fretwork-core`. This layer does not depend on results, pictures or the command line.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod biaxial;
pub mod bond_sites;
pub mod build;
pub mod builder;
mod called;
pub mod case;
pub mod check;
pub mod circuit;
mod deep;
pub mod expression;
pub mod gmsh;
mod heat;
mod height_grid;
mod holders;
pub mod input_ranges;
pub mod inputs;
pub mod interfaces;
pub mod jump;
pub mod law_inputs;
pub mod law_table;
mod law_values;
mod magnitudes;
pub mod material;
pub mod measured;
pub mod measures;
pub mod mesh_file;
pub mod methods;
pub mod most_steps;
mod names;
pub mod phases;
pub mod processes;
pub mod profile_file;
pub mod quantity;
pub mod random;
pub mod recorded;
pub mod sample;
pub mod sampling;
pub mod scene_file;
pub mod schema;
pub mod shipped_materials;
pub mod source;
pub mod standard;
pub mod units;
pub mod wear_coefficient;
pub mod wear_motion;

pub use build::{Built, LoadedCase, load, load_reader, load_text};
pub use builder::CaseBuilder;
pub use case::Case;
pub use fretwork_core::geometry::space::{Dim2, Dim3};
pub use fretwork_sample::profile;
pub use names::invisible_characters;
pub use source::InputError;
