//! Cases written back as text are the same cases.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

use fretwork_scene::{LoadedCase, load, load_reader, load_text};
use std::path::{Path, PathBuf};

fn shipped() -> Vec<PathBuf> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")];
    let mut cases = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "ron") {
                cases.push(path);
            }
        }
    }
    cases.sort();
    cases
}

/// Checks that text and value agree: the text is read again, and written again.
fn written(loaded: &LoadedCase) {
    let path = loaded.path.display();
    let text = loaded
        .case
        .to_ron()
        .unwrap_or_else(|e| panic!("{path}: {e}"));
    let folder = loaded.path.parent().unwrap();
    let again = load_text("again.ron", &text, folder, &[]);
    let again = again.unwrap_or_else(|e| panic!("{path}: {e}\n{text}"));
    assert!(again.case == loaded.case, "{path}:\n{text}");
    assert_eq!(again.case.to_ron().unwrap(), text, "{path}");
    // Debug texts differ where signs of zero differ, which `==` does not detect.
    assert_eq!(
        format!("{:?}", again.case),
        format!("{:?}", loaded.case),
        "{path}"
    );
}

#[test]
fn shipped_cases_are_the_same_when_written_and_read_again() {
    let cases = shipped();
    assert!(cases.len() > 80, "{} cases", cases.len());
    let mut read = 0;
    for path in &cases {
        // Scene files of the benchmarks are not cases.
        let Ok(loaded) = load(path, &[]) else {
            let text = std::fs::read_to_string(path).unwrap();
            assert!(
                !text.contains("interfaces:"),
                "{} is not read",
                path.display()
            );
            continue;
        };
        written(&loaded);
        read += 1;
    }
    assert!(read > 75, "{read} cases");
}

#[test]
fn cases_changed_by_sets_are_the_same_when_written_and_read_again() {
    for (case, sets) in [
        (
            "wheel_rail_fretting",
            &[
                "interfaces.third_body.damage=mohr-coulomb-brittle",
                "seed=18446744073709551615",
                "time.step=1.2345678901234567e-7",
                "coupling=Implicit(tolerance: 1e-6, max_iterations: 50)",
                "output.checkpoint=Never",
                "output.window=[0.0, 1.0, -0.0, 1e-300]",
            ][..],
        ),
        (
            "newton_cradle",
            &[
                "name=a \"quoted\" name with \\ and \u{e9}",
                "gravity_drive=Turned(angle: Ramp(from: 0, to: 1, start: 0, end: 1))",
                "solver.method=Anderson",
                "solver.norm=Velocity",
                "phases=[(name: \"shake\", until: AtRest(share: 1e-6, held: 0.01), gravity: [0, 0, -1])]",
            ],
        ),
        (
            "verification/staged_drive",
            &["interfaces.0.parameters.contact.mu=(value: 40, unit: \"%\")"],
        ),
        (
            "verification/moving_zone",
            &["circuit.zones.0.low=[-inf, -inf]"],
        ),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../cases/{case}.ron"));
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        written(&load(&path, &sets).unwrap_or_else(|e| panic!("{case}: {e}")));
    }
}

/// A reader gives the same result as a file with the same text, and errors have the same location
/// and sentence.
#[test]
fn readers_give_the_case_and_the_errors_of_the_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/newton_cradle.ron");
    let folder = path.parent().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let read = load_reader("cradle", bytes.as_slice(), folder, &[]).unwrap();
    assert_eq!(read.case, load(&path, &[]).unwrap().case);
    let wrong = String::from_utf8(bytes)
        .unwrap()
        .replace("interfaces", "interface");
    let error = load_reader("cradle", wrong.as_bytes(), folder, &[])
        .err()
        .unwrap();
    assert!(
        error.position().is_some() && error.to_string().contains("did you mean `interfaces`"),
        "{error}"
    );
    let error = load_reader("cradle", &b"\xff(name"[..], folder, &[])
        .err()
        .unwrap();
    assert!(error.to_string().contains("not UTF-8"), "{error}");
    let error = load_reader("cradle", &b"  \n"[..], folder, &[])
        .err()
        .unwrap();
    assert!(error.to_string().contains("is empty"), "{error}");
}
