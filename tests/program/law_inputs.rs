//! Where the parameters of laws come from: `check --inputs`, and the note about defaults on which
//! the results depend.

use super::temp::TempFolder;
use serde_json::Value;
use std::process::Command;

const CASE: &str = r#"(
    name: "a block on a floor", dimension: 2, time: (step: 1e-3, end: 0.01), gravity: [0.0, -9.81],
    materials: {"steel": "rail_steel_r260"},
    interfaces: [(
        name: "dry", between: ("steel", "steel"), contact: "coulomb", wear: "archard",
        PARAMETERS
    )],
    bodies: [
        (name: "floor", material: "steel", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "block", material: "steel", mass: 1.0, inertia: 1.0,
            shapes: [Polygon(points: [(-0.1, 0.0), (0.1, 0.0), (0.1, 0.1), (-0.1, 0.1)])],
            dofs: (x: Velocity(0.1), y: Free),
        ),
    ],
    output: (frames: 0, views: 0, figures: false),
)"#;

fn call(parameters: &str, words: &[&str]) -> String {
    let folder = TempFolder::new("law-inputs");
    std::fs::write(
        folder.join("case.ron"),
        CASE.replace("PARAMETERS", parameters),
    )
    .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(&*folder)
        .args([&words[..1], &["case.ron"], &words[1..]].concat())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The words of the line that begins with a parameter.
fn line(text: &str, parameter: &str) -> String {
    let words = |l: &str| l.split_whitespace().collect::<Vec<_>>().join(" ");
    let found = text.lines().map(words);
    let found: Vec<String> = found
        .filter(|l| l.starts_with(&format!("{parameter} ")))
        .collect();
    assert_eq!(found.len(), 1, "{parameter} in {text}");
    found[0].clone()
}

#[test]
fn each_parameter_has_its_value_its_unit_and_its_origin() {
    let given = r#"parameters: (contact: {"mu": 30 %}, wear: {"K": 3e-4}),"#;
    let text = call(given, &["check", "--no-timing", "--inputs"]);
    assert_eq!(line(&text, "mu"), "mu 0.3 - the case");
    let restitution = line(&text, "restitution_n");
    assert_eq!(restitution, "restitution_n 0 - default of the law");
    let k = line(&text, "k");
    assert!(k.starts_with("k 1.1766e-13 1/Pa"), "{k}");
    assert!(
        k.ends_with("K = 3e-4, H = 2.5497e9 Pa (260 HBW) of `steel`"),
        "{k}"
    );
    assert!(!text.contains("LAW DEFAULT"), "{text}");
    // Without the option there is no table.
    let short = call(given, &["check", "--no-timing"]);
    assert!(!short.contains("restitution_n"), "{short}");
}

#[test]
fn a_default_that_decides_the_result_is_a_note() {
    let mu = "mu = 0.3 of the contact law `coulomb` (dry) is one of the defaults of the law";
    let k = "k = 1e-14 1/Pa of the wear law `archard` (dry)";
    let text = call("", &["check", "--no-timing", "--verbose"]);
    assert!(text.contains("LAW DEFAULT") && text.contains(mu), "{text}");
    let summary: Value = serde_json::from_str(&call("", &["run", "--json"])).unwrap();
    let warnings = summary["warnings"].as_array().unwrap().iter();
    let mut notes = warnings.filter_map(Value::as_str);
    let note = notes.find(|w| w.starts_with("LAW DEFAULT")).unwrap();
    assert!(note.contains(mu) && note.contains(k), "{note}");
    let reasons = summary["reasons"].as_array().unwrap();
    assert!(!reasons.iter().any(|r| r.to_string().contains("DEFAULT")));
}

/// Sand and a lubricant have no measured wear coefficient: none is computed with that of the oxide
/// of the steel.
#[test]
fn a_powder_without_a_measured_coefficient_has_no_wear_rate() {
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/wheel_rail_powder.ron");
    for (powder, measured) in [
        ("magnetite", true),
        ("sand", false),
        ("molybdenum_disulfide", false),
    ] {
        let set = format!("materials.powder={powder}");
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["check", case, "--no-timing", "--verbose", "--set", &set])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let said = text.contains("NO WEAR RATE") && text.contains(powder);
        assert_eq!(said, !measured, "{powder}: {text}");
        assert_eq!(
            text.contains("k = 1.1766e-13"),
            measured,
            "{powder}: {text}"
        );
    }
}

/// Coefficients of wear that were measured in another motion than that of the case are named, with
/// those of their file that fit.
#[test]
fn coefficients_of_another_motion_are_named() {
    let said = |case: &str, sets: &[&str]| {
        let case = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["check", &case, "--no-timing", "--verbose"])
            .args(sets.iter().flat_map(|set| ["--set", set]))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let fretting = said("wheel_rail_fretting", &[]);
    let rolling = "OTHER MOTION `K` of the wear law `archard` (rail_oxide, wheel_oxide) was measured in rolling, and this case moves to and fro; for fretting materials/oxide_third_body.ron has `alpha` of `dissipated-energy`";
    assert!(fretting.contains(rolling), "{fretting}");
    let creep = said("wheel_rail_creep", &[]);
    let of_fretting = "was measured in fretting, and this case moves in one direction; for sliding or rolling materials/oxide_third_body.ron has `K` of `archard`";
    assert!(creep.contains(of_fretting), "{creep}");
    assert!(!creep.contains("was measured in rolling"), "{creep}");
    // What the case gives is not that of the file.
    let own = ["rail_oxide", "wheel_oxide"]
        .map(|i| format!("interfaces.{i}.parameters.wear={{\"K\": 1e-5}}"));
    let given = said("wheel_rail_fretting", &own.each_ref().map(String::as_str));
    assert!(!given.contains("OTHER MOTION"), "{given}");
}
