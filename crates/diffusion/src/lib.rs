//! Diffusion on graphs: heat or electric current between nodes that conductances join.
//!
//! Numbers in, numbers out: the crate knows neither contacts nor laws. A [`Graph`] holds the conductances of one instant; [`step`] advances
//! the temperatures of nodes with heat capacities implicitly in time, [`steady`] finds the potentials of nodes without any. A node may stand for the
//! surface of a [`HalfSpace`], whose depth is resolved by a graded grid and eliminated exactly from the system of the nodes.
//!
//! The equations are, with temperatures T (K), capacities C (J/K), conductances G (W/K) and sources Q (W),
//!
//! ```text
//! C_i dT_i/dt = sum_j G_ij (T_j - T_i) + Q_i
//! ```
//!
//! or with potentials V (V), conductances (S) and currents I (A) the same without the left side. In two dimensions all of C, G and Q
//! are per metre of depth.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod error;
pub mod flash;
pub mod graph;
pub mod half_space;
pub mod node;
mod solve;
pub mod steady;
pub mod step;

pub use error::DiffusionError;
pub use flash::Conductor;
pub use graph::{Edge, Graph};
pub use half_space::{Grid, HalfSpace};
pub use node::{Node, Store};
pub use steady::{Steady, steady};
pub use step::{Balance, step};
