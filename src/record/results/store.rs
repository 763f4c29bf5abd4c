//! The only file of this folder, with `reader.rs` and `kept.rs`, that knows the HDF5 crate: growing datasets through its SWMR writer, whose files can
//! be read up to the last flush after a crash.

use hdf5::swmr::SwmrFileWriter;
use hdf5::{DatatypeMessage, FileLocking, H5File, H5Type};
use std::path::{Path, PathBuf};

/// Why results cannot be written, or those of a run that was stopped not be read.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// They cannot be written.
    #[error("cannot write {}: {reason}; choose another folder with --out or make room on the disk", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// They cannot be read.
    #[error("cannot read {}: {reason}; to begin anew leave --resume out", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

impl ResultsError {
    pub(super) fn unreadable(path: &Path, reason: String) -> Self {
        Self::Read {
            path: path.to_owned(),
            reason,
        }
    }
}

/// A dataset that grows along its first axis.
#[derive(Clone, Copy, Debug)]
pub struct Growing {
    /// Its place in [`Store::grown`].
    place: usize,
}

/// What is known of a growing dataset.
#[derive(Clone, Debug)]
pub struct Grown {
    /// Its path.
    pub path: String,
    index: usize,
    /// Rows so far.
    pub rows: u64,
    /// CRC-32 of their bytes.
    pub sum: u32,
    /// Numbers a row.
    pub width: u64,
    /// Whether they are whole numbers.
    pub whole: bool,
}

/// Bytes that are written over again and again.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    index: usize,
    size: u64,
}

/// An HDF5 file being written.
pub struct Store {
    writer: SwmrFileWriter,
    path: PathBuf,
    grown: Vec<Grown>,
}

