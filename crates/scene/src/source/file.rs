//! Reading of input files: only regular files of limited size, so that reading never blocks.

use std::fs::{File, Metadata};
use std::io::Read;
use std::path::Path;

use super::InputError;

/// Default limit on the size of a text file, in bytes.
pub const MAX_BYTES: u64 = 64 << 20;

/// Opens a regular file of at most `most` bytes and returns it with its length.
///
/// The file type is checked before opening, since opening a pipe blocks until its other end is
/// opened. A file of length zero is taken as empty and not read: files below `/proc` report no
/// length, and reading some of them (`/proc/kmsg`) blocks.
///
/// # Errors
/// The file is missing, unreadable, a folder, a device, a pipe or a socket, empty, or too large.
pub fn open(path: &Path, most: u64) -> Result<(File, u64), InputError> {
    let unreadable = |error: std::io::Error| InputError::file(path, &error);
    let refused = |message: String| InputError::about(path.display(), message);
    let judge = |data: &Metadata| {
        if data.is_dir() {
            return Err(refused("cannot be read: it is a folder, not a file".into()));
        }
        if !data.is_file() {
            let message = "cannot be read: it is a device, a pipe or a socket, not a regular file";
            return Err(refused(message.into()).help("copy what it gives into a file"));
        }
        if data.len() > most {
            let shown = if most >= 1 << 30 {
                format!("{} GiB", most >> 30)
            } else {
                format!("{} MiB", most >> 20)
            };
            return Err(refused(format!("is larger than {shown}")));
        }
        Ok(data.len())
    };
    judge(&std::fs::metadata(path).map_err(unreadable)?)?;
    let file = File::open(path).map_err(unreadable)?;
    // The type is checked again on the open handle, since the file may have been replaced in
    // between.
    let length = judge(&file.metadata().map_err(unreadable)?)?;
    if length == 0 {
        return Err(empty(path));
    }
    Ok((file, length))
}

fn empty(path: &Path) -> InputError {
    InputError::at(&path.display().to_string(), "", 0..0, "is empty")
}

/// Reads a whole file with the checks of [`open`].
///
/// # Errors
/// Returns the errors of [`open`], or an error if the file grows beyond `most` bytes while it is
/// read.
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, InputError> {
    let (file, length) = open(path, most)?;
    let capacity = usize::try_from(length).unwrap_or(0);
    read_at_most(path, file, most, capacity)
}

fn read_at_most(
    path: &Path,
    from: impl Read,
    most: u64,
    capacity: usize,
) -> Result<Vec<u8>, InputError> {
    let mut bytes = Vec::with_capacity(capacity);
    from.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| InputError::file(path, &error))?;
    if bytes.len() as u64 > most {
        let message = format!("is larger than {} MiB", most >> 20);
        return Err(InputError::about(path.display(), message));
    }
    Ok(bytes)
}

/// Reads a text file.
///
/// # Errors
/// Returns the errors of [`read_bytes`], or an error if the file is not UTF-8 or contains white
/// space only.
pub fn read_text(path: &Path) -> Result<String, InputError> {
    decode(path, read_bytes(path, MAX_BYTES)?)
}

/// Reads a text from a stream, to its end; errors name it by `path`.
///
/// # Errors
/// The text cannot be read, is too long, is not UTF-8, or contains white space only.
pub fn read_text_from(path: &Path, from: &mut dyn Read) -> Result<String, InputError> {
    decode(path, read_at_most(path, from, MAX_BYTES, 0)?)
}

fn decode(path: &Path, bytes: Vec<u8>) -> Result<String, InputError> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
        InputError::at(
            &path.display().to_string(),
            &before,
            valid..valid,
            "is not UTF-8 text",
        )
        .help("save the file as UTF-8")
    })?;
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(empty(path));
    }
    Ok(text)
}
