//! Checkpoints: what is kept of a run, and that a run which was stopped ends in the bits of one
//! that was not.

mod cases;
pub(crate) mod common;
mod ending;
mod faults;
mod folder;
mod kills;
mod laws;
mod library;
#[cfg(unix)]
mod limits;
mod longer_heat;
mod observer_files;
mod owner;
mod repeats;
#[cfg(unix)]
mod signals;
mod state;
