//! Checkpoints in `results.h5`, from which `--resume` continues to results that are bit-identical
//! to those of an uninterrupted run.
//!
//! ```text
//! /checkpoints/even, /checkpoints/odd   bytes of a frame each, written in turn
//! ```
//! A frame contains the identity of the run (case, materials, laws, scene: [`Identity`]) and its
//! state, protected by a checksum. The file has two frames. While one is being written the other is
//! intact, so there is always one to resume from. The guarantees are documented in
//! `docs/checkpoints/guarantees.md`.

mod error;
mod find;
mod frame;
mod identity;
mod occupied;
mod writer;

pub use error::ResumeError;
pub use find::{FolderState, ResumePoint, SUMMARY_FILE, find};
pub use frame::{Frame, FrameKind};
pub use identity::Identity;
pub use occupied::{Occupied, occupied};
pub use writer::CheckpointWriter;
