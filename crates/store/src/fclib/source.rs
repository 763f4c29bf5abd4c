//! Reading access to an HDF5 file. In this module only this file and `target.rs` use the HDF5
//! crate.

use super::FclibError;
use hdf5::{DatatypeMessage, H5Dataset, H5File, StorageLayout};
use std::cell::Cell;
use std::collections::HashSet;
use std::io::{Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Once;

/// An open file.
pub struct Source {
    file: H5File,
    datasets: HashSet<String>,
    path: PathBuf,
    /// Limit on the size of a dataset, in bytes.
    most: usize,
}

impl Source {
    /// Opens a file and lists its datasets.
    ///
    /// # Errors
    /// The file is missing, not HDF5, or damaged.
    pub fn open(path: &Path) -> Result<Self, FclibError> {
        let length = signed(path)?;
        let damaged = |reason| FclibError::Damaged {
            path: path.to_owned(),
            place: "the file's structure".to_owned(),
            reason,
        };
        match promised(path) {
            Some(bytes) if bytes > length => {
                let reason = format!("it promises {bytes} bytes and has {length}");
                return Err(damaged(reason));
            }
            _ => {}
        }
        let (file, datasets) = guard(|| {
            let file = H5File::options().best_effort_locking().open(path)?;
            let names = file.dataset_names();
            Ok((file, names))
        })
        .map_err(damaged)?;
        Ok(Self {
            file,
            datasets: datasets.into_iter().collect(),
            path: path.to_owned(),
            // Unwritten data takes no space in the file and reads as zeros, so a dataset may be
            // longer than the file; the pointers of a matrix take half the space of a vector.
            most: usize::try_from(length).unwrap_or(usize::MAX / 8) * 4 + (1 << 16),
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a group exists, given by its path from the root.
    pub fn has_group(&self, name: &str) -> bool {
        guard(|| {
            let mut group = self.file.root_group();
            for part in name.trim_matches('/').split('/') {
                group = group.group(part)?;
            }
            Ok(())
        })
        .is_ok()
    }

    /// Whether a dataset exists.
    pub fn has(&self, name: &str) -> bool {
        self.datasets.contains(name.trim_start_matches('/'))
    }

    /// Reads a scalar integer.
    ///
    /// # Errors
    /// The dataset is missing, damaged, not an integer or not a scalar.
    pub fn integer(&self, name: &str) -> Result<i64, FclibError> {
        match self.integers(name)?[..] {
            [one] => Ok(one),
            ref many => {
                let reason = format!("holds {} numbers where one is expected", many.len());
                Err(FclibError::wrong(&self.path, name, reason))
            }
        }
    }

    /// Reads integers of any width.
    ///
    /// # Errors
    /// The dataset is missing, damaged or of another type.
    pub fn integers(&self, name: &str) -> Result<Vec<i64>, FclibError> {
        let dataset = self.dataset(name, "whole numbers", |t| {
            matches!(t, DatatypeMessage::FixedPoint { .. })
        })?;
        guard(|| dataset.read_numeric_as::<i64>()).map_err(|e| self.damaged(name, e))
    }

    /// Reads finite real numbers.
    ///
    /// # Errors
    /// The dataset is missing, damaged, of another type, or has a value that is not finite.
    pub fn reals(&self, name: &str) -> Result<Vec<f64>, FclibError> {
        let dataset = self.dataset(name, "real numbers", |t| {
            matches!(t, DatatypeMessage::FloatingPoint { .. })
        })?;
        let values =
            guard(|| dataset.read_numeric_as::<f64>()).map_err(|e| self.damaged(name, e))?;
        match values.iter().position(|x| !x.is_finite()) {
            None => Ok(values),
            Some(k) => Err(FclibError::wrong(
                &self.path,
                name,
                format!(
                    "value {k} (counted from 0) is {}; every value must be finite",
                    values[k]
                ),
            )),
        }
    }

    /// Reads an optional text; an unreadable one is treated as absent, since nothing depends on it.
    pub fn text(&self, name: &str) -> Option<String> {
        let is_text = |t: &DatatypeMessage| {
            matches!(
                t,
                DatatypeMessage::FixedString { .. } | DatatypeMessage::VarLenString { .. }
            )
        };
        let dataset = self.dataset(name, "text", is_text).ok()?;
        let texts = guard(|| dataset.read_strings_lossy()).ok()?;
        // Control characters of an untrusted file must not reach a terminal.
        let clean = |t: &str| {
            t.chars()
                .filter(|c| !c.is_control() || *c == '\n')
                .collect()
        };
        texts.first().map(|t| clean(t))
    }

    fn dataset(
        &self,
        name: &str,
        kind: &str,
        is_kind: impl Fn(&DatatypeMessage) -> bool,
    ) -> Result<H5Dataset, FclibError> {
        if !self.has(name) {
            return Err(FclibError::missing(
                &self.path,
                name,
                "the layout requires it",
            ));
        }
        let (dataset, datatype, layout) = guard(|| {
            let dataset = self.file.dataset(name.trim_start_matches('/'))?;
            let datatype = dataset.datatype()?;
            let outside = !dataset.external_files()?.is_empty();
            let layout = (!outside).then_some(dataset.storage_layout()?);
            Ok((dataset, datatype, layout))
        })
        .map_err(|e| self.damaged(name, e))?;
        if !is_kind(&datatype) {
            let reason = format!("its type is not that of {kind}");
            return Err(FclibError::wrong(&self.path, name, reason));
        }
        if !matches!(
            layout,
            Some(StorageLayout::Compact | StorageLayout::Contiguous)
        ) {
            return Err(FclibError::Unsupported {
                path: self.path.clone(),
                place: name.to_owned(),
                reason: "it is stored in chunks, compressed or in another file, while FCLIB requires one contiguous \
                         block; `h5repack -l CONTI -f NONE IN OUT` makes it so"
                    .to_owned(),
            });
        }
        // The declared size is not trusted: no more is allocated than the file can hold.
        let bytes = dataset
            .shape()
            .iter()
            .try_fold(dataset.element_size(), |p, d| p.checked_mul(*d));
        match bytes {
            Some(bytes) if bytes <= self.most => Ok(dataset),
            _ => Err(self.damaged(
                name,
                "it claims to be larger than the whole file".to_owned(),
            )),
        }
    }

    fn damaged(&self, place: &str, reason: String) -> FclibError {
        FclibError::Damaged {
            path: self.path.clone(),
            place: place.to_owned(),
            reason,
        }
    }
}

/// Length of a file that has the HDF5 signature at one of its allowed positions.
fn signed(path: &Path) -> Result<u64, FclibError> {
    let unreadable = |e: std::io::Error| FclibError::Unreadable {
        path: path.to_owned(),
        reason: e.to_string(),
    };
    // Opening a pipe would block.
    if !std::fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(unreadable(std::io::Error::other("it is not a file")));
    }
    let mut file = std::fs::File::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    let mut at = 0;
    while at < length {
        let mut start = [0u8; 8];
        file.seek(SeekFrom::Start(at)).map_err(unreadable)?;
        if file.read_exact(&mut start).is_ok() && start == *b"\x89HDF\r\n\x1a\n" {
            return Ok(length);
        }
        at = if at == 0 { 512 } else { at * 2 };
    }
    Err(FclibError::NotHdf5 {
        path: path.to_owned(),
    })
}

/// File length according to the superblock at the start of a file. The HDF5 crate does not compare
/// it with the actual length, and reads what remains of a truncated file.
fn promised(path: &Path) -> Option<u64> {
    let mut start = [0u8; 64];
    std::fs::File::open(path)
        .ok()?
        .read_exact(&mut start)
        .ok()?;
    let at = match (start[8], &start[..4]) {
        (_, other) if other != b"\x89HDF" => return None,
        // The sizes of addresses precede it; only 8-byte addresses are checked.
        (0, _) if start[13] == 8 => 40,
        (1, _) if start[13] == 8 => 44,
        (2 | 3, _) if start[9] == 8 => 28,
        _ => return None,
    };
    let bytes = start[at..at + 8].try_into().ok()?;
    Some(u64::from_le_bytes(bytes))
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Calls the HDF5 crate and converts a panic, which damaged bytes can cause in it, to an error. The
/// panic hook is wrapped once and suppresses messages only on a thread inside such a call, so that
/// other panics are reported as usual.
pub fn guard<T>(call: impl FnOnce() -> hdf5::Result<T>) -> Result<T, String> {
    static WRAPPED: Once = Once::new();
    WRAPPED.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !QUIET.get() {
                usual(info);
            }
        }));
    });
    let before = QUIET.replace(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    QUIET.set(before);
    match result {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(e)) => Err(e.to_string()),
        Err(_) => Err("its bytes contradict each other".to_owned()),
    }
}
