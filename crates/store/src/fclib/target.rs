//! Writing access to an HDF5 file, for the few data types of FCLIB.
//!
//! The file is written under a temporary name and renamed when complete, so that the final name
//! never refers to a partial file.

use super::FclibError;
use super::source::guard;
use hdf5::{DatatypeMessage, H5File, H5Group};
use std::path::{Path, PathBuf};

/// A file being written.
pub struct Target {
    file: H5File,
    path: PathBuf,
    part: PathBuf,
}

impl Target {
    /// Creates a temporary file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path) -> Result<Self, FclibError> {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        let part = path.with_file_name(name);
        let file = guard(|| H5File::create(&part)).map_err(|e| unwritable(path, e))?;
        Ok(Self {
            file,
            path: path.to_owned(),
            part,
        })
    }

    /// Creates a group in an existing group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn group(&self, name: &str) -> Result<(), FclibError> {
        self.in_parent(name, |parent, own| parent.create_group(own).map(drop))
    }

    /// Writes a scalar: a 32-bit integer in an array of length 1.
    ///
    /// # Errors
    /// The value does not fit into 32 bits, or the file cannot be written.
    pub fn integer(&self, name: &str, value: i64) -> Result<(), FclibError> {
        self.integers(name, [value])
    }

    /// Writes 32-bit integers.
    ///
    /// # Errors
    /// A value does not fit into 32 bits, or the file cannot be written.
    pub fn integers(
        &self,
        name: &str,
        values: impl IntoIterator<Item = i64>,
    ) -> Result<(), FclibError> {
        let narrow: Result<Vec<i32>, _> = values.into_iter().map(i32::try_from).collect();
        let narrow = narrow.map_err(|_| {
            let reason = format!("{name} does not fit into the 32-bit integers of FCLIB");
            unwritable(&self.path, reason)
        })?;
        self.array(name, &narrow)
    }

    /// Writes 64-bit real numbers.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn reals(&self, name: &str, values: &[f64]) -> Result<(), FclibError> {
        self.array(name, values)
    }

    /// Writes a text: null-terminated ASCII, rank 0; other characters become question marks.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn text(&self, name: &str, text: &str) -> Result<(), FclibError> {
        let ascii = |c: char| {
            if c.is_ascii() && c != '\0' {
                c as u8
            } else {
                b'?'
            }
        };
        let mut bytes: Vec<u8> = text.chars().map(ascii).collect();
        bytes.push(0);
        self.in_parent(name, |parent, own| {
            let datatype = DatatypeMessage::fixed_string(bytes.len() as u32);
            let dataset = parent.new_dataset::<u8>().datatype(datatype).scalar();
            dataset.create(own)?.write_raw_bytes(&bytes)
        })
    }

    /// Completes the file and renames it to its final name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn close(self) -> Result<(), FclibError> {
        let Self { file, path, part } = self;
        let done = guard(|| file.close())
            .and_then(|()| std::fs::rename(&part, &path).map_err(|e| e.to_string()));
        done.map_err(|e| {
            std::fs::remove_file(&part).ok();
            unwritable(&path, e)
        })
    }

    /// Removes the temporary file.
    pub fn discard(self) {
        drop(self.file);
        std::fs::remove_file(&self.part).ok();
    }

    fn array<T: hdf5::H5Type>(&self, name: &str, values: &[T]) -> Result<(), FclibError> {
        self.in_parent(name, |parent, own| {
            let dataset = parent
                .new_dataset::<T>()
                .shape([values.len()])
                .create(own)?;
            if values.is_empty() {
                return Ok(());
            }
            dataset.write_raw(values)
        })
    }

    /// Calls the HDF5 crate with the parent group of a name and the last part of the name.
    fn in_parent<T>(
        &self,
        name: &str,
        call: impl FnOnce(H5Group, &str) -> hdf5::Result<T>,
    ) -> Result<T, FclibError> {
        let name = name.trim_matches('/');
        let (parents, own) = name.rsplit_once('/').unwrap_or(("", name));
        guard(|| {
            let root = self.file.root_group();
            match parents {
                "" => call(root, own),
                _ => call(root.group(parents)?, own),
            }
        })
        .map_err(|e| unwritable(&self.path, e))
    }
}

fn unwritable(path: &Path, reason: String) -> FclibError {
    FclibError::Unwritable {
        path: path.to_owned(),
        reason,
    }
}
