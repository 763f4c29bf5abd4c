//! What a folder holds to go on from.

use super::{Frame, Identity, Kind, ResumeError};
use crate::results::PreviousResults;
use fretwork_observe::code::decode;
use std::path::Path;

/// What there is to go on from.
#[derive(Debug)]
pub enum Found {
    /// Nothing: the run has not begun, or no state of it was kept yet.
    Nothing,
    /// A state.
    State(ResumePoint),
    /// The run has come to its end.
    Finished,
}

/// Where a run was stopped.
#[derive(Debug)]
pub struct ResumePoint {
    /// Its file, open.
    pub kept: PreviousResults,
    /// Number of the frame.
    pub number: u64,
    /// Bytes of its state.
    pub state: Vec<u8>,
}

/// The file that a run writes last, and takes away before it begins: with it all others are there.
pub const LAST: &str = "summary.json";

/// Whether the run of a folder, of an identity of this name, came to its end, not to an error.
fn finished(folder: &Path, identity: &str) -> bool {
    let text = std::fs::read_to_string(folder.join(LAST)).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    summary["identity"] == identity && summary["steps"].is_number() && summary["stopped"].is_null()
}

/// Looks into a folder for a run of this identity.
///
/// # Errors
/// A file that cannot be read, whose checkpoints are damaged, or that is of another version or case.
pub fn find(folder: &Path, identity: &Identity) -> Result<Found, ResumeError> {
    let path = folder.join("results.h5");
    if !path.exists() {
        return Ok(Found::Nothing);
    }
    let unreadable = |reason: String| ResumeError::Unreadable {
        path: path.clone(),
        reason,
    };
    let kept = PreviousResults::open(&path).map_err(unreadable)?;
    let slots = kept.checkpoints().map_err(unreadable)?;
    let mut frames: Vec<Frame> = slots.iter().filter_map(|b| Frame::read(b)).collect();
    frames.sort_by_key(|f| f.number);
    let Some(frame) = frames.last() else {
        return Err(ResumeError::Damaged { path });
    };
    let ours = env!("CARGO_PKG_VERSION");
    if frame.version != ours || frame.format != Frame::FORMAT {
        let said = |version: &str, format: u32| format!("{version} (checkpoints of form {format})");
        return Err(ResumeError::Version {
            path,
            theirs: said(&frame.version, frame.format),
            ours: said(ours, Frame::FORMAT),
        });
    }
    let theirs: Identity = decode(&frame.identity).map_err(|source| ResumeError::State {
        path: path.clone(),
        source,
    })?;
    if let Some(what) = theirs.differs(identity) {
        return Err(ResumeError::Other { path, what });
    }
    let later = theirs.ends_later(identity);
    // The file says that it is whole, the summary of the same run that all others are.
    if !later && frame.kind == Kind::Ended && finished(folder, &Identity::name(&frame.identity)) {
        return Ok(Found::Finished);
    }
    let mut states = frames.into_iter().filter(|f| f.kind == Kind::State);
    Ok(match states.next_back() {
        None => Found::Nothing,
        Some(frame) => Found::State(ResumePoint {
            kept,
            number: frame.number,
            state: frame.state,
        }),
    })
}
