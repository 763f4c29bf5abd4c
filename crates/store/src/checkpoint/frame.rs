//! Frames: the bytes of a checkpoint, protected by a checksum.
//!
//! ```text
//! 0  "FRETWORK"       8  format (u32)       12  kind (u32)         16  number of the frame (u64)
//! 24 bytes of the version, the identity and the state (3 u64)      48  SHA-256 of all the rest
//! 80 version, identity, state
//! ```
//! Numbers are little-endian. This header is the same in all versions, so that a version can report
//! which one wrote a frame.

use sha2::{Digest, Sha256};

/// Kind of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// The run has started, without a state to resume from.
    Begun,
    /// A state to resume from.
    State,
    /// The run has finished; its last state is in the other frame.
    Ended,
}

/// A checkpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Kind of the frame.
    pub kind: FrameKind,
    /// Number of the frame in its run, increasing with time.
    pub number: u64,
    /// Format of the identity and the state, see [`Frame::FORMAT`].
    pub format: u32,
    /// Version of the program that wrote the frame.
    pub version: String,
    /// Serialized identity of the run.
    pub identity: Vec<u8>,
    /// Serialized state.
    pub state: Vec<u8>,
}

const MAGIC: &[u8; 8] = b"FRETWORK";
const HASH: usize = 48;
const BODY: usize = 80;

impl Frame {
    /// Version of the format of identities and states that this program writes. It increases by one
    /// with every change of their content.
    pub const FORMAT: u32 = 21;

    /// First bytes of a frame. They are zero until all other bytes are on disk.
    pub const SEAL: usize = MAGIC.len();

    /// Serializes the frame.
    pub fn bytes(&self) -> Vec<u8> {
        let kind: u32 = match self.kind {
            FrameKind::Begun => 0,
            FrameKind::State => 1,
            FrameKind::Ended => 2,
        };
        let parts = [self.version.as_bytes(), &self.identity, &self.state];
        let mut bytes = Vec::with_capacity(BODY + parts.iter().map(|p| p.len()).sum::<usize>());
        bytes.extend_from_slice(MAGIC);
        bytes.extend(self.format.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(self.number.to_le_bytes());
        for part in parts {
            bytes.extend((part.len() as u64).to_le_bytes());
        }
        bytes.resize(BODY, 0);
        for part in parts {
            bytes.extend_from_slice(part);
        }
        let hash = hash(&bytes);
        bytes[HASH..BODY].copy_from_slice(&hash);
        bytes
    }

    /// Reads the frame at the start of `bytes`; `None` if it is incomplete or damaged.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        let long = |at: usize| Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?));
        if bytes.get(..8)? != MAGIC {
            return None;
        }
        let mut ends = [BODY; 3];
        let mut end = BODY;
        for (k, slot) in ends.iter_mut().enumerate() {
            end = end.checked_add(usize::try_from(long(24 + 8 * k)?).ok()?)?;
            *slot = end;
        }
        let whole = bytes.get(..end)?;
        if hash(whole) != bytes[HASH..BODY] {
            return None;
        }
        let kind = match word(12)? {
            0 => FrameKind::Begun,
            1 => FrameKind::State,
            2 => FrameKind::Ended,
            _ => return None,
        };
        Some(Self {
            kind,
            number: long(16)?,
            format: word(8)?,
            version: String::from_utf8(whole[BODY..ends[0]].to_vec()).ok()?,
            identity: whole[ends[0]..ends[1]].to_vec(),
            state: whole[ends[1]..].to_vec(),
        })
    }
}

/// Hash of all bytes of a frame except the hash itself.
fn hash(frame: &[u8]) -> [u8; 32] {
    let mut hash = Sha256::new();
    hash.update(&frame[..HASH]);
    hash.update(&frame[BODY..]);
    hash.finalize().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        Frame {
            kind: FrameKind::State,
            number: 7,
            format: Frame::FORMAT,
            version: "0.1.0".into(),
            identity: b"a case".to_vec(),
            state: (0..200).collect(),
        }
    }

    #[test]
    fn a_frame_reads_back_also_over_a_longer_one() {
        let mut bytes = frame().bytes();
        assert_eq!(Frame::read(&bytes), Some(frame()));
        bytes.extend([1, 2, 3]);
        assert_eq!(Frame::read(&bytes), Some(frame()));
    }

    #[test]
    fn a_frame_with_any_wrong_bit_or_length_is_none() {
        let bytes = frame().bytes();
        for at in 0..bytes.len() {
            let mut wrong = bytes.clone();
            wrong[at] ^= 1 << (at % 8);
            assert_eq!(Frame::read(&wrong), None, "byte {at}");
            assert_eq!(Frame::read(&bytes[..at]), None, "cut at {at}");
        }
    }
}
