//! The file of results: declared once, then growing by rows that are kept in memory and written by time.
//!
//! While the file is small, it is never changed where it stands: a copy beside it gets the new rows, is synced, and takes
//! its name. So whatever has the name is whole at any moment, and a flush takes one `fdatasync`. Beyond [`LARGE`] copies would
//! cost more than they save, and the file grows in place by HDF5's single-writer protocol ([`super::growth`]), whose
//! flush syncs once a dataset.
//!
//! This file, with `dataset.rs`, `growth.rs`, `reader.rs` and `kept.rs`, is all of this folder that knows the HDF5 crate.

use super::dataset::{Bytes, Growing, Grown, Number, Slot};
use super::declare::group;
use super::growth::Growth;
use hdf5::H5File;
use std::path::{Path, PathBuf};

/// A file of so many bytes is copied no more, and grows in place,
const LARGE: u64 = 64 << 20;
/// unless this variable of the environment says another number: where disks are far away copies cost more.
const LARGE_FROM: &str = "FRETWORK_COPY_LIMIT";

/// Rows of so many bytes are not kept in memory until the next flush.
const MAX_HELD: usize = 8 << 20;

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

/// An HDF5 file being written.
pub struct Store {
    /// Where it is written before it takes its name,
    part: PathBuf,
    /// and its name, once it has one.
    name: Option<PathBuf>,
    /// The file, while things are declared.
    draft: Option<H5File>,
    /// The file, once it grows in place.
    growth: Option<Growth>,
    grown: Vec<Grown>,
    slots: Vec<Bytes>,
    /// Attributes of groups that are not in the file yet: group, name, value.
    attributes: Vec<(String, String, i64)>,
    /// Bytes of the rows kept in memory.
    held: usize,
    /// From so many bytes on the file grows in place.
    large: u64,
}

impl std::fmt::Debug for Store {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Store")
            .field("path", &self.path())
            .finish_non_exhaustive()
    }
}

impl Store {
    /// Creates the file, for things to be declared until [`Store::start`]. It has no name but `part` before
    /// [`Store::publish`].
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(part: &Path) -> Result<Self, ResultsError> {
        let file = H5File::options().best_effort_locking().create(part);
        Ok(Self {
            part: part.to_owned(),
            name: None,
            draft: Some(named(part, file)?),
            growth: None,
            grown: Vec::new(),
            slots: Vec::new(),
            attributes: Vec::new(),
            held: 0,
            large: std::env::var(LARGE_FROM)
                .ok()
                .and_then(|n| n.parse().ok())
                .unwrap_or(LARGE),
        })
    }

    /// Where the file stands now.
    fn path(&self) -> &Path {
        self.name.as_deref().unwrap_or(&self.part)
    }

    pub(super) fn declaring(&self) -> Result<&H5File, ResultsError> {
        self.named(self.draft.as_ref().ok_or("all was declared before"))
    }

    pub(super) fn add_grown(&mut self, path: &str, width: u64, whole: bool) -> Growing {
        self.grown.push(Grown {
            path: path.to_owned(),
            rows: 0,
            sum: 0,
            width,
            whole,
            held: Vec::new(),
        });
        Growing {
            place: self.grown.len() - 1,
        }
    }

    pub(super) fn add_slot(&mut self, path: &str) -> Slot {
        self.slots.push(Bytes {
            path: path.to_owned(),
            ..Bytes::default()
        });
        Slot {
            place: self.slots.len() - 1,
        }
    }

    pub(super) fn named<T, E: std::fmt::Display>(
        &self,
        result: Result<T, E>,
    ) -> Result<T, ResultsError> {
        named(&self.part, result)
    }

    /// Gives a whole number that is an attribute of a group another value, with the next flush; in a file that grows in
    /// place when it is closed.
    pub fn count(&mut self, group: &str, name: &str, value: i64) {
        let same = |a: &&mut (String, String, i64)| a.0 == group && a.1 == name;
        match self.attributes.iter_mut().find(same) {
            Some(known) => known.2 = value,
            None => self
                .attributes
                .push((group.to_owned(), name.to_owned(), value)),
        }
    }

