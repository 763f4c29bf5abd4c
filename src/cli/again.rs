//! Reconstruction of the command line of this call, to be printed for the user to repeat.

use crate::experiments::shell;
use std::ffi::OsString;
use std::sync::OnceLock;

/// Words of this call, beginning with the name of the program.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Stores the words of this call.
pub(super) fn keep(words: &[OsString]) {
    let _ = WORDS.set(words.to_vec());
}

/// Returns the arguments of this call, quoted for a shell, with those of `with` appended if they
/// are missing.
pub(super) fn command(with: &[&str]) -> String {
    let words = WORDS.get().map_or(&[][..], Vec::as_slice).iter();
    let mut words: Vec<String> = words.map(|w| w.to_string_lossy().into_owned()).collect();
    for word in with {
        if !words.iter().any(|w| w == word) {
            words.push((*word).to_owned());
        }
    }
    shell::command(&words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_is_what_was_called() {
        keep(&["fretwork", "run", "a case.ron", "--json"].map(OsString::from));
        assert_eq!(
            command(&["--resume"]),
            "fretwork run 'a case.ron' --json --resume"
        );
        assert_eq!(command(&["--json"]), "fretwork run 'a case.ron' --json");
    }
}
