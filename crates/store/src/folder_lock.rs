//! Lock on a folder: one writer at a time, and no reader of what is half written.

use crate::write_advice;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The file by which a run owns the folder of its results.
pub const RUN_LOCK: &str = "results.lock";

/// Why a folder cannot be owned or read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LockError {
    /// Somebody else owns it.
    #[error("another run is writing in {}; wait for its end, or name another folder", folder.display())]
    Held {
        /// The folder.
        folder: PathBuf,
    },
    /// The file that is locked cannot be made.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

/// A lock on a folder, until it and its clones are dropped; the system releases it when the process ends, however it ends.
#[derive(Clone, Debug)]
pub struct FolderLock {
    /// None on file systems without locks, where there is no protection.
    _file: Option<Arc<File>>,
}

impl FolderLock {
    /// Owns a folder that exists, by a file in it that is left there.
    ///
    /// # Errors
    /// Somebody owns it or reads it, or the file cannot be made.
    pub fn own(folder: &Path, mark: &str) -> Result<Self, LockError> {
        let path = folder.join(mark);
        let file = File::options().create(true).append(true).open(&path);
        let file = file.map_err(|e| LockError::Write {
            path,
            reason: e.to_string(),
        })?;
        held(folder, file.try_lock())?;
        Ok(Self {
            _file: Some(Arc::new(file)),
        })
    }

    /// Reads a folder along with other readers: nobody owns it meanwhile.
    ///
    /// # Errors
    /// Somebody owns it.
    pub fn read(folder: &Path, mark: &str) -> Result<Self, LockError> {
        // Without the file, or the right to read it, nobody of this user writes there.
        let file = File::open(folder.join(mark)).ok();
        if let Some(file) = &file {
            held(folder, file.try_lock_shared())?;
        }
        Ok(Self {
            _file: file.map(Arc::new),
        })
    }
}

/// Whether somebody else holds a lock. File systems that have none refuse differently, and let everybody in.
fn held(folder: &Path, locked: Result<(), TryLockError>) -> Result<(), LockError> {
    match locked {
        Err(TryLockError::WouldBlock) => Err(LockError::Held {
            folder: folder.to_owned(),
        }),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_owner_or_many_readers() {
        let folder = std::env::temp_dir().join(format!("fretwork-owner-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let read = || FolderLock::read(&folder, "a.lock");
        let own = || FolderLock::own(&folder, "a.lock");
        // Nobody was ever here.
        drop(read().unwrap());
        let owner = own().unwrap();
        for refused in [own(), read()] {
            let said = refused.unwrap_err().to_string();
            assert!(said.contains("another run is writing in"), "{said}");
        }
        drop(owner);
        let readers = [read().unwrap(), read().unwrap()];
        assert!(own().is_err());
        drop(readers);
        own().unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
