//! Results in a folder that a new run would replace.

use super::find::finished;
use super::{Frame, FrameKind, Identity};
use crate::results::PreviousResults;
use fretwork_observe::encoding::decode;
use std::path::{Path, PathBuf};

/// Results that a new run from the start does not replace unasked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} holds {what}; nothing was changed", folder.display())]
pub struct Occupied {
    /// The folder.
    pub folder: PathBuf,
    /// What it holds, and how that differs from the new run.
    pub what: String,
    /// Whether the new run can continue from a state in the folder.
    pub continues: bool,
}

/// Returns the results in a folder that a run with this identity would replace and not give again:
/// those of other inputs or of another version, of a run that is not at its end, of one with
/// another end, and files that cannot be read. The same finished run, also of another build of the
/// program, and a run that recorded nothing, may be replaced. `refuses` returns why the new run
/// cannot be an extension of one with an earlier end. The folder should be locked.
pub fn occupied(
    folder: &Path,
    identity: &Identity,
    refuses: impl FnOnce() -> Option<&'static str>,
) -> Option<Occupied> {
    let path = folder.join("results.h5");
    if !path.exists() {
        return None;
    }
    let holds = |what: String, continues: bool| {
        Some(Occupied {
            folder: folder.to_owned(),
            what,
            continues,
        })
    };
    let unreadable =
        |why: String| holds(format!("a `results.h5` that cannot be read: {why}"), false);
    let results = match PreviousResults::open(&path) {
        Ok(results) => results,
        Err(why) => return unreadable(why),
    };
    let slots = match results.checkpoints() {
        Ok(slots) => slots,
        Err(why) => return unreadable(why),
    };
    let frames = slots.iter().flatten().filter_map(|b| Frame::read(b));
    let frames: Vec<Frame> = frames.collect();
    let Some(last) = frames.iter().max_by_key(|f| f.number) else {
        return unreadable("its checkpoints are damaged".to_owned());
    };
    let state = frames.iter().any(|f| f.kind == FrameKind::State);
    if !state && last.kind == FrameKind::Begun && !results.has_rows() {
        return None;
    }
    let ours = env!("CARGO_PKG_VERSION");
    let known = decode::<Identity>(&last.identity).ok();
    let known = known.filter(|_| last.version == ours && last.format == Frame::FORMAT);
    let Some(theirs) = known else {
        return holds(
            format!(
                "a run of another version of Fretwork, {} (checkpoints of form {}; this is {ours}, {})",
                last.version,
                last.format,
                Frame::FORMAT
            ),
            false,
        );
    };
    if let Some(difference) = theirs.differs(identity) {
        return holds(format!("a run of other inputs: {difference}"), false);
    }
    let continues = state && !theirs.is_of_another_build(identity);
    if theirs.ends_later(identity) {
        let end = theirs.end();
        let what = format!("this run up to an earlier `time.end`, {end} s");
        return match refuses() {
            None => holds(what, continues),
            Some(why) => holds(format!("{what}, and cannot go on from there: {why}"), false),
        };
    }
    let ended = last.kind == FrameKind::Ended && finished(folder, &Identity::name(&last.identity));
    match ended {
        true => None,
        false => holds("this run, which is not at its end".to_owned(), continues),
    }
}
