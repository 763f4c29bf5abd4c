//! The setting `deformability` and `--variant`: forms of one case that differ in what may deform.

use super::{Folder, call, number, settings, study};
use serde_json::Value;
use std::process::Command;

/// 25 disks sheared between rough plates, with springs at their contacts.
const SHEAR: &str = r#"(
    name: "a small shear cell",
    dimension: 2,
    seed: 3,
    time: (step: 1e-4, end: 0.06, theta: 1.0),
    inertia_scaling: 50,
    periodic: (x: 0.04),
    detection: (alert: 2e-5, skin: 5e-4),
    solver: (norm: Power, tolerance: 0.01, max_iterations: 5000),
    materials: {"grain": "contact_polymer", "plate": "contact_steel"},
    interfaces: [
        (name: "grains", between: ("grain", "grain"), contact: "hertz-mindlin", parameters: (contact: {"mu": 0.3, "restitution": 0.1})),
        (name: "plates", between: ("grain", "plate"), contact: "hertz-mindlin", parameters: (contact: {"mu": 0.2, "restitution": 0.1})),
    ],
    bodies: [
        (name: "bottom", material: "plate", shapes: [RoughProfile(points: 40, rms: 1e-3, hurst: 0.8, longest: 0.04, shortest: 0.012, height: 0.0, side: Below)]),
        (
            name: "top", material: "plate", position: [0.0, 0.037], mass: 7e3,
            shapes: [RoughProfile(points: 40, rms: 1e-3, hurst: 0.8, longest: 0.04, shortest: 0.012, height: 0.0, side: Above)],
            dofs: (x: Velocity(Ramp(from: 0.0, to: 0.3, start: 0.02, end: 0.03)), y: Force(Ramp(from: -200.0, to: -2e4, start: 0.0, end: 0.02))),
        ),
    ],
    grains: [Lattice(material: "grain", count: 25, radius: (2.5e-3, 3.5e-3), low: [0.0, 0.004], high: [0.04, 0.036])],
    friction: (body: "top", along: 0, normal: 1, start: 0.03),
    output: (frames: 0, views: 0, every: 5, figures: false),
)"#;

/// Output of `fretwork check` for the case of a setting.
fn check(case: &str, setting: &Value) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.args(["check", "--verbose", case]);
    for set in setting["sets"].as_array().unwrap() {
        command.args(["--set", set.as_str().unwrap()]);
    }
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{setting}: {said}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn named(study: &Value, name: &str) -> Value {
    let all = settings(study);
    let found = all.iter().find(|s| s["setting"] == name);
    found
        .unwrap_or_else(|| panic!("no {name} in {all:#?}"))
        .clone()
}

fn friction(setting: &Value) -> f64 {
    number(setting, "/outputs/friction_coefficient/value/mean")
}

/// The contact laws of a case, as `check` lists them.
fn contacts(said: &str) -> Vec<&str> {
    let laws = said.lines().filter_map(|l| l.split_once(": contact "));
    laws.filter_map(|(_, law)| law.split([',', ';']).next())
        .collect()
}