impl std::fmt::Debug for Store {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Store")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl Store {
    /// Creates the file; what is declared until [`Store::start`] is visible to readers while it grows.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path) -> Result<Self, ResultsError> {
        let writer = SwmrFileWriter::create_with_locking(path, FileLocking::BestEffort);
        Ok(Self {
            writer: named(path, writer)?,
            path: path.to_owned(),
            grown: Vec::new(),
        })
    }

    /// Gives the file another name; one that stands there is replaced. Either the one or the other is there at any
    /// moment.
    ///
    /// # Errors
    /// The file cannot be renamed.
    pub fn rename(&mut self, path: &Path) -> Result<(), ResultsError> {
        named(path, std::fs::rename(&self.path, path))?;
        path.clone_into(&mut self.path);
        // The name is safe when its folder is; not every system can say so of a folder.
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
        if let Ok(folder) = std::fs::File::open(folder.unwrap_or(Path::new("."))) {
            let _ = folder.sync_all();
        }
        Ok(())
    }

    fn named<T, E: std::fmt::Display>(&self, result: Result<T, E>) -> Result<T, ResultsError> {
        named(&self.path, result)
    }

    /// Makes a group; its parent must exist.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn group(&mut self, path: &str) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let made = self.writer.create_group(parent, name);
        self.named(made)
    }

    /// A second name for a group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn link(&mut self, path: &str, target: &str) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let made = self.writer.create_hard_link(parent, name, target);
        self.named(made)
    }

    /// A text attribute of a group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn text_attribute(
        &mut self,
        group: &str,
        name: &str,
        text: &str,
    ) -> Result<(), ResultsError> {
        let made = self.writer.set_group_attr_string(group, name, text);
        self.named(made)
    }

    /// A fixed-length ASCII attribute, as VTK wants it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn ascii_attribute(
        &mut self,
        group: &str,
        name: &str,
        text: &str,
    ) -> Result<(), ResultsError> {
        let datatype = DatatypeMessage::fixed_string(text.len() as u32);
        let made =
            self.writer
                .set_group_attr_typed(group, name, datatype, text.as_bytes().to_vec());
        self.named(made)
    }

    /// Whole numbers as an attribute: a scalar when there is one.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn integer_attribute(
        &mut self,
        group: &str,
        name: &str,
        values: &[i64],
    ) -> Result<(), ResultsError> {
        let made = match values {
            [one] => self.writer.set_group_attr_numeric::<i64>(group, name, one),
            many => {
                self.writer
                    .set_group_attr_array::<i64>(group, name, &[many.len() as u64], many)
            }
        };
        self.named(made)
    }

    /// A dataset of texts, written once.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn texts(&mut self, path: &str, texts: &[&str]) -> Result<(), ResultsError> {
        let (group, _) = split(path);
        let made = self
            .writer
            .write_string_dataset(path.trim_start_matches('/'), texts);
        let index = self.named(made)?;
        self.place(group, index)
    }

    fn place(&mut self, group: &str, index: usize) -> Result<(), ResultsError> {
        if group == "/" {
            return Ok(());
        }
        let placed = self.writer.assign_dataset_to_group(group, index);
        self.named(placed)
    }

    /// A dataset of rows of `width` numbers, written once; none where there is no row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn numbers<T: H5Type + Number>(
        &mut self,
        path: &str,
        width: u64,
        values: &[T],
        unit: &str,
    ) -> Result<(), ResultsError> {
        if values.is_empty() {
            return Ok(());
        }
        let rows = values.len() as u64 / width;
        let dims = if width == 1 {
            vec![rows]
        } else {
            vec![rows, width]
        };
        let name = path.trim_start_matches('/');
        let made = self.writer.write_dataset::<T>(name, &dims, values);
        let index = self.named(made)?;
        if !unit.is_empty() {
            let set = self.writer.set_dataset_attr_string(index, "unit", unit);
            self.named(set)?;
        }
        self.place(split(path).0, index)
    }

    /// A growing dataset of rows of `width` numbers (1: a plain column), with its unit and a line of
    /// explanation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn growing<T: H5Type + Number>(
        &mut self,
        path: &str,
        width: u64,
        unit: &str,
        doc: &str,
    ) -> Result<Growing, ResultsError> {
        const CHUNK: u64 = 2048;
        let (group, _) = split(path);
        let shape = |rows: u64| {
            if width == 1 {
                vec![rows]
            } else {
                vec![rows, width]
            }
        };
        let most = if width == 1 {
            vec![None]
        } else {
            vec![None, Some(width)]
        };
        let made = self.writer.create_grid_dataset_with_max(
            path.trim_start_matches('/'),
            T::hdf5_type(),
            &shape(0),
            &most,
            &shape(CHUNK),
            None,
        );
        let index = self.named(made)?;
        for (name, text) in [("unit", unit), ("doc", doc)] {
            if !text.is_empty() {
                let set = self.writer.set_dataset_attr_string(index, name, text);
                self.named(set)?;
            }
        }
        self.place(group, index)?;
        self.grown.push(Grown {
            path: path.to_owned(),
            index,
            rows: 0,
            sum: 0,
            width,
            whole: T::WHOLE,
        });
        Ok(Growing {
            place: self.grown.len() - 1,
        })
    }

    /// Bytes that can be written over, with a line of explanation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn slot(&mut self, path: &str, doc: &str) -> Result<Slot, ResultsError> {
        const CHUNK: u64 = 1 << 15;
        let (group, _) = split(path);
        let made = self.writer.create_grid_dataset_with_max(
            path.trim_start_matches('/'),
            u8::hdf5_type(),
            &[0],
            &[None],
            &[CHUNK],
            None,
        );
        let index = self.named(made)?;
        let set = self.writer.set_dataset_attr_string(index, "doc", doc);
        self.named(set)?;
        self.place(group, index)?;
        Ok(Slot { index, size: 0 })
    }

    /// Writes over a slot, its first `seal` bytes last: when these are there, the rest is on the disk, and so is all
    /// that was appended before. A slot never shrinks: what is longer than the bytes is left from before.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(
        &mut self,
        slot: &mut Slot,
        bytes: &[u8],
        seal: usize,
    ) -> Result<(), ResultsError> {
        let length = bytes.len() as u64;
        if length > slot.size {
            let grown = self.writer.set_extent(slot.index, &[length]);
            self.named(grown)?;
            slot.size = length;
        }
        let (head, body) = bytes.split_at(seal);
        let mut open = vec![0; seal];
        open.extend_from_slice(body);
        self.write_at(slot, &open)?;
        self.flush()?;
        self.write_at(slot, head)?;
        // A flush would go through all datasets again.
        let synced = std::fs::File::open(&self.path).and_then(|f| f.sync_data());
        self.named(synced)
    }

    fn write_at(&mut self, slot: &Slot, bytes: &[u8]) -> Result<(), ResultsError> {
        let length = bytes.len() as u64;
        let written = self.writer.write_slice(slot.index, &[0], &[length], bytes);
        self.named(written)
    }

    /// The growing datasets, in the order of their declarations.
    pub fn grown(&self) -> &[Grown] {
        &self.grown
    }

    /// Rows of a dataset so far.
    pub fn rows(&self, dataset: Growing) -> u64 {
        self.grown[dataset.place].rows
    }

    /// Everything is declared: readers may follow from here on.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn start(&mut self) -> Result<(), ResultsError> {
        let started = self.writer.start_swmr();
        self.named(started)
    }

    /// Appends rows; `values` has a whole number of them.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append<T: Number>(
        &mut self,
        dataset: Growing,
        values: &[T],
    ) -> Result<(), ResultsError> {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.bytes()).collect();
        self.append_bytes(dataset.place, &bytes)
    }

    /// Appends rows, given as the bytes of their numbers, to the dataset at a place of [`Store::grown`].
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_bytes(&mut self, place: usize, bytes: &[u8]) -> Result<(), ResultsError> {
        let dataset = self.grown[place].clone();
        let rows = bytes.len() as u64 / (8 * dataset.width);
        if rows == 0 {
            return Ok(());
        }
        let (start, end) = (dataset.rows, dataset.rows + rows);
        let plain = dataset.width == 1;
        let dims = |r: u64| {
            if plain {
                vec![r]
            } else {
                vec![r, dataset.width]
            }
        };
        let starts = if plain { vec![start] } else { vec![start, 0] };
        let grown = self.writer.set_extent(dataset.index, &dims(end));
        self.named(grown)?;
        let written = self
            .writer
            .write_slice(dataset.index, &starts, &dims(rows), bytes);
        self.named(written)?;
        let mut sum = crc32fast::Hasher::new_with_initial(dataset.sum);
        sum.update(bytes);
        self.grown[place].sum = sum.finalize();
        self.grown[place].rows = end;
        Ok(())
    }

    /// Makes what was appended visible and safe.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        let flushed = self.writer.flush();
        self.named(flushed)
    }

    /// Closes the file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn close(self) -> Result<(), ResultsError> {
        let path = self.path;
        named(&path, self.writer.close())?;
        let synced = std::fs::File::open(&path).and_then(|f| f.sync_data());
        named(&path, synced)
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

/// A small file whose `/VTKHDF` is a group of another file beside it.
///
/// # Errors
/// The file cannot be written.
pub fn companion(path: &Path, file: &str, target: &str) -> Result<(), ResultsError> {
    let write = || -> hdf5::Result<()> {
        let companion = H5File::create(path)?;
        companion.create_external_link("VTKHDF", file, target)?;
        companion.close()
    };
    named(path, write())
}

fn named<T, E: std::fmt::Display>(path: &Path, result: Result<T, E>) -> Result<T, ResultsError> {
    result.map_err(|e| ResultsError::Write {
        path: path.to_owned(),
        reason: e.to_string(),
    })
}

fn split(path: &str) -> (&str, &str) {
    match path.rsplit_once('/') {
        Some(("", name)) => ("/", name),
        Some((parent, name)) => (parent, name),
        None => ("/", path),
    }
}
