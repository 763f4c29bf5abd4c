//! What the store knows of its datasets: those that grow by rows, and slots that are written over.

/// A dataset that grows along its first axis.
#[derive(Clone, Copy, Debug)]
pub struct Growing {
    /// Its place in [`Store::grown`](super::store::Store::grown).
    pub(super) place: usize,
}

/// What is known of a growing dataset.
#[derive(Clone, Debug)]
pub struct Grown {
    /// Its path.
    pub path: String,
    /// Rows so far, with those that are kept in memory.
    pub rows: u64,
    /// CRC-32 of their bytes.
    pub sum: u32,
    /// Numbers a row.
    pub width: u64,
    /// Whether they are whole numbers.
    pub whole: bool,
    /// Numbers of the last rows, as bits, that are not in the file yet.
    pub(super) held: Vec<u64>,
}

impl Grown {
    /// Its name from the root on, as readers give it.
    pub fn name(&self) -> &str {
        self.path.trim_start_matches('/')
    }

    /// Rows in the file.
    pub(super) fn written(&self) -> u64 {
        self.rows - self.held.len() as u64 / self.width
    }

    /// A shape or place of so many rows.
    pub(super) fn shape(&self, rows: u64, width: u64) -> Vec<u64> {
        match self.width {
            1 => vec![rows],
            _ => vec![rows, width],
        }
    }
}

/// Bytes that are written over again and again.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    /// Its place in the store's list of slots.
    pub(super) place: usize,
}

/// What is known of a slot.
#[derive(Debug, Default)]
pub(super) struct Bytes {
    pub path: String,
    /// Bytes that the file has room for.
    pub size: u64,
    /// What is not in the file yet.
    pub held: Option<Vec<u8>>,
}

impl Bytes {
    pub fn name(&self) -> &str {
        self.path.trim_start_matches('/')
    }
}

/// Numbers that are written.
pub trait Number: Copy {
    /// Whether they are whole.
    const WHOLE: bool;
    /// Little-endian bytes.
    fn bytes(self) -> [u8; 8];
}

impl Number for f64 {
    const WHOLE: bool = false;

    fn bytes(self) -> [u8; 8] {
        self.to_le_bytes()
    }
}

impl Number for i64 {
    const WHOLE: bool = true;

    fn bytes(self) -> [u8; 8] {
        self.to_le_bytes()
    }
}
