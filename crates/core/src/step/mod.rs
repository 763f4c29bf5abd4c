//! The time step.
//!
//! ```text
//!       ┌──────► detect (broad, narrow) ─► contact network (memory: bonds, D, slip)
//!       │                                        │
//!       │                         laws: prepare (batch, plugin ABI)
//!       │                                        ▼
//!       │                         solve: standard local form ─► p
//!       │                                        │
//!       │                         laws: commit (damage, broken, wear, dissipation)
//!       └── advance bodies ◄─────────────────────┤
//!                                                ▼
//!                               energy ledger, processes ─► observers and files, in the layers above
//! ```
mod answers;
mod columns;
mod compiled;
pub mod control;
pub mod coupling;
mod error;
pub mod fields;
mod finite;
mod foresight;
mod imposed;
pub mod motion;
pub mod process;
mod processes;
pub mod projection;
mod removal;
mod run;
mod saved;
pub mod simulation;
mod systems;

pub use columns::ContactRow;
pub use compiled::Steps;
pub use error::StepError;
pub use processes::ProcessState;
pub use projection::Projected;
pub use saved::Saved;
pub use simulation::{Scheme, Simulation, StepReport};
