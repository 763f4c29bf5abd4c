//! Scenes of tests: cases of the repository, and cases in the text of a test.

#![allow(dead_code, reason = "each test program uses a part of it")]

use crate::temp::TempFolder;
use fretwork::geometry::space::Space;
use fretwork::laws::Plugin;
use fretwork::record::{RunOptions, Summary, run};
use fretwork::scene::{Built, LoadedCase, load, load_text};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::{Path, PathBuf};

/// Returns the file of a case, by its name below `cases`.
pub(crate) fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{name}.ron"))
}

/// Reads a case of the repository, by its name below `cases`, with changes like those of `--set`.
pub(crate) fn loaded(name: &str, sets: &[impl AsRef<str>]) -> LoadedCase {
    let sets: Vec<String> = sets.iter().map(|s| s.as_ref().to_owned()).collect();
    load(&file(name), &sets).unwrap_or_else(|e| panic!("{e}"))
}

/// Writes a table of friction and wear over slip for a law that reads one, and returns the field of
/// an interface that names it; nothing for other laws.
pub(crate) fn tables(plugin: &Plugin, folder: &Path) -> String {
    if plugin.flags & fretwork_abi::FLAG_TABLE == 0 {
        return String::new();
    }
    let file = folder.join("table.csv");
    let rows = ["0, 0.5, 1e-14", "0.01, 0.3, 2e-14", "1, 0.2, 3e-14"].join("\n");
    let text = format!("slip [m], friction, k [1/Pa]\n{rows}\n");
    std::fs::write(&file, text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    format!(
        ", tables: ({}: {:?})",
        plugin.kind,
        file.display().to_string()
    )
}

/// A case in text.
pub(crate) fn loaded_text(text: &str) -> LoadedCase {
    let loaded = load_text("test.ron", text, Path::new("."), &[]);
    loaded.unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Builds the scene of a case, with the declarations of its files.
pub(crate) fn built(loaded: &LoadedCase) -> Built {
    let built = loaded.build(&search_path());
    built.unwrap_or_else(|e| panic!("{e}"))
}

/// The simulation of a case.
pub(crate) fn simulation<S: Space>(loaded: &LoadedCase) -> Simulation<S> {
    let simulation = loaded.build_in(&search_path());
    simulation.unwrap_or_else(|e| panic!("{e}"))
}

/// The scene of a case of the repository, see [`loaded`].
pub(crate) fn case<S: Space>(name: &str, sets: &[&str]) -> Simulation<S> {
    simulation(&loaded(name, sets))
}

/// The scene of a case in text.
pub(crate) fn text<S: Space>(text: &str) -> Simulation<S> {
    simulation(&loaded_text(text))
}

/// Runs a scene to its end in a separate folder, which `look` evaluates and which is then removed.
pub(crate) fn finished(loaded: &LoadedCase, built: Built, look: impl FnOnce(&Path)) -> Summary {
    let out = TempFolder::new("finished");
    let options = RunOptions {
        out: out.to_owned(),
        threads: 1,
    };
    let summary = run(loaded, built, &options, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
    look(&out);
    summary
}

/// Does as [`finished`] with a case of the repository, without repeated steps.
pub(crate) fn ran(name: &str, sets: &[&str], look: impl FnOnce(&Path)) -> Summary {
    let loaded = loaded(name, &[&["uncertainty.repeats=0"], sets].concat());
    finished(&loaded, built(&loaded), look)
}
