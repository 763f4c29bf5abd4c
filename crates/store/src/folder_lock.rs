//! Lock on a folder: one writer at a time, and no readers while it writes.

use crate::write_advice;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Name of the file by which a run owns the folder of its results.
pub const RUN_LOCK: &str = "results.lock";

/// Reason why a folder cannot be owned or read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LockError {
    /// Another process owns the folder.
    #[error("another run is writing in {}; wait for its end, or name another folder", folder.display())]
    Held {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder is no longer the one that was owned.
    #[error(
        "the folder {}, or {lock_file} in it, was removed or replaced while the run wrote into it; nothing more is written there: run it again, \
         or resume it where the folder is now, and leave the folder of a run in its place until its end",
        folder.display()
    )]
    Lost {
        /// The folder.
        folder: PathBuf,
        /// Name of the file by which the folder was owned.
        lock_file: String,
    },
    /// The lock file cannot be created.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

/// A lock on a folder. It is held until it and its clones are dropped; the system releases it when
/// the process ends, even by a crash.
#[derive(Clone, Debug)]
pub struct FolderLock {
    /// The locked file, kept open; `None` for a reader that found no file to lock.
    _file: Option<Arc<File>>,
    /// The file by which the folder is owned, and its number when it was locked. `None` for a
    /// reader, and on systems without file numbers.
    owned: Option<(PathBuf, FileId)>,
}

/// Device and number of a file, which stay the same when the file is renamed.
type FileId = (u64, u64);

#[cfg(unix)]
fn file_id(data: &std::fs::Metadata) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt;
    Some((data.dev(), data.ino()))
}

#[cfg(not(unix))]
fn file_id(_: &std::fs::Metadata) -> Option<FileId> {
    None
}

impl FolderLock {
    /// Owns an existing folder by an exclusive lock on a file in it, which is created if necessary
    /// and left there.
    ///
    /// # Errors
    /// Another process owns or reads the folder, or the file cannot be created.
    pub fn exclusive(folder: &Path, lock_file: &str) -> Result<Self, LockError> {
        let path = folder.join(lock_file);
        let file = File::options().create(true).append(true).open(&path);
        let file = file.map_err(|e| LockError::Write {
            path: path.clone(),
            reason: e.to_string(),
        })?;
        refuse_if_locked(folder, retry(|| file.try_lock()))?;
        let by_handle = file.metadata().ok().and_then(|data| file_id(&data));
        let by_name = std::fs::metadata(&path)
            .ok()
            .and_then(|data| file_id(&data));
        // On some systems the number of a file differs between two queries.
        let owned = by_handle.filter(|_| by_handle == by_name);
        Ok(Self {
            _file: Some(Arc::new(file)),
            owned: owned.map(|id| (path, id)),
        })
    }

    /// Checks that the folder is still the one that was owned, before a file is written in it by
    /// name.
    ///
    /// # Errors
    /// The folder, or the file by which it is owned, was removed, moved or replaced.
    pub fn check_still_owned(&self) -> Result<(), LockError> {
        let Some((path, at)) = &self.owned else {
            return Ok(());
        };
        let now = match std::fs::metadata(path) {
            Ok(data) => file_id(&data),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => None,
            // A folder that cannot be read is reported when it is written to.
            Err(_) => return Ok(()),
        };
        if now == Some(*at) {
            return Ok(());
        }
        let lock_file = path.file_name().unwrap_or_default();
        Err(LockError::Lost {
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            lock_file: lock_file.to_string_lossy().into_owned(),
        })
    }

    /// Locks a folder for reading. Other readers may lock it too, but nobody can own it meanwhile.
    ///
    /// # Errors
    /// Another process owns the folder.
    pub fn shared(folder: &Path, lock_file: &str) -> Result<Self, LockError> {
        // Without the file no run has written in the folder. A file that this user must not read
        // cannot be locked, and the folder is then read without protection.
        let file = File::open(folder.join(lock_file)).ok();
        if let Some(file) = &file {
            refuse_if_locked(folder, retry(|| file.try_lock_shared()))?;
        }
        Ok(Self {
            _file: file.map(Arc::new),
            owned: None,
        })
    }
}

/// Tries a lock repeatedly for a tenth of a second. A process that this program has just started
/// holds copies of its open files, and thereby a released lock, until it executes its own program.
fn retry(lock: impl Fn() -> Result<(), TryLockError>) -> Result<(), TryLockError> {
    for _ in 0..10 {
        match lock() {
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
            other => return other,
        }
    }
    lock()
}

/// Returns an error if another process holds the lock. Other errors come from file systems without
/// locks, where there is no protection, and are ignored.
fn refuse_if_locked(folder: &Path, locked: Result<(), TryLockError>) -> Result<(), LockError> {
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
        let read = || FolderLock::shared(&folder, "a.lock");
        let own = || FolderLock::exclusive(&folder, "a.lock");
        // No run ever wrote in the folder.
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

    #[test]
    #[cfg(unix)]
    fn a_folder_that_is_removed_moved_or_replaced_is_lost() {
        let folder = std::env::temp_dir().join(format!("fretwork-lost-{}", std::process::id()));
        let other = folder.with_extension("moved");
        let own = || {
            std::fs::create_dir_all(&folder).unwrap();
            FolderLock::exclusive(&folder, "a.lock").unwrap()
        };
        let lost = |owner: &FolderLock| {
            let said = owner.check_still_owned().unwrap_err().to_string();
            assert!(said.contains("removed or replaced"), "{said}");
        };
        let owner = own();
        owner.check_still_owned().unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        lost(&owner);
        // Another folder takes its name.
        let second = own();
        lost(&owner);
        second.check_still_owned().unwrap();
        std::fs::rename(&folder, &other).unwrap();
        lost(&second);
        std::fs::rename(&other, &folder).unwrap();
        second.check_still_owned().unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
