//! Output to the standard streams. A closed or full terminal, pipe or file never ends a run; only
//! an explicitly requested answer that cannot be delivered is a failure. Terminal control
//! characters are removed, since titles and names come from the user, and documentation of laws
//! comes from plugins.

use super::Failure;
use crate::scene::source::{clean_json, clean_lines};
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, OnceLock};

/// Standard output of the program, once [`keep_from_laws`] has taken it.
static TAKEN: OnceLock<Mutex<File>> = OnceLock::new();

/// Reserves standard output for the program's answers: from then on what laws print goes to
/// standard error. On systems without this redirection (Windows) both go to standard output.
pub fn keep_from_laws() {
    #[cfg(unix)]
    {
        use std::os::fd::{AsFd, AsRawFd};
        let (out, err) = (std::io::stdout(), std::io::stderr());
        let _ = out.lock().flush();
        let Ok(own) = out.as_fd().try_clone_to_owned() else {
            return;
        };
        if TAKEN.set(Mutex::new(File::from(own))).is_ok() {
            // SAFETY: both descriptors are open; the first becomes a duplicate of the second.
            unsafe { libc::dup2(err.as_raw_fd(), out.as_raw_fd()) };
        }
    }
}

/// Writes a line to the standard output of the program.
fn write_out(text: &str) -> std::io::Result<()> {
    match TAKEN.get() {
        Some(own) => write(&mut *own.lock().unwrap_or_else(|e| e.into_inner()), text),
        None => write(&mut std::io::stdout().lock(), text),
    }
}

/// Writes the requested answer to standard output. A closed pipe is not an error.
///
/// # Errors
/// The answer cannot be written.
pub fn answer(text: &str) -> Result<(), Failure> {
    delivered(write_out(&clean_lines(text)))
}

/// Writes the requested answer as JSON to standard output.
///
/// # Errors
/// The answer cannot be written.
pub fn answer_json(text: &str) -> Result<(), Failure> {
    delivered(write_out(&clean_json(text)))
}

/// Writes bytes of a protocol to standard output.
///
/// # Errors
/// They cannot be written.
pub fn send(bytes: &[u8]) -> Result<(), Failure> {
    let all = |to: &mut dyn Write| to.write_all(bytes).and_then(|()| to.flush());
    delivered(match TAKEN.get() {
        Some(own) => all(&mut *own.lock().unwrap_or_else(|e| e.into_inner())),
        None => all(&mut std::io::stdout().lock()),
    })
}

/// Converts the result of writing an answer.
///
/// # Errors
/// The answer could not be written, for a reason other than a closed pipe.
pub fn delivered(written: std::io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Failure::Failed(format!(
            "cannot write the answer to standard output: {e}"
        ))),
        _ => Ok(()),
    }
}

/// Writes information to standard output, ignoring failures.
pub fn inform(text: &str) {
    let _ = write_out(&clean_lines(text));
}

/// Writes progress, a warning or an error to standard error, ignoring failures.
pub fn report(text: &str) {
    let _ = write(&mut std::io::stderr().lock(), &clean_lines(text));
}

/// Writes a text with terminal colours to standard error, ignoring failures.
pub fn report_rendered(text: &str) {
    let _ = write(&mut std::io::stderr().lock(), text);
}

fn write(to: &mut dyn Write, text: &str) -> std::io::Result<()> {
    writeln!(to, "{text}")?;
    to.flush()
}
