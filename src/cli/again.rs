//! Reconstruction of the command line of this call, to be printed for the user to repeat.

use crate::experiments::shell;
use crate::record::checkpoint::Occupied;
use std::ffi::OsString;
use std::path::Path;
use std::sync::OnceLock;

/// Words of this call, beginning with the name of the program.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Stores the words of this call.
pub(super) fn keep(words: &[OsString]) {
    let _ = WORDS.set(words.to_vec());
}

/// Two options of which a call may have one.
const EITHER: [&str; 2] = ["--resume", "--force"];

/// Returns the arguments of this call, quoted for a shell, with those of `with` appended if they
/// are missing; an option that excludes one of `with` is left out.
pub(super) fn command(with: &[&str]) -> String {
    let words = WORDS.get().map_or(&[][..], Vec::as_slice).iter();
    let mut words: Vec<String> = words.map(|w| w.to_string_lossy().into_owned()).collect();
    if with.iter().any(|w| EITHER.contains(w)) {
        words.retain(|w| !EITHER.contains(&w.as_str()));
    }
    for word in with {
        if !words.iter().any(|w| w == word) {
            words.push((*word).to_owned());
        }
    }
    shell::command(&words)
}

/// Returns what a folder, as the user names it, holds that this call would replace, and the
/// commands to go on with it, to write elsewhere and to replace it.
pub(super) fn instead(found: &Occupied, folder: &Path) -> String {
    let name = folder.display();
    let mut text = format!("{name} holds {}; nothing was changed", found.what);
    let mut offer = |what: &str, command: String| text += &format!("\n  {what:<20} {command}");
    if found.continues {
        offer("to go on from there:", command(&["--resume"]));
    }
    let mut names = (2..).map(|k| format!("{name}-{k}"));
    if let Some(other) = names.find(|other| !Path::new(other).exists()) {
        offer("to write elsewhere:", command_into(&other));
    }
    offer("to replace it:", command(&["--force"]));
    text
}

/// Returns the arguments of this call with another folder of results.
fn command_into(folder: &str) -> String {
    let words = WORDS.get().map_or(&[][..], Vec::as_slice).iter();
    let mut out: Vec<String> = Vec::new();
    let mut value = false;
    for word in words.map(|w| w.to_string_lossy().into_owned()) {
        let option = word == "--out";
        if !(option || value || word.starts_with("--out=")) {
            out.push(word);
        }
        value = option;
    }
    out.extend(["--out".to_owned(), folder.to_owned()]);
    shell::command(&out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_is_what_was_called() {
        let call = ["fretwork", "run", "a case.ron", "--json"];
        let call = [&call[..], &["--out", "there"]].concat();
        keep(&call.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(
            command(&["--resume"]),
            "fretwork run 'a case.ron' --json --out there --resume"
        );
        assert_eq!(
            command(&["--json"]),
            "fretwork run 'a case.ron' --json --out there"
        );
        let found = |continues| Occupied {
            folder: "/there".into(),
            what: "this run, which is not at its end".to_owned(),
            continues,
        };
        let said = instead(&found(true), Path::new("there"));
        let lines: Vec<&str> = said.lines().map(str::trim).collect();
        assert_eq!(
            lines,
            [
                "there holds this run, which is not at its end; nothing was changed",
                "to go on from there: fretwork run 'a case.ron' --json --out there --resume",
                "to write elsewhere:  fretwork run 'a case.ron' --json --out there-2",
                "to replace it:       fretwork run 'a case.ron' --json --out there --force",
            ]
        );
        assert_eq!(
            instead(&found(false), Path::new("there")).lines().count(),
            3
        );
    }
}
