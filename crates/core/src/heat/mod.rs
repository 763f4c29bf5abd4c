//! Heat and electric current of a scene: the model given by the case, and the state changed by
//! steps.
//!
//! Nodes with a temperature represent bodies, or pieces of a body's surface with a half-space below
//! each. Contacts connect them by the conductances of transport laws, and are sources of the heat
//! that the energy ledger counts as dissipated at the contact in the step:
//!
//! ```text
//! C_i dT_i/dt = sum_c G_c (T_j - T_i) + Q_i
//! ```
//!
//! with capacities C (J/K), conductances G (W/K) and sources Q (W), in two dimensions per metre of
//! depth; `fretwork-math` solves it, implicitly in time. Electric potentials follow from the
//! electrical conductances of the same contacts, and Joule's heat of each contact is added to its
//! sources. Laws receive the temperatures at the start of the step.

pub mod circuit;
pub mod expansion;
pub mod ledger;
pub mod material;
pub mod model;
pub mod pieces;
pub mod state;

pub use circuit::{Circuit, CircuitState, Supply};
pub use expansion::{ExpandingSystem, Expansion};
pub use fretwork_math::diffusion::{
    Columns, Conductor, DiffusionError, Edge, Grid, HalfSpace, Node, Store,
};
pub use ledger::HeatLedger;
pub use material::ThermalMaterial;
pub use model::{BodyNodes, Heat, HeatShares, ImposedHeatFlow, Partition};
pub use pieces::{PieceAxis, Pieces};
pub use state::HeatState;
