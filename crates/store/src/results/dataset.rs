//! Bookkeeping of datasets: those that grow by rows, and slots that are overwritten.

/// Handle of a dataset that grows along its first axis.
#[derive(Clone, Copy, Debug)]
pub struct GrowingDataset {
    /// Index in [`Store::grown`](super::store::Store::grown).
    pub(super) place: usize,
}

/// Bookkeeping of a growing dataset.
#[derive(Clone, Debug)]
pub struct GrowthRecord {
    /// Path of the dataset.
    pub path: String,
    /// Number of rows, including those buffered in memory.
    pub rows: u64,
    /// CRC-32 of the bytes of all rows.
    pub sum: u32,
    /// Numbers per row.
    pub width: u64,
    /// Whether the numbers are integers.
    pub whole: bool,
    /// Buffered numbers of the last rows, as bits.
    pub(super) buffered: Vec<u64>,
}

impl GrowthRecord {
    /// Path from the root, in the form that readers use.
    pub fn name(&self) -> &str {
        self.path.trim_start_matches('/')
    }

    /// Number of rows in the file.
    pub(super) fn written(&self) -> u64 {
        self.rows - self.buffered.len() as u64 / self.width
    }

    /// A shape or offset for a number of rows.
    pub(super) fn shape(&self, rows: u64, width: u64) -> Vec<u64> {
        match self.width {
            1 => vec![rows],
            _ => vec![rows, width],
        }
    }
}

/// Handle of a block of bytes that is overwritten repeatedly.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    /// Index in the store's list of slots.
    pub(super) place: usize,
}

/// Bookkeeping of a slot.
#[derive(Debug, Default)]
pub(super) struct Bytes {
    pub path: String,
    /// Capacity in the file, in bytes.
    pub size: u64,
    /// Content that is not in the file yet.
    pub buffered: Option<Vec<u8>>,
}

impl Bytes {
    pub fn name(&self) -> &str {
        self.path.trim_start_matches('/')
    }
}

/// Number types that can be stored.
pub trait Number: Copy {
    /// Whether the type is an integer.
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

/// Returns the bytes of values, one value after the other. (`flat_map` over bytes is much slower.)
pub(super) fn to_bytes<T: Copy>(values: &[T], convert: impl Fn(T) -> [u8; 8]) -> Vec<u8> {
    let mut bytes = vec![0; 8 * values.len()];
    let places = bytes.as_chunks_mut::<8>().0;
    for (place, value) in places.iter_mut().zip(values) {
        *place = convert(*value);
    }
    bytes
}
