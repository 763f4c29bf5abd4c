//! Search of a results folder for a state to resume from.

use super::{Frame, FrameKind, Identity, ResumeError};
use crate::folder_lock::{FolderLock, RUN_LOCK};
use crate::results::PreviousResults;
use fretwork_observe::encoding::decode;
use std::path::Path;

/// Result of the search.
#[derive(Debug)]
pub enum FolderState {
    /// No run was started in the folder, or no state of it was saved yet.
    Nothing,
    /// A state to resume from.
    State(ResumePoint),
    /// The run is finished.
    Finished,
}

/// A saved state of a stopped run.
#[derive(Debug)]
pub struct ResumePoint {
    /// The results file of the stopped run, open for reading.
    pub results: PreviousResults,
    /// Number of the frame.
    pub number: u64,
    /// Serialized state of the last checkpoint.
    pub state: Vec<u8>,
    /// Lock by which this run owns the folder, so that no other run continues from this state.
    pub lock: FolderLock,
}

/// Name of the file that a run writes last and removes before it starts: if it exists, all others
/// are complete.
pub const SUMMARY_FILE: &str = "summary.json";

/// The summary of the run in a folder; null if it has none.
fn summary(folder: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.join(SUMMARY_FILE)).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Whether the run with this identity in a folder finished without an error.
pub(super) fn finished(folder: &Path, identity: &str) -> bool {
    let summary = summary(folder);
    summary["identity"] == identity && summary["steps"].is_number() && summary["stopped"].is_null()
}

/// Returns the reason why the run with this identity in a folder ended, if the run recorded one.
fn ended(folder: &Path, identity: &str) -> Option<String> {
    let summary = summary(folder);
    let ours = summary["identity"] == identity;
    ours.then(|| summary["stopped"].as_str().map(str::to_owned))?
}

/// Length and modification time of a file, which distinguish it from a file written later.
fn version(path: &Path) -> Option<(u64, std::time::SystemTime)> {
    let data = std::fs::metadata(path).ok()?;
    Some((data.len(), data.modified().ok()?))
}

/// Searches a folder for a run with this identity. The folder is locked only if there is a state to
/// continue from, since a finished run may be in a folder without write access.
///
/// # Errors
/// Another run is writing in the folder, a file cannot be read, its checkpoints are damaged, it
/// belongs to another version or case, or it has rows but no state.
pub fn find(folder: &Path, identity: &Identity) -> Result<FolderState, ResumeError> {
    let path = folder.join("results.h5");
    if !path.exists() {
        return Ok(FolderState::Nothing);
    }
    loop {
        let reading = FolderLock::shared(folder, RUN_LOCK)?;
        let before = version(&path);
        let saved = match look(folder, &path, identity)? {
            FolderContents::Nothing => return Ok(FolderState::Nothing),
            FolderContents::Finished => return Ok(FolderState::Finished),
            FolderContents::State(saved) => saved,
        };
        drop(reading);
        let lock = FolderLock::exclusive(folder, RUN_LOCK)?;
        // Another run may have continued in the folder between the search and the lock.
        if version(&path) == before {
            let (results, number, state) = *saved;
            return Ok(FolderState::State(ResumePoint {
                results,
                number,
                state,
                lock,
            }));
        }
    }
}

/// Content of a folder.
enum FolderContents {
    Nothing,
    Finished,
    /// The results, and number and bytes of the last state.
    State(Box<(PreviousResults, u64, Vec<u8>)>),
}

fn look(folder: &Path, path: &Path, identity: &Identity) -> Result<FolderContents, ResumeError> {
    let path = path.to_owned();
    let unreadable = |reason: String| ResumeError::Unreadable {
        path: path.clone(),
        reason,
    };
    let results = PreviousResults::open(&path).map_err(unreadable)?;
    let slots = results.checkpoints().map_err(unreadable)?;
    let mut frames: Vec<Frame> = slots
        .iter()
        .flatten()
        .filter_map(|b| Frame::read(b))
        .collect();
    frames.sort_by_key(|f| f.number);
    let Some(frame) = frames.last() else {
        return Err(ResumeError::Damaged { path });
    };
    // A sealed slot contained a valid frame. A frame that was being written when the run was killed
    // has no seal yet.
    let written = |slot: &&Option<Vec<u8>>| {
        slot.as_ref()
            .is_none_or(|bytes| bytes.iter().take(Frame::SEAL).any(|b| *b != 0))
    };
    let damaged = slots.iter().filter(written).count() > frames.len();
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
    if theirs.is_of_another_build(identity) {
        return Err(ResumeError::Build { path });
    }
    let later = theirs.ends_later(identity);
    let name = frame.identity.clone();
    // The results file is marked as complete, and the summary of this run shows that all other
    // files are complete too.
    let is_finished =
        frame.kind == FrameKind::Ended && finished(folder, &Identity::name(&frame.identity));
    if !later && is_finished {
        return Ok(FolderContents::Finished);
    }
    let mut states = frames.into_iter().filter(|f| f.kind == FrameKind::State);
    match states.next_back() {
        // Starting again would replace what the run recorded.
        None if damaged => Err(ResumeError::Damaged { path }),
        // A run of one step is made again in no time.
        None if is_finished && summary(folder)["steps"].as_u64() == Some(1) => {
            Ok(FolderContents::Nothing)
        }
        None if is_finished => Err(ResumeError::NoState {
            path,
            why:
                "it is finished, and `output.checkpoint: Never`, or an end by itself, kept no state"
                    .to_owned(),
        }),
        None => match ended(folder, &Identity::name(&name)).filter(|_| results.has_rows()) {
            Some(why) => Err(ResumeError::NoState { path, why }),
            None => Ok(FolderContents::Nothing),
        },
        Some(frame) => Ok(FolderContents::State(Box::new((
            results,
            frame.number,
            frame.state,
        )))),
    }
}
