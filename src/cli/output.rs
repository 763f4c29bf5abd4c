//! Output to the standard streams. A closed or full terminal, pipe or file never ends a run; only an
//! explicitly requested answer that cannot be delivered is a failure. Terminal control characters are
//! removed, since titles and names come from the user, and documentation of laws comes from plugins.

use super::Failure;
use crate::scene::source::{clean_json, clean_lines};
use std::io::{ErrorKind, Write};

/// Writes the requested answer to standard output. A closed pipe is not an error.
///
/// # Errors
/// It cannot be written.
pub fn answer(text: &str) -> Result<(), Failure> {
    delivered(write(&mut std::io::stdout().lock(), &clean_lines(text)))
}

/// Writes the requested answer as JSON to standard output.
///
/// # Errors
/// It cannot be written.
pub fn answer_json(text: &str) -> Result<(), Failure> {
    delivered(write(&mut std::io::stdout().lock(), &clean_json(text)))
}

/// Converts the result of writing an answer.
///
/// # Errors
/// It could not be written, for a reason other than a closed pipe.
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
    let _ = write(&mut std::io::stdout().lock(), &clean_lines(text));
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
