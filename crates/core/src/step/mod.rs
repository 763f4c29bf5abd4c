//! The time step. `one_step.rs` lists its stages; each is a module of the name on the left. The
//! moments at which processes act, see [`crate::process`], stand on the right.
//!
//! ```text
//!             ┌─────►                                                        at_start
//!  control    │  schedule, imposed motion
//!             │       ▼                                                      before_detection
//!  motion     │  bodies to q_m
//!             │       ▼
//!  detection  │  contacts (broad, narrow), what they act on on meshes;
//!             │  overlaps taken out; contacts that close within the step
//!             │       ▼                                                      contacts_found
//!  problem    │  laws: prepare ─► standard local form ─► solve ─► p, until
//!             │  laws, damage and contacts agree with the velocities
//!             │  laws: commit (damage, broken, worn off, dissipation)
//!             │       ▼                                                      after_solve
//!  ledger     │  energy, momentum
//!             │       ▼
//!  motion     │  bodies to the end of the step
//!             │       ▼                                                      after_move
//!  control    │  end of a phase
//!             │       ▼
//!             └─ observers and files (layers above)                          between_steps
//! ```
mod building;
mod change;
pub mod control;
mod detection;
mod dimension;
mod error;
pub mod fields;
mod ledger;
mod motion;
mod one_step;
mod options;
mod problem;
pub mod process;
mod reading;
mod repeat;
mod report;
mod run;
mod simulation;
mod state;
mod workspace;

pub use change::ContactForces;
pub use control::ImpossibleMotions;
pub use error::StepError;
pub use options::{Coupling, Options, Scheme};
pub use reading::ContactRow;
pub use repeat::{ProcessState, RepeatError, SavedSimulation};
pub use report::{
    Agreement, CouplingReport, DrivenOverlap, Impossible, ProjectionReport, StepReport, Timing,
};
pub use simulation::Simulation;
pub use state::State;

#[cfg(test)]
mod tests;
