//! The program of this process: its file, and how its command line is started.
//!
//! Both are those of the executable, unless a process that loads this code as a library, such as a
//! Python interpreter, declares others first.
//!
//! ```standalone_crate
//! use fretwork_core::program::{self, Program};
//!
//! assert_eq!(program::file()?, std::env::current_exe()?);
//! let command = ["python3", "-m", "fretwork"].map(Into::into).to_vec();
//! program::declare(Program { file: "_fretwork.so".into(), command });
//! // The first declaration counts.
//! program::declare(Program { file: "other.so".into(), command: Vec::new() });
//! assert_eq!(program::file()?.to_str(), Some("_fretwork.so"));
//! let command = program::command()?;
//! assert_eq!(command.get_program(), "python3");
//! assert_eq!(command.get_args().collect::<Vec<_>>(), ["-m", "fretwork"]);
//! # Ok::<(), std::io::Error>(())
//! ```

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

static DECLARED: OnceLock<Program> = OnceLock::new();

/// A program in place of the executable of the process.
#[derive(Clone, Debug)]
pub struct Program {
    /// File with this code: its SHA-256 identifies the built-in laws, and shipped libraries are
    /// searched in its folder.
    pub file: PathBuf,
    /// Program and arguments that start the command line; empty if there is none.
    pub command: Vec<OsString>,
}

/// Declares the program of this process. Only the first declaration counts.
pub fn declare(program: Program) {
    let _ = DECLARED.set(program);
}

/// Returns the file with this code.
///
/// # Errors
/// The system does not tell the path of the executable.
pub fn file() -> std::io::Result<PathBuf> {
    match DECLARED.get() {
        Some(program) => Ok(program.file.clone()),
        None => std::env::current_exe(),
    }
}

/// Returns a command that starts the command line, without further arguments.
///
/// # Errors
/// The system does not provide the path of the executable, or a declared program has no command
/// line.
pub fn command() -> std::io::Result<Command> {
    let Some(program) = DECLARED.get() else {
        return Ok(Command::new(std::env::current_exe()?));
    };
    let Some((first, rest)) = program.command.split_first() else {
        let why = "this process has no command line of Fretwork to call";
        return Err(std::io::Error::new(std::io::ErrorKind::Unsupported, why));
    };
    let mut command = Command::new(first);
    command.args(rest);
    Ok(command)
}
