//! `fretwork study` through the program: runs that are made and not made again, tables recomputed
//! from the files of the runs, units of work of other engines, results compared with closed forms,
//! and invalid input.

mod compared;
mod engines;
mod kept;
mod law_table;
mod refusals;
mod said;
mod shipped;

use crate::temp::TempFolder;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A heap that collapses; its sizes come from the seed.
const HEAP: &str = r#"(
    name: "a small heap", dimension: 2, seed: 3, time: (step: 5e-4, end: 0.05), gravity: [0.0, -9.81],
    solver: (tolerance: 1e-3, max_iterations: 5000),
    materials: {"glass": "bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [(name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])])],
    grains: [Lattice(material: "glass", count: 24, radius: (0.003, 0.006), low: [0.0, 0.0], high: [0.06, 0.2])],
)"#;

const BEAD: &str = r#"(doc: "a bead", density: (value: 2500.0, unit: "kg/m^3", source: "a test"))"#;

const MU: &str = "interfaces.all.parameters.contact.mu";

/// A folder of a test with the heap and its material, removed at its end.
struct Folder(TempFolder);

impl Folder {
    fn new(name: &str) -> Self {
        let path = TempFolder::new(&format!("study-{name}"));
        std::fs::create_dir_all(path.join("materials")).unwrap();
        let folder = Self(path);
        folder.put("heap.ron", HEAP);
        folder.put("materials/bead.ron", BEAD);
        folder
    }

    fn put(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).unwrap();
    }

    /// Writes a study of the heap.
    fn study(&self, factors: &str, more: &str) {
        self.put(
            "study.ron",
            &format!(
                r#"(case: "heap.ron", factors: [{factors}], outputs: ["energy.friction"], {more})"#
            ),
        );
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        command.current_dir(&self.0).arg("study").args(words);
        command
    }

    fn call(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    /// Runs the study; returns its answer as JSON.
    fn run(&self) -> Value {
        self.answer(&["run", "study.ron", "--out", "out", "--jobs", "2", "--json"])
    }

    fn answer(&self, words: &[&str]) -> Value {
        let output = self.call(words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {said}"))
    }

    /// Folders of runs that ended.
    fn runs(&self) -> Vec<PathBuf> {
        let all = std::fs::read_dir(self.0.join("out/runs"))
            .into_iter()
            .flatten()
            .flatten();
        let mut all: Vec<PathBuf> = all
            .map(|e| e.path())
            .filter(|p| p.join("run.json").is_file())
            .collect();
        all.sort();
        all
    }
}

fn values<'a>(study: &'a Value, column: &str) -> &'a Vec<Value> {
    let found = study["columns"][column]["values"].as_array();
    found.unwrap_or_else(|| panic!("no column {column}"))
}

fn numbers(study: &Value, column: &str) -> Vec<f64> {
    values(study, column)
        .iter()
        .map(|v| v.as_f64().unwrap_or(f64::NAN))
        .collect()
}

fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap()
}

fn mu(values: &str) -> String {
    format!(r#"Values(name: "friction", key: "{MU}", values: [{values}])"#)
}
