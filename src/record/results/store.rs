//! The only file of this folder, with `state.rs`, that knows the HDF5 crate: growing datasets through its SWMR writer, whose files can
//! be read up to the last flush after a crash.

use hdf5::swmr::SwmrFileWriter;
use hdf5::{DatatypeMessage, FileLocking, H5File, H5Type};
use std::path::{Path, PathBuf};

/// Why results cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {reason}; choose another folder with --out or make room on the disk", path.display())]
pub struct ResultsError {
    path: PathBuf,
    reason: String,
}

/// A dataset that grows along its first axis.
#[derive(Clone, Copy, Debug)]
pub struct Growing {
    index: usize,
    rows: u64,
    width: u64,
}

/// An HDF5 file being written.
pub struct Store {
    writer: SwmrFileWriter,
    path: PathBuf,
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
        })
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

    /// A growing dataset of rows of `width` numbers (1: a plain column), with its unit and a line of
    /// explanation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn growing<T: H5Type>(
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
        Ok(Growing {
            index,
            rows: 0,
            width,
        })
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
        dataset: &mut Growing,
        values: &[T],
    ) -> Result<(), ResultsError> {
        let rows = values.len() as u64 / dataset.width;
        if rows == 0 {
            return Ok(());
        }
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.bytes()).collect();
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
            .write_slice(dataset.index, &starts, &dims(rows), &bytes);
        self.named(written)?;
        dataset.rows = end;
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
        named(&path, self.writer.close())
    }
}

impl Growing {
    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }
}

/// Numbers that are written.
pub trait Number: Copy {
    /// Little-endian bytes.
    fn bytes(self) -> [u8; 8];
}

impl Number for f64 {
    fn bytes(self) -> [u8; 8] {
        self.to_le_bytes()
    }
}

impl Number for i64 {
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
    result.map_err(|e| ResultsError {
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
