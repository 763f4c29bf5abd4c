//! `fretwork trade` through the program: errors compared with a closed form, statistics recomputed
//! from the files of the runs, the frontier by its definition, resuming, the budget, interruption,
//! and invalid input.

mod accuracy;
mod budget;
mod deformability;
mod errors;
mod refusals;
mod scatter;

use crate::temp::TempFolder;
use serde_json::Value;
use std::process::{Command, Output};

/// A MAC bond (C = 1e12 N/m3, w = 0.1 J/m2, b = 0) opened from 0 to 10 u0, u0 = sqrt(w/C). Beyond
/// u0 beta = (u0/u)^2, and damage releases w (1 - beta) A = 0.1 (1 - 1/100) A. A = 0.5 m2/m is the
/// effective radius of two disks of 1 m, times the unit depth.
pub const BOND: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/cases/verification/bond_mode_1.ron"
);
pub const RELEASED: f64 = 0.1 * 0.99 * 0.5;

/// A heap that collapses; its sizes come from the seed.
pub const HEAP: &str = r#"(
    name: "a small heap",
    dimension: 2,
    seed: 3,
    time: (step: 5e-4, end: 0.05),
    gravity: [0.0, -9.81],
    solver: (tolerance: 1e-3, max_iterations: 5000),
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [(name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])])],
    grains: [Lattice(material: "glass", count: 24, radius: (0.003, 0.006), low: [0.0, 0.0], high: [0.06, 0.2])],
)"#;

/// A folder of a test, removed at its end.
pub struct Folder(pub TempFolder);

impl Folder {
    pub fn new(name: &str) -> Self {
        Self(TempFolder::new(&format!("trade-{name}")))
    }

    pub fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap_or_else(|e| panic!("{e}"));
        path.display().to_string()
    }

    pub fn out(&self) -> String {
        self.0.join("out").display().to_string()
    }
}

pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.arg("trade").args(arguments);
    command
}

pub fn call(arguments: &[&str]) -> Output {
    command(arguments)
        .output()
        .unwrap_or_else(|e| panic!("{e}"))
}

pub fn study(arguments: &[&str]) -> Value {
    let output = call(&[arguments, &["--json"]].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}"))
}

pub fn settings(study: &Value) -> Vec<Value> {
    study["settings"].as_array().cloned().unwrap_or_default()
}

pub fn number(value: &Value, path: &str) -> f64 {
    let found = value.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no {path} in {value}"))
}

/// Value of `key=` in the `--set` arguments of a setting.
pub fn set_to(setting: &Value, key: &str) -> Option<f64> {
    let sets = setting["sets"].as_array()?;
    let texts = sets.iter().filter_map(Value::as_str);
    texts
        .filter_map(|t| t.strip_prefix(key)?.strip_prefix('=')?.parse().ok())
        .next()
}

/// Compares the flags of the frontier with its definition.
pub fn frontier_is_what_nothing_dominates(study: &Value, output: &str) {
    let all = settings(study);
    let point = |s: &Value| {
        let error = s.pointer(&format!("/outputs/{output}/at_most_with_reference"));
        // If the reference's own error is unknown, it is exact by definition.
        let unknown = if s["reference"] == true {
            0.0
        } else {
            f64::INFINITY
        };
        let error = error.and_then(Value::as_f64).unwrap_or(unknown);
        let failed = !s["failed"].is_null();
        (
            number(s, "/seconds"),
            if failed { f64::INFINITY } else { error },
        )
    };
    let mut on = 0;
    for s in &all {
        let (cost, error) = point(s);
        let beaten = all
            .iter()
            .map(&point)
            .any(|(c, e)| c <= cost && e <= error && (c < cost || e < error));
        let flag = s
            .pointer(&format!("/outputs/{output}/frontier"))
            .and_then(Value::as_bool);
        assert_eq!(flag.unwrap_or(false), error.is_finite() && !beaten, "{s}");
        on += usize::from(flag == Some(true));
    }
    assert!(on > 0);
}
