//! A file that grows in place, by HDF5's single-writer multiple-reader protocol: rows first, then what finds them, then how
//! many they are, so that it can be read at any moment.
//!
//! The crate syncs after each dataset of a flush: some 200 times for a file of results. So this is for files that are too
//! large to be copied.

use super::dataset::Grown;
use hdf5::FileLocking;
use hdf5::swmr::SwmrFileWriter;
use std::path::Path;

/// The writer of such a file; none once it is closed.
pub(super) struct Growth(Option<SwmrFileWriter>);

impl Growth {
    /// Takes up a file that was closed.
    pub fn begin(path: &Path) -> hdf5::Result<Self> {
        let mut writer = SwmrFileWriter::open_append_with_locking(path, FileLocking::BestEffort)?;
        writer.start_swmr()?;
        Ok(Self(Some(writer)))
    }

    fn writer(&mut self) -> hdf5::Result<&mut SwmrFileWriter> {
        let closed = || hdf5::Hdf5Error::InvalidState("the file is closed".to_owned());
        self.0.as_mut().ok_or_else(closed)
    }

    fn index(&mut self, name: &str) -> hdf5::Result<usize> {
        let index = self.writer()?.dataset_index(name);
        index.ok_or_else(|| hdf5::Hdf5Error::NotFound(name.to_owned()))
    }

    /// Hands rows that are kept in memory to the system. Readers see them after the next [`Growth::flush`].
    pub fn write(&mut self, grown: &mut [Grown]) -> hdf5::Result<()> {
        for dataset in grown.iter_mut().filter(|g| !g.held.is_empty()) {
            let index = self.index(dataset.name())?;
            let (first, count) = (dataset.written(), dataset.rows - dataset.written());
            let held = std::mem::take(&mut dataset.held);
            let bytes: Vec<u8> = held.iter().flat_map(|x| x.to_le_bytes()).collect();
            let writer = self.writer()?;
            writer.set_extent(index, &dataset.shape(dataset.rows, dataset.width))?;
            let place = dataset.shape(first, 0);
            writer.write_slice(index, &place, &dataset.shape(count, dataset.width), &bytes)?;
        }
        Ok(())
    }

    /// Makes what was written visible and safe.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.writer()?.flush()
    }

    /// Writes over bytes of which the file has room for so many, its first `seal` last.
    pub fn write_over(
        &mut self,
        name: &str,
        size: &mut u64,
        bytes: &[u8],
        seal: usize,
    ) -> hdf5::Result<()> {
        let (head, body) = bytes.split_at(seal);
        let mut open = vec![0; seal];
        open.extend_from_slice(body);
        self.write_slot(name, size, &open)?;
        self.flush()?;
        // A flush would go through all datasets again: whoever calls syncs the file.
        let index = self.index(name)?;
        self.writer()?
            .write_slice(index, &[0], &[seal as u64], head)
    }

    /// Writes over bytes of which the file has room for so many.
    pub fn write_slot(&mut self, name: &str, size: &mut u64, bytes: &[u8]) -> hdf5::Result<()> {
        let index = self.index(name)?;
        let length = bytes.len() as u64;
        let writer = self.writer()?;
        if length > *size {
            writer.set_extent(index, &[length])?;
            *size = length;
        }
        writer.write_slice(index, &[0], &[length], bytes)
    }

    /// An attribute of a group; in the file when it is closed.
    pub fn count(&mut self, group: &str, name: &str, value: i64) -> hdf5::Result<()> {
        self.writer()?
            .set_group_attr_numeric::<i64>(group, name, &value)
    }

    /// Ends the file.
    pub fn close(mut self) -> hdf5::Result<()> {
        self.0.take().map_or(Ok(()), SwmrFileWriter::close)
    }
}

impl Drop for Growth {
    fn drop(&mut self) {
        // One that is dropped says on the terminal what went wrong; that was said before.
        if let Some(writer) = self.0.take() {
            let _ = writer.close();
        }
    }
}
