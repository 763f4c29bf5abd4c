//! In-place growth of a file by HDF5's single-writer multiple-reader protocol: first the rows are
//! written, then their index, then their number, so that the file can be read at any time.
//!
//! The HDF5 crate syncs the file after each dataset of a flush, about 200 times for a results file.
//! In-place growth is therefore used only for files too large to be copied.

use super::dataset::{GrowthRecord, to_bytes};
use hdf5::FileLocking;
use hdf5::swmr::SwmrFileWriter;
use std::path::Path;

/// Writer of a file that grows in place; `None` once it is closed.
pub(super) struct Growth(Option<SwmrFileWriter>);

impl Growth {
    /// Opens a closed file for in-place growth.
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

    /// Writes rows to the file without a sync. Readers see them after the next [`Growth::flush`].
    pub fn write(&mut self, grown: &mut [GrowthRecord]) -> hdf5::Result<()> {
        for dataset in grown.iter_mut().filter(|g| !g.buffered.is_empty()) {
            let index = self.index(dataset.name())?;
            let (first, count) = (dataset.written(), dataset.rows - dataset.written());
            let buffered = std::mem::take(&mut dataset.buffered);
            let bytes = to_bytes(&buffered, u64::to_le_bytes);
            let writer = self.writer()?;
            writer.set_extent(index, &dataset.shape(dataset.rows, dataset.width))?;
            let place = dataset.shape(first, 0);
            writer.write_slice(index, &place, &dataset.shape(count, dataset.width), &bytes)?;
        }
        Ok(())
    }

    /// Makes written rows visible to readers and syncs them to disk.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.writer()?.flush()
    }

    /// Overwrites bytes within the allocated capacity, the first `seal` of them last.
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
        // A flush would sync all datasets again; the caller syncs the file once.
        let index = self.index(name)?;
        self.writer()?
            .write_slice(index, &[0], &[seal as u64], head)
    }

    /// Overwrites bytes within the allocated capacity.
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

    /// Sets an attribute of a group, written when the file is closed.
    pub fn count(&mut self, group: &str, name: &str, value: i64) -> hdf5::Result<()> {
        self.writer()?
            .set_group_attr_numeric::<i64>(group, name, &value)
    }

    /// Closes the file.
    pub fn close(mut self) -> hdf5::Result<()> {
        self.0.take().map_or(Ok(()), SwmrFileWriter::close)
    }
}

impl Drop for Growth {
    fn drop(&mut self) {
        // Dropping the writer would print an error that was already reported.
        if let Some(writer) = self.0.take() {
            let _ = writer.close();
        }
    }
}
