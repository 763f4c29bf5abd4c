//! Diffusion on graphs: heat or electric current between nodes that are connected by conductances.
//!
//! Numbers in, numbers out: the crate knows neither contacts nor laws. A [`Graph`] has the
//! conductances at one time; [`step`] advances the temperatures of nodes with heat capacities
//! implicitly in time, [`steady`] finds the potentials of nodes without any. A node may represent
//! the surface of a [`HalfSpace`], whose depth is resolved by a graded grid and eliminated exactly
//! from the system of the nodes; heat also flows tangentially between the half-spaces of
//! neighbouring pieces of a surface, the [`Columns`].
//!
//! The equations are, with temperatures T (K), capacities C (J/K), conductances G (W/K) and sources
//! Q (W),
//!
//! ```text
//! C_i dT_i/dt = sum_j G_ij (T_j - T_i) + Q_i
//! ```
//!
//! and the same with potentials V (V), conductances (S) and currents I (A), without the left side.
//! In two dimensions C, G and Q are per metre of depth.
//!
//! ```
//! use fretwork_math::diffusion::{Edge, Graph, Node, Store, step};
//!
//! // A grain of 1 J/K at 400 K on a wall of 300 K, joined by 0.1 W/K, with 2 W of frictional heat:
//! // it tends to 320 K.
//! let mut nodes = [Node::new(400.0, Store::Lumped(1.0)), Node::new(300.0, Store::Fixed)];
//! let graph = Graph::new(2, vec![Edge { nodes: [0, 1], conductance: 0.1 }]);
//! for _ in 0..300 {
//!     let balance = step(&mut nodes, &graph, &[2.0, 0.0], 1.0, 1.0)?;
//!     assert!(balance.residual.abs() < 1e-10);
//! }
//! assert!((nodes[0].temperature - 320.0).abs() < 1e-9);
//! # Ok::<(), fretwork_math::diffusion::DiffusionError>(())
//! ```

pub mod columns;
pub mod error;
pub mod flash;
pub mod graph;
pub mod half_space;
mod matrix;
pub mod node;
mod solve;
pub mod steady;
pub mod step;

pub use columns::{ColumnAxis, Columns};
pub use error::DiffusionError;
pub use flash::Conductor;
pub use graph::{Edge, Graph};
pub use half_space::{Grid, HalfSpace};
pub use node::{Node, Store};
pub use steady::{Steady, steady};
pub use step::{Balance, step, step_with_columns};
