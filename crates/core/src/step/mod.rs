//! The time step.
//!
//! ```text
//!       ┌──────► detect (broad, narrow) ─► contact network (memory: bonds, D, slip)
//!       │                                        ▼
//!       │                         mean places of points on meshes (gap, what they act on)
//!       │                                        ▼
//!       │                         predict contacts that close within the step, mean places of these
//!       │                                        ▼
//!       │                         laws: prepare (batch, plugin ABI)
//!       │                                        ▼
//!       │                         solve: standard local form ─► p
//!       │                                        ▼
//!       │                         laws: commit (damage, broken, wear, dissipation)
//!       │                                        ▼
//!       │                         heat, current and work of expansion, where the case has them
//!       │                                        ▼
//!       │                         energy ledger
//!       │                                        ▼
//!       │                         advance bodies, processes after the move
//!       │                                        ▼
//!       └──────────────── observers and files (layers above), processes between steps
//! ```
mod action;
mod agreement;
mod answers;
mod attraction;
mod balance;
mod change;
mod columns;
pub mod control;
pub mod coupling;
mod dimension;
mod error;
mod expansion;
pub mod fields;
mod finite;
mod heat;
mod imposed;
mod impossible;
mod mortar;
pub mod motion;
mod one_step;
mod options;
mod prediction;
mod problem;
pub mod process;
mod processes;
pub mod projection;
mod removal;
mod repeat;
mod report;
mod run;
mod simulation;
mod sliding;
mod state;
mod swerve;
mod systems;
mod turning;
mod workspace;

pub use agreement::Agreement;
pub use change::{ContactForces, StepChange};
pub use columns::ContactRow;
pub use dimension::{InDimension, InDimensionMut};
pub use error::StepError;
pub use impossible::{DrivenOverlap, Impossible, ImpossibleMotions};
pub use options::{Options, Scheme};
pub use processes::ProcessState;
pub use projection::Projected;
pub use repeat::{RepeatError, Saved};
pub use report::{StepReport, Timing};
pub use simulation::Simulation;
pub use state::State;

#[cfg(test)]
mod tests;
