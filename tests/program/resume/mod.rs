//! Checkpoints: a run that was stopped ends with results that are bit-identical to those of an
//! uninterrupted one.

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
