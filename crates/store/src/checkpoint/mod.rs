//! Checkpoints: what `results.h5` keeps of a run, so that `--resume` ends in the bits of a run that was never stopped.
//!
//! ```text
//! /checkpoints/even, /checkpoints/odd   bytes of a frame each, written in turn
//! ```
//! A frame holds what the run is of (case, materials, laws, scene: [`Identity`]) and what it carries from step to step,
//! under a checksum. While one of the two is written the other is whole, so that there is one to go on from at any
//! moment. What is promised is written in `docs/checkpoints.md`.

mod error;
mod find;
mod frame;
mod identity;
mod keeper;

pub use error::ResumeError;
pub use find::{Found, LAST, ResumePoint, find};
pub use frame::{Frame, Kind};
pub use identity::Identity;
pub use keeper::CheckpointWriter;
