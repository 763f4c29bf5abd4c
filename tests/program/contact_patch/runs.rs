//! Runs that give the friction coefficient of a patch, compared with it.

use super::{WHEEL, patch};
use crate::temp::TempFolder;
use std::path::Path;
use std::process::Command;

/// A ball that slides on a plane, in a window of 1 mm under the pressure of the middle of the
/// patch, by as much as a point slips while it passes the patch.
const WINDOW: &str = r#"(
    name: "window",
    dimension: 2,
    seed: 1,
    time: (step: 1e-3, end: 0.1, theta: 1.0),
    periodic: (x: 1e-3),
    detection: (alert: 1e-5),
    materials: {"rail": "rail_steel_r260", "wheel": "wheel_steel_er7"},
    interfaces: [(name: "contact", between: ("rail", "wheel"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [
        (name: "rail", material: "rail", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "wheel",
            material: "wheel",
            shapes: [Balls([([0.0, 0.0], 1e-4)])],
            position: [0.0, 1e-4],
            mass: 1e6,
            dofs: (
                x: Displacement(Ramp(from: 0.0, to: 6.2e-5, start: 0.02, end: 0.1)),
                y: Force(Constant(-1.12e6)),
                rz: Fixed,
            ),
        ),
    ],
    friction: (body: "wheel", along: 0, normal: 1, start: 0.02),
    output: (frames: 0, views: 1),
)"#;

/// Runs the window in a folder, with changes.
fn run(folder: &Path, out: &str, sets: &[&str]) -> String {
    let case = folder.join("window.ron");
    std::fs::write(&case, WINDOW).unwrap();
    let out = folder.join(out);
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("run")
        .arg(&case)
        .arg("--out")
        .arg(&out)
        .args(sets.iter().flat_map(|set| ["--set", set]))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    out.to_str().unwrap().to_owned()
}

/// Runs give their friction to a patch of their steels, pressure and slip; what differs is refused,
/// or accepted by name and then said.
#[test]
fn runs_are_compared_with_each_other_and_with_the_patch() {
    let folder = TempFolder::new("patch-runs");
    let [one, seed, other] = [
        ("1", &[][..]),
        ("2", &["seed=2"]),
        ("3", &["interfaces.0.parameters.contact.mu=0.31"]),
    ]
    .map(|(out, sets)| run(&folder, out, sets));
    let rolls = |creepage: &'static str| [&WHEEL[..], &["--creepage", creepage]].concat();
    let with = |of: Vec<&'static str>, runs: &[&str], more: &[&str]| {
        let runs = runs.iter().flat_map(|r| ["--friction-of", r]);
        let all: Vec<&str> = of
            .into_iter()
            .chain(runs)
            .chain(more.iter().copied())
            .collect();
        let output = patch(&all);
        let text = [output.stdout, output.stderr].concat();
        (output.status.code(), String::from_utf8(text).unwrap())
    };
    let half = || rolls("0.5%");
    let (code, text) = with(half(), &[&one], &[]);
    assert_eq!(code, Some(0), "{text}");
    for words in ["from 1 run", "1.120 GPa in the mean", "one way", "ONE RUN"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    for again in [&one, &seed] {
        let (code, text) = with(half(), &[&one, again], &[]);
        let once = text.contains("COUNTED ONCE") && text.contains("from 1 run");
        assert!(code == Some(0) && once, "{text}");
    }
    let mut hard = half();
    hard[7] = "wheel_steel_er7,rail_steel_r350ht";
    let mut light = half();
    light[1] = "20kN";
    let fretting = [&WHEEL[..], &["--displacement", "100um"]].concat();
    for (of, runs, what, words) in [
        (
            half(),
            &[&one, &other][..],
            "inputs",
            "`interfaces.contact.parameters.contact",
        ),
        (
            hard,
            &[&one],
            "materials",
            "those of the patch of rail_steel_r350ht and wheel",
        ),
        (
            light,
            &[&one],
            "pressure,drive",
            "is under 1.120 GPa, the patch under",
        ),
        (
            rolls("1%"),
            &[&one],
            "drive",
            "slips one way by 62.00 um, the patch",
        ),
        (fretting, &[&one], "drive", "the patch to and fro"),
    ] {
        let runs: Vec<&str> = runs.iter().map(|r| r.as_str()).collect();
        let (code, text) = with(of.clone(), &runs, &[]);
        assert_eq!(code, Some(2), "{what}: {text}");
        assert!(
            text.contains(words) && text.contains("--accept "),
            "{what}: {text}"
        );
        let (code, text) = with(of, &runs, &["--accept", what]);
        assert_eq!(code, Some(0), "{what}: {text}");
        let said = text.contains("INPUTS DIFFER") || text.contains("OTHER ");
        assert!(said, "{what}: {text}");
    }
    let (code, text) = with(half(), &[&one], &["--accept", "everything"]);
    assert!(code == Some(2) && text.contains("untrusted"), "{text}");
    // A run that is not trustworthy, and one whose case is not known.
    let summary = Path::new(&one).join("summary.json");
    let changed = std::fs::read_to_string(&summary).unwrap();
    let changed = changed
        .replace(r#""trustworthy": true"#, r#""trustworthy": false"#)
        .replace(
            r#""reasons": []"#,
            r#""reasons": ["NOT CONVERGED: of a test"]"#,
        );
    std::fs::write(&summary, changed).unwrap();
    std::fs::remove_file(Path::new(&one).join("results.h5")).unwrap();
    let (code, text) = with(half(), &[&one], &[]);
    assert_eq!(code, Some(2), "{text}");
    for words in [
        "NOT CONVERGED: of a test",
        "no results.h5",
        "--accept untrusted,materials,pressure",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let (code, text) = with(
        half(),
        &[&one],
        &["--accept", "untrusted,materials,pressure"],
    );
    assert!(code == Some(0) && text.contains("NOT TRUSTED"), "{text}");
}
