//! `fretwork patch` with windows of a third body.

use crate::temp::TempFolder;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// A block of 0.3 on springs of 10 TPa (N/m per metre of depth) in a period of 0.1 m: a layer of a
/// compliance of 1e-14 m/Pa.
const WINDOW: &str = r#"(
    name: "a block on springs", dimension: 2, time: (step: 1e-4, end: 0.1), periodic: (x: 0.1),
    solver: (norm: Power, tolerance: 1e-6, max_iterations: 5000),
    detection: (alert: 1e-4, skin: 1e-3),
    materials: {"steel": "rail_steel_r260"},
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "linear-contact",
        parameters: (contact: {"stiffness": 6.25e12, "ratio": 0.8, "restitution": 0.1, "mu": 0.3}))],
    bodies: [
        (name: "floor", material: "steel", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "block", material: "steel", position: [0.0, 0.01], mass: 1e4, shapes: [Balls([([0.0, 0.0], 0.01), ([0.05, 0.0], 0.01)])],
            dofs: (x: Displacement(Ramp(from: 0.0, to: 1e-4, start: 0.02, end: 0.1)), y: Force(Table([(0.0, -1e5), (0.015, -1e8)])), rz: Fixed)),
    ],
    friction: (body: "block", start: 0.02),
    output: (every: 1, frames: 0),
)"#;

fn wheel(friction: &str, rest: &str) -> String {
    format!(
        r#"(
            name: "a wheel", materials: {{"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"}},
            bodies: ((material: "wheel", radius: 0.46 m), (material: "rail", across: 0.3 m)),
            interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "coulomb", parameters: (contact: {{"mu": {friction}}}))],
            load: 75 kN, cells: 32, {rest}
            motion: Rolling(along: [0.05 %, 0.2 %]),
        )"#
    )
}

const WINDOWS: &str = r#"third_body: (case: "window.ron", strips: 2, seeds: 2),"#;

fn patch(folder: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(folder)
        .args(["patch", "wheel.ron", "--out", "out", "--jobs", "2"])
        .args(more)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    let [out, err] = [&output.stdout, &output.stderr].map(|s| String::from_utf8_lossy(s));
    assert_eq!(output.status.code(), Some(0), "{out}{err}");
    format!("{out}{err}")
}

fn answered(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("out/patch.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn adhesions(of: &Value) -> Vec<f64> {
    let points = of["points"].as_array().unwrap().iter();
    points.map(|p| p["adhesion"].as_f64().unwrap()).collect()
}

/// Windows that are a slider on springs give the patch of Coulomb's law with an elastic layer of
/// their compliance, whatever the law of the file; runs that are there are not made again.
#[test]
fn windows_on_springs_are_coulombs_law_with_a_layer() {
    let folder = TempFolder::new("patch-windows");
    std::fs::write(folder.join("window.ron"), WINDOW).unwrap();
    std::fs::write(folder.join("wheel.ron"), wheel("0.4", WINDOWS)).unwrap();
    let waits = said(&patch(&folder, &["--prepare"]));
    assert!(
        waits.contains("8 runs are missing") && waits.contains("windows_1.ron"),
        "{waits}"
    );
    let made = said(&patch(&folder, &[]));
    assert!(made.contains("settled after"), "{made}");
    let found = answered(&folder);
    let again = said(&patch(&folder, &[]));
    assert!(!again.contains("are to be made"), "{again}");
    assert_eq!(adhesions(&answered(&folder)), adhesions(&found));
    let windows = &found["third_body"];
    let compliance = windows["compliance"].as_f64().unwrap();
    assert!((compliance / 1e-14 - 1.0).abs() < 0.25, "{windows}");
    let layer = "layer: (thickness: 0.8 mm, shear_modulus: 80 GPa),";
    std::fs::write(folder.join("wheel.ron"), wheel("0.3", layer)).unwrap();
    said(&patch(&folder, &[]));
    let expected = adhesions(&answered(&folder));
    for (found, expected) in adhesions(&found).iter().zip(&expected) {
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{found} {expected} {windows}"
        );
    }
}

#[test]
fn what_windows_cannot_follow_is_refused() {
    let folder = TempFolder::new("patch-windows-refused");
    let good = wheel("0.3", WINDOWS);
    for (patch_text, window, says) in [
        (
            good.replace("along: [0.05 %, 0.2 %]", "along: 0.1 %, spin: 0.1"),
            WINDOW.to_owned(),
            "slip along the rolling",
        ),
        (
            good.replace("seeds: 2", "seeds: 1"),
            WINDOW.to_owned(),
            "two seeds or more",
        ),
        (
            good.clone(),
            WINDOW.replace("friction: (body: \"block\", start: 0.02),", ""),
            "give it `friction`",
        ),
        (
            good.clone(),
            WINDOW.replace("periodic: (x: 0.1),", ""),
            "give it a period",
        ),
        (
            good.clone(),
            WINDOW.replace(
                "Force(Table([(0.0, -1e5), (0.015, -1e8)]))",
                "Velocity(-1e-5)",
            ),
            "is no `Force`",
        ),
        (
            good.replace(
                "load: 75 kN",
                "load: 75 kN, members: [(contact: {\"mu\": 0.2})]",
            ),
            WINDOW.to_owned(),
            "leave `members` out",
        ),
    ] {
        std::fs::write(folder.join("window.ron"), window).unwrap();
        std::fs::write(folder.join("wheel.ron"), patch_text).unwrap();
        let output = patch(&folder, &[]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains(says), "{says}: {text}");
    }
}
