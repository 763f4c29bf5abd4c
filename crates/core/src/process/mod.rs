//! Processes, which act on a simulation at named moments of its steps: heat, thermal expansion,
//! wear recession, cycle jumps, the tribological circuit, and processes added by users of the
//! library. The step names none of them.
//!
//! ```text
//! step:  at_start ─► imposed motion ─► before_detection ─► detect ─► contacts_found
//!        ─► laws, solve, commit ─► after_solve ─► ledger, move ─► after_move
//! then:  (observers evaluate the step) ─► between_steps ─► the next step
//! ```
//! Phases, imposed motion, servo pressures and gravity belong to [`crate::step::control`]: they set
//! velocities and forces whose work the step itself accounts for.

pub mod circuit;
pub mod cycle;
pub mod expansion;
pub mod heat;
pub mod jump;
mod jump_summary;
pub mod recession;
pub mod sliding;

pub use crate::step::process::{Process, ProcessError};
