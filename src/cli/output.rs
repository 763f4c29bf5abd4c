//! All that the program writes to its standard streams. A terminal, pipe or file that takes no more never ends a run; only an
//! answer that was asked for and could not be delivered is a failure. Texts are written without what a terminal would take for
//! a command: titles and names are the user's, and documentation of laws that of plugins.

use super::Failure;
use crate::scene::source::{clean_json, clean_lines};
use std::io::{ErrorKind, Write};

/// Writes what the command was asked for to standard output. A reader that went away has what it wanted.
///
/// # Errors
/// It cannot be written.
pub fn answer(text: &str) -> Result<(), Failure> {
    delivered(write(&mut std::io::stdout().lock(), &clean_lines(text)))
}

/// Writes what the command was asked for as JSON to standard output.
///
/// # Errors
/// It cannot be written.
pub fn answer_json(text: &str) -> Result<(), Failure> {
    delivered(write(&mut std::io::stdout().lock(), &clean_json(text)))
}

/// What came of writing an answer.
///
/// # Errors
/// It was not written, and not because its reader went away.
pub fn delivered(written: std::io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Failure::Failed(format!(
            "cannot write the answer to standard output: {e}"
        ))),
        _ => Ok(()),
    }
}

/// Writes what is good to know to standard output, if it can be written.
pub fn inform(text: &str) {
    let _ = write(&mut std::io::stdout().lock(), &clean_lines(text));
}

/// Writes progress, a warning or an error to standard error, if it can be written.
pub fn report(text: &str) {
    let _ = write(&mut std::io::stderr().lock(), &clean_lines(text));
}

/// Writes a text with colours of its own to standard error, if it can be written.
pub fn report_rendered(text: &str) {
    let _ = write(&mut std::io::stderr().lock(), text);
}

fn write(to: &mut dyn Write, text: &str) -> std::io::Result<()> {
    writeln!(to, "{text}")?;
    to.flush()
}
