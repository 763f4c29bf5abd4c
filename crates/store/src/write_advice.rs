//! Advice about a file that cannot be written.

use std::io::{Error, ErrorKind};

/// Returns the end of a sentence that reports an error of the system: what to do about its cause.
/// It is empty if the cause is not known.
pub fn write_advice(reason: &str) -> &'static str {
    // Intermediate layers put the system's error into their own text, in which its number remains.
    let number = reason.rsplit_once("(os error ").map(|(_, rest)| rest);
    let number = number.and_then(|rest| rest.split_once(')'));
    let Some(Ok(number)) = number.map(|(n, _)| n.parse()) else {
        return "";
    };
    match Error::from_raw_os_error(number).kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "; make room on the disk, or choose another folder with --out"
        }
        ErrorKind::FileTooLarge => {
            "; files may not be larger here: raise the limit (ulimit -f), or record less (`output`)"
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you may write to with --out"
        }
        ErrorKind::NotFound => {
            "; a folder of its path is missing, or was removed: name another with --out"
        }
        ErrorKind::NotADirectory | ErrorKind::IsADirectory | ErrorKind::AlreadyExists => {
            "; something else of that name is there: choose another folder with --out"
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn every_cause_has_its_own_advice() {
        let said =
            |number: i32| write_advice(&format!("I/O error: {}", Error::from_raw_os_error(number)));
        assert!(said(28).contains("make room"), "ENOSPC");
        assert!(said(27).contains("ulimit -f"), "EFBIG");
        assert!(said(13).contains("may write to"), "EACCES");
        assert!(said(2).contains("missing"), "ENOENT");
        assert_eq!(said(5), "", "EIO");
        assert_eq!(write_advice("the name is too long"), "");
    }
}
