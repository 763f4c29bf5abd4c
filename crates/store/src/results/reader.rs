//! Reader of datasets of `results.h5`, also of a truncated or growing file.

use crate::fclib::guard;
use hdf5::{DatatypeMessage, H5File, H5Type};
use std::path::Path;

/// A results file open for reading: its datasets by their paths, see [`crate::results`].
///
/// # Examples
/// This example writes a file with one column of statistics and reads it.
/// ```
/// use fretwork_observe::statistics::Column;
/// use fretwork_store::results::{Header, Reader, Results};
///
/// let folder = std::env::temp_dir().join(format!("fretwork-reader-{}", std::process::id()));
/// std::fs::create_dir_all(&folder)?;
/// let path = folder.join("results.h5");
/// let header = Header {
///     dimension: 2,
///     statistics: vec![Column::new("time", "s", "time at the end of the step")],
///     ..Header::default()
/// };
/// let mut results = Results::create(&folder.join("results.h5.part"), &header)?;
/// for step in 1..=3 {
///     results.append_statistics(&[0.5 * f64::from(step)])?;
/// }
/// results.publish(&path)?;
/// results.finish(&folder)?;
///
/// let reader = Reader::open(&path)?;
/// let rows = reader.rows("statistics/time")?;
/// assert_eq!(reader.numbers("statistics/time", (0, rows), 1)?, [0.5, 1.0, 1.5]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Reader {
    file: H5File,
    names: Vec<String>,
    /// Limit on the numbers in one column.
    most: usize,
}

impl Reader {
    /// Opens a results file.
    ///
    /// # Errors
    /// A description of what is wrong with the file.
    pub fn open(path: &Path) -> Result<Self, String> {
        let length = match std::fs::metadata(path) {
            Ok(data) if data.is_file() => data.len(),
            Ok(_) => return Err("it is not a file".to_owned()),
            Err(e) => return Err(e.to_string()),
        };
        let file = guard(|| H5File::options().best_effort_locking().open(path))
            .map_err(|e| format!("it is not a file of results ({e})"))?;
        let names = guard(|| Ok(file.dataset_names()))?;
        // The declared size is not trusted: no more is allocated than the file can hold.
        let bytes = usize::try_from(length).unwrap_or(usize::MAX / 8) * 4 + (1 << 16);
        Ok(Self {
            file,
            names,
            most: bytes / 8,
        })
    }

    /// Whether the file has a dataset of this name.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// Returns the names of all datasets, with their groups.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Whether the file has a dataset in this group or in a subgroup.
    pub fn has_group(&self, name: &str) -> bool {
        let inside = |n: &String| {
            n.strip_prefix(name)
                .is_some_and(|rest| rest.starts_with('/'))
        };
        self.names.iter().any(inside)
    }

    /// Returns the names of the datasets directly in a group, in the order of the file.
    pub fn datasets_in<'a>(&'a self, group: &'a str) -> impl Iterator<Item = &'a str> {
        self.names().filter_map(move |name| {
            let rest = name.strip_prefix(group)?.strip_prefix('/')?;
            (!rest.contains('/')).then_some(rest)
        })
    }

    /// Returns the unit (empty for a pure number) and the description of a dataset, if it has them.
    pub fn described(&self, name: &str) -> (String, String) {
        let text = |attribute: &str| {
            let read = guard(|| self.file.dataset(name)?.attr(attribute)?.read_string());
            read.unwrap_or_default()
        };
        let unit = text("unit");
        (if unit == "1" { String::new() } else { unit }, text("doc"))
    }

    /// Returns the texts of a dataset; empty if there is no such dataset.
    pub fn texts(&self, name: &str) -> Vec<String> {
        if !self.has(name) {
            return Vec::new();
        }
        guard(|| self.file.dataset(name)?.read_strings_lossy()).unwrap_or_default()
    }

    /// A text attribute of the file.
    pub fn attribute(&self, name: &str) -> Option<String> {
        guard(|| self.file.attr_string(name)).ok()
    }

    /// Numbers of a row of a dataset.
    ///
    /// # Errors
    /// The dataset does not exist.
    pub fn width(&self, name: &str) -> Result<usize, String> {
        let shape = guard(|| Ok(self.file.dataset(name)?.shape()))?;
        Ok(shape.get(1).copied().unwrap_or(1))
    }

    /// Reads rows of numbers or of integers, as [`Self::numbers`].
    ///
    /// # Errors
    /// The rows are missing.
    pub fn values(
        &self,
        name: &str,
        rows: (usize, usize),
        width: usize,
    ) -> Result<Vec<f64>, String> {
        let kind = guard(|| self.file.dataset(name)?.datatype())?;
        if matches!(kind, DatatypeMessage::FixedPoint { .. }) {
            let values: Vec<i64> = self.slice(name, rows, width)?;
            return Ok(values.into_iter().map(|v| v as f64).collect());
        }
        self.slice(name, rows, width)
    }

    /// Number of rows of a dataset.
    ///
    /// # Errors
    /// The dataset does not exist.
    pub fn rows(&self, name: &str) -> Result<usize, String> {
        let shape = guard(|| Ok(self.file.dataset(name)?.shape()))?;
        Ok(shape.first().copied().unwrap_or(0))
    }

    /// Reads rows of a dataset with `width` numbers each, as one list.
    ///
    /// # Errors
    /// The rows are missing.
    pub fn numbers(
        &self,
        name: &str,
        (first, count): (usize, usize),
        width: usize,
    ) -> Result<Vec<f64>, String> {
        self.slice(name, (first, count), width)
    }

    /// Reads rows of integers, as [`Self::numbers`].
    ///
    /// # Errors
    /// The rows are missing.
    pub fn whole(&self, name: &str, (first, count): (usize, usize)) -> Result<Vec<i64>, String> {
        self.slice(name, (first, count), 1)
    }

    fn slice<T: H5Type>(
        &self,
        name: &str,
        (first, count): (usize, usize),
        width: usize,
    ) -> Result<Vec<T>, String> {
        let rows = self.rows(name)?;
        if first.checked_add(count).is_none_or(|end| end > rows) || count > self.most / width {
            return Err(format!("`{name}` is cut short: it has {rows} rows"));
        }
        if count == 0 {
            return Ok(Vec::new());
        }
        let values = guard(|| {
            let dataset = self.file.dataset(name)?;
            if dataset.shape().len() == 1 {
                dataset.read_slice::<T>(&[first], &[count])
            } else {
                let width = dataset.shape()[1];
                dataset.read_slice::<T>(&[first, 0], &[count, width])
            }
        })?;
        if values.len() != count * width {
            return Err(format!("`{name}` has another shape than results have"));
        }
        Ok(values)
    }
}