    /// Everything is declared.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn start(&mut self) -> Result<(), ResultsError> {
        let closed = self.draft.take().map_or(Ok(()), H5File::close_no_sync);
        self.named(closed)
    }

    /// Gives the file its name, with all that was appended: one that stood there is replaced.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn publish(&mut self, name: &Path) -> Result<(), ResultsError> {
        self.flush()?;
        if self.growth.is_none() {
            self.sync(&self.part)?;
        }
        self.take_name(name)?;
        self.name = Some(name.to_owned());
        sync_folder(name);
        Ok(())
    }

    /// Keeps bytes for a slot: they are written with the next flush, or when the file is closed. A slot never shrinks:
    /// what is longer than the bytes is left from before.
    pub fn keep(&mut self, slot: Slot, bytes: &[u8]) {
        self.slots[slot.place].held = Some(bytes.to_vec());
    }

    /// Writes over a slot: when this returns, it is on the disk with all that was appended before. At no moment are
    /// the first `seal` bytes of it in the file without the rest.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, slot: Slot, bytes: &[u8], seal: usize) -> Result<(), ResultsError> {
        let Some(growth) = &mut self.growth else {
            self.keep(slot, bytes);
            self.flush()?;
            sync_folder(self.path());
            return Ok(());
        };
        let state = &mut self.slots[slot.place];
        let name = state.path.trim_start_matches('/');
        let written = growth
            .write(&mut self.grown)
            .and_then(|()| growth.write_over(name, &mut state.size, bytes, seal));
        self.held = 0;
        self.named(written)?;
        self.sync(self.path())
    }

    /// The growing datasets, in the order of their declarations.
    pub fn grown(&self) -> &[Grown] {
        &self.grown
    }

    /// Rows of a dataset so far.
    pub fn rows(&self, dataset: Growing) -> u64 {
        self.grown[dataset.place].rows
    }

    /// Appends rows; `values` has a whole number of them. They are kept in memory until the next flush, or until they are many.
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
        let dataset = &mut self.grown[place];
        let mut sum = crc32fast::Hasher::new_with_initial(dataset.sum);
        sum.update(bytes);
        dataset.sum = sum.finalize();
        dataset.rows += bytes.len() as u64 / (8 * dataset.width);
        let numbers = bytes.as_chunks::<8>().0.iter();
        dataset.held.extend(numbers.map(|b| u64::from_le_bytes(*b)));
        self.held += bytes.len();
        if self.held < MAX_HELD {
            return Ok(());
        }
        match &mut self.growth {
            // Handed to the system, but not counted in the file before the next flush.
            Some(growth) => {
                let written = growth.write(&mut self.grown);
                self.held = 0;
                self.named(written)
            }
            None if self.name.is_none() => self.flush(),
            // Half a state must not be seen: it waits for the flush.
            None => Ok(()),
        }
    }

    /// Whether the file is so large that it grows in place, where a flush syncs once a dataset.
    pub fn grows_in_place(&self) -> bool {
        self.growth.is_some()
    }

    /// Whether so many rows are kept in memory that they are to be flushed.
    pub fn full(&self) -> bool {
        self.held >= MAX_HELD
    }

    /// Makes what was appended visible and safe.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        if let Some(growth) = &mut self.growth {
            let written = growth.write(&mut self.grown).and_then(|()| growth.flush());
            self.held = 0;
            return self.named(written);
        }
        if self.is_settled() {
            return Ok(());
        }
        let flushed = match self.name.clone() {
            Some(name) => self.replace(&name),
            None => self.renew(),
        };
        if flushed.is_err() && self.name.is_some() {
            // What has the name is whole.
            self.growth = None;
            let _ = std::fs::remove_file(&self.part);
        }
        flushed?;
        self.settle();
        Ok(())
    }

    /// Puts a copy with the new rows in the place of the file.
    fn replace(&mut self, name: &Path) -> Result<(), ResultsError> {
        self.named(std::fs::copy(name, &self.part))?;
        self.renew()?;
        if self.growth.is_none() {
            self.sync(&self.part)?;
        }
        self.take_name(name)
    }

    /// Adds what is kept in memory to the file that has not its name; one that is large grows in place from here on.
    fn renew(&mut self) -> Result<(), ResultsError> {
        let file = H5File::options().best_effort_locking().open_rw(&self.part);
        let file = self.named(file)?;
        let written = self.write_into(&file);
        // A file that is dropped would be synced, and would say on the terminal what went wrong.
        let closed = file.close_no_sync();
        self.named(written.and(closed))?;
        let size = self.named(std::fs::metadata(&self.part))?.len();
        if size >= self.large {
            self.growth = Some(self.named(Growth::begin(&self.part))?);
        }
        Ok(())
    }

    /// Whether all is in the file.
    fn is_settled(&self) -> bool {
        let slots = self.slots.iter().all(|s| s.held.is_none());
        self.held == 0 && slots && self.attributes.is_empty()
    }

    /// Takes in that all is in the file.
    fn settle(&mut self) {
        for dataset in &mut self.grown {
            dataset.held = Vec::new();
        }
        for slot in &mut self.slots {
            let length = slot.held.take().map_or(0, |b| b.len() as u64);
            slot.size = slot.size.max(length);
        }
        self.attributes.clear();
        self.held = 0;
    }

    fn write_into(&self, file: &H5File) -> hdf5::Result<()> {
        for (path, name, value) in &self.attributes {
            group(file, path)?.set_attr_numeric::<i64>(name, value)?;
        }
        for grown in self.grown.iter().filter(|g| !g.held.is_empty()) {
            let places = |rows: u64, width: u64| -> Vec<usize> {
                let shape = grown.shape(rows, width);
                shape.iter().map(|n| *n as usize).collect()
            };
            let (first, count) = (grown.written(), grown.rows - grown.written());
            let dataset = file.dataset_writer(grown.name())?;
            dataset.extend(&places(grown.rows, grown.width))?;
            dataset.write_slice(&places(first, 0), &places(count, grown.width), &grown.held)?;
        }
        for slot in &self.slots {
            let Some(bytes) = &slot.held else {
                continue;
            };
            let dataset = file.dataset_writer(slot.name())?;
            if bytes.len() as u64 > slot.size {
                dataset.extend(&[bytes.len()])?;
            }
            dataset.write_slice(&[0], &[bytes.len()], bytes)?;
        }
        Ok(())
    }

    fn sync(&self, path: &Path) -> Result<(), ResultsError> {
        self.named(std::fs::File::open(path).and_then(|f| f.sync_data()))
    }

    fn take_name(&self, name: &Path) -> Result<(), ResultsError> {
        named(name, std::fs::rename(&self.part, name))
    }

    /// Closes the file, with what was appended and kept: it is on the disk when this returns.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn close(mut self) -> Result<(), ResultsError> {
        if let Some(mut growth) = self.growth.take() {
            let rows = growth.write(&mut self.grown);
            let slots = self.slots.iter_mut().try_for_each(|slot| {
                let held = slot.held.take();
                let write = |b: Vec<u8>| {
                    growth.write_slot(slot.path.trim_start_matches('/'), &mut slot.size, &b)
                };
                held.map_or(Ok(()), write)
            });
            let counts = self
                .attributes
                .iter()
                .try_for_each(|(group, name, value)| growth.count(group, name, *value));
            let closed = growth.close();
            self.named(rows.and(slots).and(counts).and(closed))?;
            self.sync(self.path())?;
        } else {
            self.flush()?;
        }
        sync_folder(self.path());
        Ok(())
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        // Dropped without an end: what was handed to the system stays, and nothing is said on the terminal.
        if let Some(file) = self.draft.take() {
            let _ = file.close_no_sync();
        }
    }
}

/// A name is safe when its folder is; not every system can say so of a folder.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if let Ok(folder) = std::fs::File::open(folder.unwrap_or(Path::new("."))) {
        let _ = folder.sync_all();
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
        companion.close_no_sync()
    };
    named(path, write())
}

fn named<T, E: std::fmt::Display>(path: &Path, result: Result<T, E>) -> Result<T, ResultsError> {
    result.map_err(|e| ResultsError::Write {
        path: path.to_owned(),
        reason: e.to_string(),
    })
}
