//! The results file: its contents are declared once; then it grows by rows that are buffered in
//! memory and written at intervals.
//!
//! A small file is never changed in place: a copy beside it gets the new rows, is synced, and is
//! renamed over it. The named file is therefore always complete, and a flush takes one `fdatasync`.
//! Beyond [`MAX_COPIED_BYTES`] bytes copies would be too expensive, and the file grows in place by
//! HDF5's single-writer protocol ([`super::growth`]), whose flush syncs once per dataset.
//!
//! In this module only this file, `declare.rs`, `growth.rs`, `previous.rs` and `reader.rs` use the
//! HDF5 crate.

use super::dataset::{Bytes, GrowingDataset, GrowthRecord, Number, Slot, to_bytes};
use super::declare::group;
use super::growth::Growth;
use crate::folder_lock::{FolderLock, LockError};
use crate::write_advice;
use hdf5::H5File;
use std::path::{Path, PathBuf};

/// Size from which a file grows in place, in bytes.
const MAX_COPIED_BYTES: u64 = 64 << 20;
/// Environment variable that overrides [`MAX_COPIED_BYTES`], for slow (remote) disks.
const COPY_LIMIT_VARIABLE: &str = "FRETWORK_COPY_LIMIT";

/// Limit on the bytes of buffered rows.
const MAX_BUFFERED: usize = 8 << 20;

/// Error in writing results, or in reading those of a stopped run.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The folder of the results no longer belongs to the run.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// The results cannot be written.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// An event belongs to no declared table.
    #[error(
        "an observer gave an event of {columns} values for the table `{table}`, which no observer declares with so many columns: let its \
         `event_tables` return the table"
    )]
    UnknownEvent {
        /// Name of the table.
        table: &'static str,
        /// Number of values of the event.
        columns: usize,
    },
    /// The results cannot be read.
    #[error("cannot read {}: {reason}; to start again from the beginning write --force in place of --resume", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Reason.
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
    /// Temporary path at which the file is written.
    part: PathBuf,
    /// Final path, once the file is published.
    name: Option<PathBuf>,
    /// The file, during the declarations.
    draft: Option<H5File>,
    /// The file, once it grows in place.
    growth: Option<Growth>,
    grown: Vec<GrowthRecord>,
    slots: Vec<Bytes>,
    /// Pending attributes of groups: group, name, value.
    attributes: Vec<(String, String, i64)>,
    /// Bytes of buffered rows.
    buffered: usize,
    /// Size from which the file grows in place, in bytes.
    large: u64,
    /// The lock by which the folder is owned.
    lock: Option<FolderLock>,
}

impl std::fmt::Debug for Store {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Store")
            .field("path", &self.path())
            .finish_non_exhaustive()
    }
}

