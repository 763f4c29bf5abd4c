//! Schedule of checkpoints.

use super::{Frame, FrameKind, Identity};
use fretwork_observe::encoding::{EncodingError, encode};
use fretwork_scene::case::Checkpoint;
use std::time::{Duration, Instant};

/// Checkpoints at time intervals take at most 1/`SHARE` of a run's time.
const SHARE: u32 = 20;

/// Writer of a run's checkpoints.
#[derive(Debug)]
pub struct CheckpointWriter {
    rule: Checkpoint,
    identity: Vec<u8>,
    /// Number of the next frame.
    next: u64,
    last: Instant,
    cost: Duration,
}

impl CheckpointWriter {
    /// Returns a writer for a run with this identity, whose first frame has this number.
    ///
    /// # Errors
    /// The identity cannot be serialized.
    pub fn new(rule: Checkpoint, identity: &Identity, next: u64) -> Result<Self, EncodingError> {
        Ok(Self {
            rule,
            identity: encode(identity)?,
            next,
            last: Instant::now(),
            cost: Duration::ZERO,
        })
    }

    /// Whether a checkpoint is due after this number of steps.
    pub fn due(&self, steps: u64) -> bool {
        match self.rule {
            Checkpoint::Never => false,
            Checkpoint::Steps(n) => steps.is_multiple_of(n),
            Checkpoint::Seconds(every) => {
                let past = self.last.elapsed();
                past.as_secs_f64() >= every && past >= SHARE * self.cost
            }
        }
    }

    /// Whether the run keeps a state before its end, from which a longer one can continue.
    pub fn keeps_last(&self) -> bool {
        self.rule != Checkpoint::Never
    }

    /// Name of the run's identity, which is written to the summary.
    pub fn name(&self) -> String {
        Identity::name(&self.identity)
    }

    /// Returns the next frame: its number, which determines its slot, and its bytes.
    pub fn frame(&mut self, kind: FrameKind, state: Vec<u8>) -> (u64, Vec<u8>) {
        let frame = Frame {
            kind,
            number: self.next,
            format: Frame::FORMAT,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            identity: self.identity.clone(),
            state,
        };
        self.next += 1;
        (frame.number, frame.bytes())
    }

    /// Records that the checkpoint begun at this instant was written.
    pub fn written(&mut self, begun: Instant) {
        self.last = Instant::now();
        self.cost = begun.elapsed();
    }
}
