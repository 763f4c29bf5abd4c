//! Reads checkpoints and rows of a stopped run from its `results.h5`.

use super::dataset::GrowthRecord;
use super::store::{ResultsError, Store};
use super::{CHECKPOINTS, Results};
use crate::fclib::guard;
use hdf5::{H5File, H5Type};
use std::path::{Path, PathBuf};

/// Rows copied at a time.
const BLOCK: usize = 1 << 16;

/// Results file of a stopped run.
pub struct PreviousResults {
    path: PathBuf,
    file: H5File,
    names: Vec<String>,
}

impl std::fmt::Debug for PreviousResults {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PreviousResults")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl PreviousResults {
    /// Opens the file.
    ///
    /// # Errors
    /// A description of what is wrong with the file.
    pub fn open(path: &Path) -> Result<Self, String> {
        match std::fs::metadata(path) {
            Ok(data) if data.is_file() => {}
            Ok(_) => return Err("it is not a file".to_owned()),
            Err(e) => return Err(e.to_string()),
        }
        let file = guard(|| H5File::options().best_effort_locking().open(path))
            .map_err(|e| format!("it is not a file of results, or damaged ({e})"))?;
        let names = guard(|| Ok(file.dataset_names()))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            names,
        })
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the bytes of its checkpoints, intact or not. A slot that was never written is empty;
    /// there are none if they cannot be read.
    ///
    /// # Errors
    /// The file has no checkpoints: it was written by an older version, or it is not a results
    /// file.
    pub fn checkpoints(&self) -> Result<[Option<Vec<u8>>; 2], String> {
        let names = CHECKPOINTS.map(|name| name.trim_start_matches('/'));
        if !names
            .iter()
            .all(|name| self.names.iter().any(|n| n == name))
        {
            return Err(
                "it has no checkpoints: it was written by an older version, or is not a `results.h5` of `fretwork run`"
                    .to_owned(),
            );
        }
        let length = std::fs::metadata(&self.path).map_or(0, |m| m.len());
        Ok(names.map(|name| {
            let rows = self.shape(name).ok()?[0];
            // The declared size is not trusted: no more is allocated than the file can hold.
            if rows as u64 > length {
                return None;
            }
            if rows == 0 {
                return Some(Vec::new());
            }
            guard(|| self.file.dataset(name)?.read_slice::<u8>(&[0], &[rows])).ok()
        }))
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>, String> {
        let shape = guard(|| Ok(self.file.dataset(name)?.shape()))?;
        match shape.len() {
            1 | 2 => Ok(shape),
            n => Err(format!("`{name}` has {n} axes")),
        }
    }

    /// Copies the given number of rows of each growing dataset to a store with the same datasets,
    /// and checks their CRC-32.
    ///
    /// # Errors
    /// The store cannot be written, or the rows are missing or differ.
    pub(super) fn copy(&self, rows: &[(u64, u32)], to: &mut Store) -> Result<(), ResultsError> {
        let grown: Vec<GrowthRecord> = to.grown().to_vec();
        let unreadable = |reason: String| ResultsError::unreadable(&self.path, reason);
        if rows.len() != grown.len() {
            return Err(unreadable(
                "it has other columns than its case gives".to_owned(),
            ));
        }
        for (place, (grown, (rows, sum))) in grown.iter().zip(rows).enumerate() {
            let name = grown.name();
            let shape = self.shape(name).map_err(unreadable)?;
            let width = shape.get(1).copied().unwrap_or(1);
            let rows = usize::try_from(*rows).unwrap_or(usize::MAX);
            if shape[0] < rows || width as u64 != grown.width {
                return Err(unreadable(format!(
                    "`{name}` has {} rows of {width}, and the checkpoint is after {rows} of {}",
                    shape[0], grown.width
                )));
            }
            for first in (0..rows).step_by(BLOCK) {
                let count = BLOCK.min(rows - first);
                let bytes = if grown.whole {
                    let values = self.slice::<i64>(name, first, count, shape.get(1));
                    values.map(|v| v.iter().flat_map(|x| x.to_le_bytes()).collect())
                } else {
                    let values = self.slice::<f64>(name, first, count, shape.get(1));
                    values.map(|v| v.iter().flat_map(|x| x.to_le_bytes()).collect())
                };
                let bytes: Vec<u8> = bytes.map_err(unreadable)?;
                to.append_bytes(place, &bytes)?;
            }
            // Data beyond the end of a truncated file reads as zeros.
            if to.grown()[place].sum != *sum {
                return Err(unreadable(format!(
                    "the rows of `{name}` are not those that were written: the file was cut short or changed"
                )));
            }
        }
        Ok(())
    }

    /// Whether a row of the statistics was recorded.
    pub fn has_rows(&self) -> bool {
        let mut columns = self.names.iter().filter(|n| n.starts_with("statistics/"));
        columns.any(|name| self.shape(name).is_ok_and(|shape| shape[0] > 0))
    }

    /// Reads the rows of the statistics, column by column.
    ///
    /// # Errors
    /// The rows are missing.
    pub fn statistics(&self, names: &[String], rows: usize) -> Result<Vec<Vec<f64>>, ResultsError> {
        let column = |name: &String| self.slice(&format!("statistics/{name}"), 0, rows, None);
        let columns: Result<Vec<_>, _> = names.iter().map(column).collect();
        columns.map_err(|reason| ResultsError::unreadable(&self.path, reason))
    }

    fn slice<T: H5Type>(
        &self,
        name: &str,
        first: usize,
        count: usize,
        width: Option<&usize>,
    ) -> Result<Vec<T>, String> {
        if count == 0 {
            return Ok(Vec::new());
        }
        guard(|| {
            let dataset = self.file.dataset(name)?;
            match width {
                None => dataset.read_slice::<T>(&[first], &[count]),
                Some(width) => dataset.read_slice::<T>(&[first, 0], &[count, *width]),
            }
        })
    }
}

impl Results {
    /// Copies the given rows of a stopped run, those up to its checkpoint, and continues the views
    /// and meshes after them. Does nothing if no results are written.
    ///
    /// # Errors
    /// The file cannot be written, or the rows are missing.
    pub fn take_over(
        &mut self,
        from: &PreviousResults,
        rows: &[(u64, u32)],
    ) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        from.copy(rows, store)?;
        for view in &mut self.views {
            view.resume(store);
        }
        if let Some(shapes) = &mut self.shapes {
            shapes.resume(store);
        }
        for mesh in &mut self.meshes {
            mesh.resume(store);
        }
        Ok(())
    }
}