impl Store {
    /// Creates the file for declarations, until [`Store::start`]. It has the temporary name `part`
    /// until [`Store::publish`].
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
            buffered: 0,
            large: std::env::var(COPY_LIMIT_VARIABLE)
                .ok()
                .and_then(|n| n.parse().ok())
                .unwrap_or(MAX_COPIED_BYTES),
            lock: None,
        })
    }

    /// Sets the lock, with which every write first checks that the folder is still owned.
    pub fn owned_by(&mut self, lock: FolderLock) {
        self.lock = Some(lock);
    }

    fn check_still_owned(&self) -> Result<(), ResultsError> {
        Ok(self
            .lock
            .as_ref()
            .map_or(Ok(()), FolderLock::check_still_owned)?)
    }

    /// Current path of the file.
    fn path(&self) -> &Path {
        self.name.as_deref().unwrap_or(&self.part)
    }

    pub(super) fn declaring(&self) -> Result<&H5File, ResultsError> {
        self.named(self.draft.as_ref().ok_or("all was declared before"))
    }

    pub(super) fn add_grown(&mut self, path: &str, width: u64, whole: bool) -> GrowingDataset {
        self.grown.push(GrowthRecord {
            path: path.to_owned(),
            rows: 0,
            sum: 0,
            width,
            whole,
            buffered: Vec::new(),
        });
        GrowingDataset {
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

    /// Sets an integer attribute of a group at the next flush, or, in a file that grows in place,
    /// when it is closed.
    pub fn count(&mut self, group: &str, name: &str, value: i64) {
        let same = |a: &&mut (String, String, i64)| a.0 == group && a.1 == name;
        match self.attributes.iter_mut().find(same) {
            Some(known) => known.2 = value,
            None => self
                .attributes
                .push((group.to_owned(), name.to_owned(), value)),
        }
    }

    /// Ends the declarations.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn start(&mut self) -> Result<(), ResultsError> {
        let closed = self.draft.take().map_or(Ok(()), H5File::close_no_sync);
        self.named(closed)
    }

    /// Renames the file to its final name, with all appended rows; an existing file is replaced.
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

    /// Stores bytes for a slot, to be written with the next flush or at close. A slot never
    /// shrinks: bytes beyond the new content keep their old values.
    pub fn buffer_slot(&mut self, slot: Slot, bytes: &[u8]) {
        self.slots[slot.place].buffered = Some(bytes.to_vec());
    }

    /// Overwrites a slot. On return it is synced to disk together with all appended rows. At no
    /// moment does the file contain the first `seal` bytes without the rest.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, slot: Slot, bytes: &[u8], seal: usize) -> Result<(), ResultsError> {
        self.check_still_owned()?;
        let Some(growth) = &mut self.growth else {
            self.buffer_slot(slot, bytes);
            self.flush()?;
            sync_folder(self.path());
            return Ok(());
        };
        let state = &mut self.slots[slot.place];
        let name = state.path.trim_start_matches('/');
        let written = growth
            .write(&mut self.grown)
            .and_then(|()| growth.write_over(name, &mut state.size, bytes, seal));
        self.buffered = 0;
        self.named(written)?;
        self.sync(self.path())
    }

    /// The growing datasets, in the order of their declaration.
    pub fn grown(&self) -> &[GrowthRecord] {
        &self.grown
    }

    /// Number of rows of a dataset.
    pub fn rows(&self, dataset: GrowingDataset) -> u64 {
        self.grown[dataset.place].rows
    }

    /// Appends whole rows. They are buffered until the next flush, or until the buffer is full.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append<T: Number>(
        &mut self,
        dataset: GrowingDataset,
        values: &[T],
    ) -> Result<(), ResultsError> {
        let bytes = to_bytes(values, T::bytes);
        self.append_bytes(dataset.place, &bytes)
    }

    /// Appends rows, given as bytes, to the dataset with this index in [`Store::grown`].
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
        dataset
            .buffered
            .extend(numbers.map(|b| u64::from_le_bytes(*b)));
        self.buffered += bytes.len();
        if self.buffered < MAX_BUFFERED {
            return Ok(());
        }
        match &mut self.growth {
            // The rows are written to the file, but are not counted in it before the next flush.
            Some(growth) => {
                let written = growth.write(&mut self.grown);
                self.buffered = 0;
                self.named(written)
            }
            None if self.name.is_none() => self.flush(),
            // A partial state must not be visible, so the rows wait for the flush.
            None => Ok(()),
        }
    }

    /// Whether the file is so large that it grows in place, where a flush syncs once per dataset.
    pub fn grows_in_place(&self) -> bool {
        self.growth.is_some()
    }

    /// Whether the buffer is full and should be flushed.
    pub fn full(&self) -> bool {
        self.buffered >= MAX_BUFFERED
    }

    /// Makes appended rows visible to readers and syncs them to disk.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        self.check_still_owned()?;
        if let Some(growth) = &mut self.growth {
            let written = growth.write(&mut self.grown).and_then(|()| growth.flush());
            self.buffered = 0;
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
            // The named file is complete.
            self.growth = None;
            let _ = std::fs::remove_file(&self.part);
        }
        flushed?;
        self.settle();
        Ok(())
    }

    /// Replaces the file by a copy with the new rows.
    fn replace(&mut self, name: &Path) -> Result<(), ResultsError> {
        self.named(std::fs::copy(name, &self.part))?;
        self.renew()?;
        if self.growth.is_none() {
            self.sync(&self.part)?;
        }
        self.take_name(name)
    }

    /// Adds buffered rows to the temporary file; a large file grows in place from here on.
    fn renew(&mut self) -> Result<(), ResultsError> {
        let file = H5File::options().best_effort_locking().open_rw(&self.part);
        let file = self.named(file)?;
        let written = self.write_into(&file);
        // Dropping the file would sync it, and would print errors to the terminal.
        let closed = file.close_no_sync();
        self.named(written.and(closed))?;
        let size = self.named(std::fs::metadata(&self.part))?.len();
        if size >= self.large {
            self.growth = Some(self.named(Growth::begin(&self.part))?);
        }
        Ok(())
    }

    /// Whether the buffers are empty.
    fn is_settled(&self) -> bool {
        let slots = self.slots.iter().all(|s| s.buffered.is_none());
        self.buffered == 0 && slots && self.attributes.is_empty()
    }

    /// Marks the buffers as written.
    fn settle(&mut self) {
        for dataset in &mut self.grown {
            dataset.buffered = Vec::new();
        }
        for slot in &mut self.slots {
            let length = slot.buffered.take().map_or(0, |b| b.len() as u64);
            slot.size = slot.size.max(length);
        }
        self.attributes.clear();
        self.buffered = 0;
    }

    fn write_into(&self, file: &H5File) -> hdf5::Result<()> {
        for (path, name, value) in &self.attributes {
            group(file, path)?.set_attr_numeric::<i64>(name, value)?;
        }
        for grown in self.grown.iter().filter(|g| !g.buffered.is_empty()) {
            let places = |rows: u64, width: u64| -> Vec<usize> {
                let shape = grown.shape(rows, width);
                shape.iter().map(|n| *n as usize).collect()
            };
            let (first, count) = (grown.written(), grown.rows - grown.written());
            let dataset = file.dataset_writer(grown.name())?;
            dataset.extend(&places(grown.rows, grown.width))?;
            dataset.write_slice(
                &places(first, 0),
                &places(count, grown.width),
                &grown.buffered,
            )?;
        }
        for slot in &self.slots {
            let Some(bytes) = &slot.buffered else {
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
        self.check_still_owned()?;
        named(name, std::fs::rename(&self.part, name))
    }

    /// Closes the file with all appended and stored data; it is synced to disk on return.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn close(mut self) -> Result<(), ResultsError> {
        self.check_still_owned()?;
        if let Some(mut growth) = self.growth.take() {
            let rows = growth.write(&mut self.grown);
            let slots = self.slots.iter_mut().try_for_each(|slot| {
                let buffered = slot.buffered.take();
                let write = |b: Vec<u8>| {
                    growth.write_slot(slot.path.trim_start_matches('/'), &mut slot.size, &b)
                };
                buffered.map_or(Ok(()), write)
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
        // A file dropped without `close` keeps the written data, and no errors are printed to the
        // terminal.
        if let Some(file) = self.draft.take() {
            let _ = file.close_no_sync();
        }
    }
}

/// A rename is durable once the folder is synced, which not every system supports.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if let Ok(folder) = std::fs::File::open(folder.unwrap_or(Path::new("."))) {
        let _ = folder.sync_all();
    }
}

/// Writes a small file whose `/VTKHDF` links to a group of another file beside it.
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
