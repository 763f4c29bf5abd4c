//! Lock on a study's folder: one study at a time, and only in a folder that belongs to studies.

use super::TradeError;
use std::fs::{File, TryLockError};
use std::path::Path;

/// Marker file of a folder of studies.
const MARK: &str = "trade.lock";

/// Creates or opens a study's folder and locks it until the returned file is dropped; the system releases the lock when
/// the process ends.
///
/// # Errors
/// Another study runs in it, it holds other files, or it cannot be written.
pub fn take(out: &Path) -> Result<File, TradeError> {
    let fail = |e: &dyn std::fmt::Display| TradeError::write(out, e);
    let ours = || {
        [MARK, "plan.json", "trade.json"]
            .iter()
            .any(|f| out.join(f).is_file())
    };
    let full = std::fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some());
    if full && !ours() {
        return Err(TradeError::Usage(format!(
            "{} is not empty and holds no study of fretwork trade; give a new or empty folder with --out",
            out.display()
        )));
    }
    std::fs::create_dir_all(out).map_err(|e| fail(&e))?;
    let path = out.join(MARK);
    let file = File::options()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(|e| TradeError::write(&path, &e))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(TradeError::Usage(format!(
            "another fretwork trade is running in {}; wait for its end, or give another folder with --out",
            out.display()
        ))),
        // Continue without a lock on file systems that have none.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_a_second_study_and_a_strangers_folder() {
        let out = std::env::temp_dir().join(format!("fretwork-lock-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&out);
        let first = take(&out).unwrap();
        let said = take(&out).unwrap_err().to_string();
        assert!(said.contains("another fretwork trade is running"), "{said}");
        drop(first);
        drop(take(&out).unwrap());
        std::fs::remove_file(out.join(MARK)).unwrap();
        std::fs::write(out.join("thesis.txt"), "mine").unwrap();
        let said = take(&out).unwrap_err().to_string();
        assert!(said.contains("holds no study"), "{said}");
        std::fs::remove_dir_all(&out).unwrap();
    }
}
