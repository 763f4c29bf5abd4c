//! Names of outputs that a case does not have, in studies, fits and trades: they are refused before
//! anything runs, with the name that was probably meant and a list of those that there are.

use crate::temp::TempFolder;
use std::process::Command;

const CASE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/cases/verification/falling_debris.ron"
);

/// A measure, of which nothing is known before a run has rows.
const SET: &str = r#"measures=[Slope(name: "front", from: 0.0, to: 4.0)]"#;

const NONE: &str = "a run of this case has no such output";

/// Wrong names, and what is said of each. Bonds and the circuit of the case have results at the end
/// of a run only.
const NAMES: [(&str, &str); 13] = [
    ("circuit.foo", NONE),
    (
        "circuit.flows.sorce.mass",
        "did you mean `circuit.flows.source.mass`?",
    ),
    (
        "circuit.bases.0.grain",
        "did you mean `circuit.bases.0.grains`?",
    ),
    (
        "circuit.bases.grains",
        "did you mean `circuit.bases.0.grains`?",
    ),
    (
        "circuit.bases",
        "it is not a number but a group; name one of its entries, as circuit.bases.NAME",
    ),
    ("circuit.window", "it is not a number but a group"),
    ("fracture", "it is not a number but a group"),
    ("fracture.interfaces", "it is not a number but a group"),
    (
        "fracture.released",
        "did you mean `fracture.interfaces.0.released`?",
    ),
    (
        "fracture.released_over_declare",
        "did you mean `fracture.released_over_declared`?",
    ),
    ("measures.frnt", "did you mean `measures.front`?"),
    ("measures.front_sum", "did you mean `measures.front`?"),
    ("stopped.foo", NONE),
];

/// Calls the program with a file for it, and checks its answer and that there was no run.
fn refused(folder: &TempFolder, words: &[&str], name: &str, said: &str) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command
        .current_dir(folder)
        .args(words)
        .args(["--out", "out"]);
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{words:?} {name}: {text}");
    assert!(text.contains(said), "{words:?} {name}: {text}");
    let listed = text.contains("there are ") && text.contains("energy.kinetic");
    assert!(listed || said.contains("group"), "{words:?} {name}: {text}");
    assert!(!folder.join("out/runs").exists(), "{words:?} {name}");
}

#[test]
fn a_study_refuses_wrong_names() {
    let folder = TempFolder::new("names-study");
    for (name, said) in NAMES {
        let text = format!(
            r##"(case: {CASE:?}, set: [r#"{SET}"#], outputs: ["energy.kinetic", "{name}"],
                factors: [Values(name: "mu", key: "interfaces.joint.parameters.contact.mu", values: [0.1, 0.2])])"##
        );
        std::fs::write(folder.join("study.ron"), text).unwrap();
        refused(&folder, &["study", "run", "study.ron"], name, said);
    }
}

#[test]
fn a_fit_refuses_wrong_names() {
    let folder = TempFolder::new("names-fit");
    for (name, said) in NAMES {
        let text = format!(
            r##"(tests: [Value(name: "one", case: {CASE:?}, set: [r#"{SET}"#], output: "{name}", measured: 1.0, sigma: 0.1)],
                parameters: [(name: "mu", key: "interfaces.joint.parameters.contact.mu", low: 0.1, high: 0.2)])"##
        );
        std::fs::write(folder.join("fit.ron"), text).unwrap();
        refused(&folder, &["fit", "fit.ron"], name, said);
    }
}

#[test]
fn a_trade_refuses_wrong_names() {
    let folder = TempFolder::new("names-trade");
    for (name, said) in NAMES {
        let output = format!("{name}=1%");
        let words = ["trade", CASE, "--set", SET, "--output", &output];
        refused(&folder, &words, name, said);
    }
}
