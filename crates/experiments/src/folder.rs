//! Folders of experiments: one command at a time may use a folder, and only a folder that belongs
//! to such commands.

use crate::Error;
use fretwork_store::folder_lock::{FolderLock, LockError};
use std::path::Path;

/// A command that owns folders, and the names of its files.
#[derive(Clone, Copy, Debug)]
pub struct Owner {
    /// The command, `fretwork trade`.
    pub command: &'static str,
    /// Name of the file that is locked.
    pub lock_file: &'static str,
    /// Other files by which its folders are recognised.
    pub files: &'static [&'static str],
}

impl Owner {
    /// Creates or opens a folder and locks it until the returned lock is dropped.
    ///
    /// # Errors
    /// The command already runs in the folder, the folder contains other files, or it cannot be
    /// written.
    pub fn take(&self, out: &Path) -> Result<FolderLock, Error> {
        let fail = |e: &dyn std::fmt::Display| Error::write(out, e);
        let ours = || {
            let mut known = [self.lock_file]
                .into_iter()
                .chain(self.files.iter().copied());
            known.any(|f| out.join(f).is_file())
        };
        let full = std::fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some());
        if full && !ours() {
            return Err(Error::Usage(format!(
                "{} is not empty and holds no study of {}; give a new or empty folder with --out",
                out.display(),
                self.command
            )));
        }
        std::fs::create_dir_all(out).map_err(|e| fail(&e))?;
        FolderLock::exclusive(out, self.lock_file).map_err(|e| match e {
            LockError::Held { .. } => Error::Usage(format!(
                "another {} is running in {}; wait for its end, or give another folder with --out",
                self.command,
                out.display()
            )),
            LockError::Write { path, reason } => Error::write(&path, &reason),
            lost @ LockError::Lost { .. } => Error::Usage(lost.to_string()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_a_second_study_and_a_folder_of_something_else() {
        const OWNER: Owner = Owner {
            command: "fretwork trade",
            lock_file: "trade.lock",
            files: &["plan.json"],
        };
        let out = std::env::temp_dir().join(format!("fretwork-lock-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&out);
        let first = OWNER.take(&out).unwrap();
        let message = OWNER.take(&out).unwrap_err().to_string();
        assert!(
            message.contains("another fretwork trade is running"),
            "{message}"
        );
        drop(first);
        drop(OWNER.take(&out).unwrap());
        std::fs::remove_file(out.join(OWNER.lock_file)).unwrap();
        std::fs::write(out.join("thesis.txt"), "mine").unwrap();
        let message = OWNER.take(&out).unwrap_err().to_string();
        assert!(message.contains("holds no study"), "{message}");
        std::fs::remove_dir_all(&out).unwrap();
    }
}