#[test]
fn each_form_is_the_case_with_more_that_deforms() {
    let folder = Folder::new("deformability");
    let (case, out) = (folder.file("shear.ron", SHEAR), folder.out());
    let found = study(&[
        &case,
        "--setting",
        "deformability",
        "--seeds",
        "2",
        "--budget",
        "5m",
        "--out",
        &out,
    ]);
    let own = named(&found, "the case's own (deformability compliant)");
    let (grains, rigid) = (
        named(&found, "deformability grains"),
        named(&found, "deformability rigid"),
    );
    // The level with deformable grains is the reference, since the others neglect their
    // deformation.
    assert_eq!(grains["reference"], true);
    for form in [&own, &grains, &rigid] {
        assert!(form["failed"].is_null(), "{form}");
    }
    let all = [&own, &grains, &rigid].map(friction);
    for k in 0..3 {
        assert!(all[k] > 0.05 && all[k] < 1.0, "{all:?}");
        assert!((all[k] - all[(k + 1) % 3]).abs() > 1e-6, "{all:?}");
    }
    let cost = |s: &Value| number(s, "/seconds");
    assert!(cost(&grains) > 2.0 * cost(&own) && cost(&grains) > 2.0 * cost(&rigid));
    // The levels have these changes.
    assert_eq!(own["sets"], serde_json::json!([]));
    assert_eq!(
        contacts(&check(&case, &own)),
        ["hertz-mindlin", "hertz-mindlin"]
    );
    for form in [&rigid, &grains] {
        let said = check(&case, form);
        assert_eq!(contacts(&said), ["coulomb", "coulomb"], "{said}");
        assert!(said.contains("tolerance 1e-4"), "{said}");
    }
    let text = rigid["sets"].to_string();
    for part in [
        r#"{\"mu\": 0.3}"#,
        r#"{\"mu\": 0.2}"#,
        "solver.norm=Balance",
        "solver.correction=0.05",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert!(!text.contains("elastic_grains"), "{text}");
    let text = grains["sets"].to_string();
    assert!(
        text.contains(r#"elastic_grains=[(material: \"grain\""#),
        "{text}"
    );
    // First bodies of the case have no cells, which the report says.
    assert!(
        found["notes"]
            .to_string()
            .contains("deformability half-spaces is not offered")
    );
    let table = std::fs::read_to_string(format!("{out}/trade.csv")).unwrap();
    assert!(
        table.contains("deformability grains") && table.contains(",deformability,"),
        "{table}"
    );
}

/// The former words `--knob rung` run the forms of a case, and the program reports the present
/// ones.
#[test]
fn the_former_name_runs_and_is_reported() {
    let folder = Folder::new("rung");
    let text = SHEAR
        .replace("count: 25", "count: 6")
        .replace("end: 0.06", "end: 0.035");
    let (case, out) = (folder.file("shear.ron", &text), folder.out());
    let output = call(&[
        &case,
        "--knob",
        "rung",
        "--output",
        "statistics.kinetic:max=10%",
        "--seeds",
        "1",
        "--out",
        &out,
        "--json",
    ]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for reported in [
        "--knob was renamed: write --setting",
        "--setting rung was renamed: write --setting deformability",
    ] {
        assert!(said.contains(reported), "{said}");
    }
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    for form in [
        "deformability grains",
        "the case's own (deformability compliant)",
        "deformability rigid",
    ] {
        let level = named(&found, form);
        assert!(level["failed"].is_null(), "{level}");
        number(&level, "/outputs/statistics.kinetic:max/value/mean");
    }
}

/// Under a load at which disks pass through each other, the report marks the rows of runs with
/// their own warnings.
#[test]
fn rows_of_runs_that_are_not_trustworthy_are_marked() {
    let folder = Folder::new("doubts");
    let heavy = SHEAR.replace("to: -2e4", "to: -3e7");
    let (case, out) = (folder.file("heavy.ron", &heavy), folder.out());
    let found = study(&[
        &case,
        "--vary",
        "time.step=1e-4,2e-4",
        "--seeds",
        "2",
        "--budget",
        "1m",
        "--out",
        &out,
    ]);
    let table = std::fs::read_to_string(format!("{out}/trade.csv")).unwrap();
    let mut doubted = 0;
    for setting in settings(&found) {
        let runs = doubted_runs(&out, &setting);
        assert_eq!(setting["not_trustworthy"], runs, "{setting}");
        assert_eq!(setting["reasons"] != serde_json::json!([]), runs > 0);
        let name = setting["setting"].as_str().unwrap();
        let row = table.lines().find(|l| l.starts_with(name)).unwrap();
        assert_eq!(row.contains("runs not trustworthy: "), runs > 0, "{row}");
        doubted += runs;
    }
    assert!(doubted > 0, "{table}");
}

/// Runs of a setting whose summary reports that they are not trustworthy.
fn doubted_runs(out: &str, setting: &Value) -> usize {
    let read = |path: std::path::PathBuf| -> Option<Value> {
        serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()
    };
    let places = std::fs::read_dir(format!("{out}/runs")).unwrap();
    let runs = places.filter_map(|place| {
        let place = place.ok()?.path();
        let run = read(place.join("run.json"))?;
        let own = run["sets"] == setting["sets"];
        own.then(|| read(place.join("summary.json")))?
    });
    runs.filter(|summary| summary["trustworthy"] == false)
        .count()
}

/// From the other forms, rigid contacts get springs of the materials, grains and half-spaces become
/// rigid.
#[test]
fn every_form_leads_to_the_others() {
    let folder = Folder::new("forms");
    let rigid = SHEAR.replace("\"hertz-mindlin\"", "\"coulomb\"");
    let rigid = rigid
        .replace(", \"restitution\": 0.1", "")
        .replace("norm: Power, tolerance: 0.01", "tolerance: 1e-3");
    let soft = rigid.replace(
        "friction: (",
        "elastic_grains: [(material: \"grain\", elements: 2)], friction: (",
    );
    let plane = r#"half_spaces: [(
        name: "base", material: "plate", position: [0.0, -0.005], x: (from: 0.0, to: 0.04, size: 1e-3), depth: 0.05, periodic: true, touches: Surface,
    )],
    grains: ["#;
    let bottom = SHEAR.find("        (name: \"bottom\"").unwrap();
    let top = SHEAR.find("        (\n            name: \"top\"").unwrap();
    let supported = [&SHEAR[..bottom], &SHEAR[top..]]
        .concat()
        .replace("grains: [L", &format!("{plane}L"));
    for (name, text, own, others) in [
        ("rigid", &rigid, "rigid", &["grains", "compliant"][..]),
        ("soft", &soft, "grains", &["compliant", "rigid"]),
        (
            "plane",
            &supported,
            "half-spaces",
            &["grains", "compliant", "rigid"],
        ),
    ] {
        let (case, out) = (
            folder.file(&format!("{name}.ron"), text),
            folder.out() + name,
        );
        let found = study(&[
            &case,
            "--set",
            "time.end=0.04",
            "--setting",
            "deformability",
            "--seeds",
            "1",
            "--output",
            "energy.friction",
            "--out",
            &out,
        ]);
        named(&found, &format!("the case's own (deformability {own})"));
        for form in others {
            let level = named(&found, &format!("deformability {form}"));
            assert!(level["failed"].is_null(), "{level}");
            let said = check(&case, &level);
            let law = if *form == "compliant" {
                "hertz-mindlin"
            } else {
                "coulomb"
            };
            assert_eq!(contacts(&said), [law, law], "{form}: {said}");
            let sets = level["sets"].to_string();
            let removed = (name == "soft", "elastic_grains=[]");
            assert_eq!(sets.contains(removed.1), removed.0, "{sets}");
            let planes = name == "plane" && *form != "grains";
            assert_eq!(sets.contains("half_spaces=[]"), planes, "{sets}");
        }
    }
}

#[test]
fn what_has_one_form_only_is_refused_with_the_reasons() {
    let folder = Folder::new("one-form");
    let out = folder.out();
    let heap = folder.file("heap.ron", super::HEAP);
    let shear = folder.file("shear.ron", SHEAR);
    let other = folder.file("other.ron", &SHEAR.replace("count: 25", "count: 20"));
    let (other, same) = (format!("few={other}"), format!("same={shear}"));
    let heap_variant = format!("heap={heap}");
    for (arguments, said) in [
        (
            &[&heap[..], "--setting", "deformability"][..],
            "`glass` has no `poisson`",
        ),
        (
            &[&heap, "--setting", "deformability"],
            "needs `young` of the material `glass`",
        ),
        (
            &[
                &shear,
                "--setting",
                "deformability",
                "--setting",
                "tolerance",
            ],
            "cannot be varied together",
        ),
        (&[&shear, "--variant", "few"], "expected NAME=FILE"),
        (
            &[&shear, "--variant", &other, "--variant", &other],
            "give each case once",
        ),
        (
            &[
                &shear,
                "--variant",
                &heap_variant,
                "--vary",
                "solver.tolerance=1e-3,1e-2",
            ],
            "cannot be varied together",
        ),
        (
            &[&shear, "--variant", &same, "--set", "solver.tolerence=1"],
            "did you mean `tolerance`?",
        ),
    ] {
        let outputs = ["--output", "energy.friction", "--out", &out];
        let output = call(&[arguments, &outputs].concat());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(said), "{arguments:?}: {text}");
    }
}

/// A file that differs in several sections is run unchanged.
#[test]
fn another_file_is_a_form_of_the_case() {
    let folder = Folder::new("variant");
    let (case, out) = (folder.file("shear.ron", SHEAR), folder.out());
    let lone = SHEAR
        .replace("count: 25", "count: 20")
        .replace("periodic: (x: 0.04),", "");
    let few = SHEAR
        .replace("count: 25", "count: 20")
        .replace("\"mu\": 0.3", "\"mu\": 0.5")
        .replace("    inertia_scaling: 50,\n", "");
    let few = folder.file("few.ron", &few);
    let refused = folder.file("refused.ron", &lone);
    let common = [
        "--set",
        "time.end=0.04",
        "--seeds",
        "1",
        "--output",
        "energy.friction",
    ];
    let (fine, own) = (format!("few={few}"), format!("usual={case}"));
    let found = study(
        &[
            &[&case, "--variant", &fine, "--variant", &own, "--out", &out][..],
            &common,
        ]
        .concat(),
    );
    named(&found, "the case's own (variant usual)");
    let level = named(&found, "variant few");
    assert_eq!(level["reference"], true);
    // The results are those of a run of the file itself.
    let alone = folder.0.join("alone");
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command
        .args(["run", &few, "--set", "time.end=0.04", "--out"])
        .arg(&alone);
    assert!(command.output().unwrap().status.success());
    let text = std::fs::read_to_string(alone.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let (a, b) = (
        number(&summary, "/energy/friction"),
        number(&level, "/outputs/energy.friction/value/mean"),
    );
    assert_eq!(a, b);
    // A file that is not a case is rejected with its position.
    let wrong = format!("lone={refused}");
    let output = call(
        &[
            &[&case[..], "--variant", &wrong, "--out", &out][..],
            &common,
        ]
        .concat(),
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
}
