//! Tables of the law `tabulated` from a study, and the patch that reads them.

use super::Folder;
use serde_json::Value;
use std::process::Command;

/// A block on springs of 1.6 MPa (N/m per metre of depth) in a period of 0.1 m, which is pulled one
/// way by 0.2 mm.
const BLOCK: &str = r#"(
    name: "a block pulled one way", dimension: 2, time: (step: 1e-4, end: 0.25), periodic: (x: 0.1),
    solver: (norm: Power, tolerance: 1e-6, max_iterations: 5000),
    detection: (alert: 1e-4, skin: 1e-3),
    materials: {"glass": "bead"},
    interfaces: [(name: "dry", between: ("glass", "glass"), contact: "linear-contact",
        parameters: (contact: {"stiffness": 1e6, "ratio": 0.8, "restitution": 0.1, "mu": 0.3}))],
    bodies: [
        (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "block", material: "glass", position: [0.0, 0.01], shapes: [Balls([([0.0, 0.0], 0.01), ([0.05, 0.0], 0.01)])],
            dofs: (x: Displacement(Ramp(from: 0.0, to: 2e-4, start: 0.05, end: 0.25)), y: Force(-100.0), rz: Fixed)),
    ],
    friction: (body: "block", start: 0.05),
    output: (every: 1),
)"#;

/// A study of pressure and of the coefficient, which is not known better than from 0.3 to 0.5.
fn study(load: &str, table: &str) -> String {
    format!(
        r#"(
            case: "block.ron",
            set: ["bodies.block.dofs.y=Force(${{{load} * pressure}})"],
            factors: [
                Values(name: "pressure", unit: "Pa", values: [1000.0, 2000.0]),
                Values(name: "mu", key: "interfaces.dry.parameters.contact.mu", values: [0.3, 0.5]),
            ],
            outputs: ["friction_coefficient"],
            table: ({table}),
        )"#
    )
}

/// Friction of the block in the part of its path that has this slip, up to 40 um or from there on:
/// the work of a slider on its spring over load and path.
fn friction(mu: f64, pressure: f64, slip: f64) -> f64 {
    let elastic = mu * 0.1 * pressure / 1.6e6;
    let work = |s: f64| match s < elastic {
        true => 0.5 * mu * s * s / elastic,
        false => mu * (s - 0.5 * elastic),
    };
    match slip < 40e-6 {
        true => work(40e-6) / 40e-6,
        false => (work(200e-6) - work(40e-6)) / 160e-6,
    }
}

const PATCH: &str = r#"(
    name: "a wheel", materials: {"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"},
    bodies: ((material: "wheel", radius: 0.46 m), (material: "rail", across: 0.3 m)),
    interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "tabulated", tables: (contact: "out/law_friction.csv"))],
    load: 75 kN, speed: 20 m/s, cells: 32, motion: Rolling(along: 50 %),
)"#;

/// Friction over the path of slip is the work of Coulomb's slider on its spring over load and path,
/// at each pressure, with the interval of the coefficient; a patch that slides has it as its band.
#[test]
fn a_study_makes_the_table_that_a_patch_reads() {
    let folder = Folder::new("law-table");
    folder.put("block.ron", BLOCK);
    folder.put("study.ron", &study("-0.1", "slip: [0, 40 um, 200 um]"));
    folder.run();
    let text = std::fs::read_to_string(folder.0.join("out/law_friction.csv")).unwrap();
    assert!(
        text.starts_with("# friction for the law `tabulated`, by fretwork"),
        "{text}"
    );
    for said in [
        "case block.ron",
        "digest",
        "mu 0.3, 0.5",
        "\nslip [m],pressure [Pa],friction,",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|x| x.parse().unwrap()).collect() };
    let lines = text.lines().filter(|l| !l.starts_with(['#', 's']));
    let rows: Vec<Vec<f64>> = lines.map(numbers).collect();
    // Both ends of the path and the middles of both parts, at two pressures.
    assert_eq!(rows.len(), 8, "{text}");
    for row in rows {
        let [slip, pressure, found @ ..] = row.as_slice() else {
            panic!("{row:?}")
        };
        let of = |mu: f64| friction(mu, *pressure, *slip);
        let expected = [0.5 * (of(0.3) + of(0.5)), of(0.3), of(0.5)];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 0.01, "{row:?} {expected}");
        }
    }
    folder.put("patch.ron", PATCH);
    let mut patch = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    let output = patch
        .current_dir(&*folder.0)
        .args(["patch", "patch.ron", "--out", "patch", "--json"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{said}"));
    let point = &found["points"][0];
    let at = |path: &str| point.pointer(path).unwrap().as_f64().unwrap();
    // The passage slips by 6 mm, and the table ends at 0.2 mm and 2 kPa.
    let [low, high] = [0.3, 0.5].map(|mu| friction(mu, 2000.0, 200e-6));
    for (path, mu) in [
        ("/adhesion", 0.5 * (low + high)),
        ("/adhesion_band/low", low),
        ("/adhesion_band/high", high),
    ] {
        assert!((at(path) / mu - 1.0).abs() < 0.02, "{path} {}", at(path));
    }
    assert!(found.to_string().contains("NOT IN RANGE"), "{found}");
}

/// A table that would not be true is not written, with a sentence that says why.
#[test]
fn a_table_that_is_not_true_is_not_written() {
    let folder = Folder::new("law-table-refused");
    folder.put("block.ron", BLOCK);
    for (load, table, says) in [
        ("-0.2", "", "let the load of the window follow it by `set`"),
        ("-0.1", "slip: [0, 1 mm]", "goes on to 1.000 mm"),
    ] {
        folder.put("study.ron", &study(load, table));
        let output = folder.call(&["run", "study.ron", "--out", "out", "--jobs", "2"]);
        let said = String::from_utf8_lossy(&output.stdout).replace('\n', " ");
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(
            said.contains("no law_friction.csv") && said.contains(says),
            "{said}"
        );
        assert!(!folder.0.join("out/law_friction.csv").exists());
    }
    for (table, says) in [
        ("slip: [0, 0]", "each longer than the one before"),
        ("wear: true", "wear"),
        (
            "friction: \"measures.bulk_mu\", slip: [0, 1 um]",
            "leave `table.friction` out",
        ),
    ] {
        folder.put("study.ron", &study("-0.1", table));
        let output = folder.call(&["check", "study.ron", "--no-timing"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(says), "{said}");
    }
}
