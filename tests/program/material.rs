//! `fretwork material`: list, show and check, and materials of other names and of a case itself.

use super::temp::TempFolder;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn call(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.current_dir(folder).args(words).output().unwrap()
}

/// What a call prints, which ends with a code.
fn said(folder: &Path, words: &[&str], code: i32) -> String {
    let output = call(folder, words);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{words:?}: {errors}");
    format!("{}{errors}", String::from_utf8_lossy(&output.stdout))
}

fn json(folder: &Path, words: &[&str]) -> Value {
    serde_json::from_str(&said(folder, words, 0)).unwrap()
}

#[test]
fn all_materials_are_listed_and_can_be_shown() {
    let folder = TempFolder::new("material-list");
    let text = said(&folder, &["material", "list"], 0);
    assert!(text.lines().count() > 50);
    let line = |name: &str| {
        text.lines()
            .find(|l| l.starts_with(name))
            .unwrap()
            .to_owned()
    };
    let words = line("titanium_ti6al4v");
    let words: Vec<&str> = words.split_whitespace().collect();
    assert_eq!(
        words[..5],
        ["titanium_ti6al4v", "titanium", "114", "3.423", "4430"]
    );

    let listed = json(&folder, &["material", "list", "--json"]);
    for sheet in listed.as_array().unwrap() {
        let name = sheet["name"].as_str().unwrap();
        let shown = json(&folder, &["material", "show", name, "--json"]);
        assert_eq!(shown, *sheet);
        let properties = sheet["properties"].as_object().unwrap();
        for (property, number) in properties {
            let source = number["source"].as_str().unwrap();
            assert!(source.len() > 3, "{name}.{property}: {source}");
        }
    }
    let of = |words: &[&str]| {
        let listed = json(&folder, &[&["material", "list", "--json"], words].concat());
        listed.as_array().unwrap().len()
    };
    let steels = of(&["steel"]);
    assert!(of(&["steel", "rail"]) > 5 && of(&["steel", "rail"]) < steels);
    assert_eq!(of(&["ti-6al-4v"]), 1);
    said(&folder, &["material", "list", "unobtainium"], 2);
}

#[test]
fn a_material_is_shown_with_all_that_follows() {
    let folder = TempFolder::new("material-show");
    let text = said(&folder, &["material", "show", "60E1 R260"], 0);
    for words in [
        "rail_steel_r260: pearlitic",
        "260 HBW",
        "plane_strain_modulus",
        "built in",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let sheet = json(&folder, &["material", "show", "AISI 52100", "--json"]);
    assert_eq!(sheet["name"], "bearing_steel_100cr6");
    let number = |path: &str| sheet.pointer(path).and_then(Value::as_f64).unwrap();
    // 62 HRC is 746 HV.
    let hardness = 746.0 * 9.80665e6;
    assert!((number("/properties/hardness/value") - hardness).abs() < 1.0);
    assert_eq!(number("/properties/young/range/1"), 210e9);
    let missing = said(&folder, &["material", "show", "rail_steel_r26"], 2);
    assert!(
        missing.contains("did you mean `rail_steel_r260`?"),
        "{missing}"
    );
    let missing = said(&folder, &["material", "show", "Inconell 718"], 2);
    assert!(missing.contains("did you mean `Inconel 718`?"), "{missing}");
}

const OWN: &str = r#"(
    doc: "our bronze", class: Copper, also: ["alloy 7"],
    density: (value: 8.8 g/cm^3, source: "weighed"),
    properties: {
        "young": (value: 95 GPa, range: (90, 100), source: "sheet"),
        "poisson": (value: 0.34, source: "that of CuSn6"),
        "hardness": (value: 95, unit: "HV 10", source: "sheet"),
    },
)"#;

#[test]
fn own_files_are_checked() {
    let folder = TempFolder::new("material-check");
    let check = |text: &str, code: i32| {
        std::fs::write(folder.join("own.ron"), text).unwrap();
        said(&folder, &["material", "check", "own.ron"], code)
    };
    assert!(check(OWN, 0).contains("4 numbers, each with a source, and plausible for copper"));
    for (from, to, place, words) in [
        (
            "95 GPa",
            "95 Pa",
            "own.ron:5:26: doubt",
            "expected 95 GPa, if that is meant",
        ),
        (
            "0.34",
            "0.6",
            "own.ron:6:28: doubt",
            "copper has 0.29 to 0.38",
        ),
        (
            "8.8 g/cm^3",
            "8.8",
            "own.ron:3:",
            "8.8 g/cm^3, if that is meant",
        ),
        (
            "\"weighed\"",
            "\"\"",
            "own.ron:3:",
            "`density` has no source",
        ),
        (
            "\"poisson\"",
            "\"poison\"",
            "own.ron:6:",
            "did you mean `poisson`?",
        ),
    ] {
        let said = check(&OWN.replacen(from, to, 1), 1);
        assert!(said.contains(place) && said.contains(words), "{to}: {said}");
    }
    for (from, to, place, words) in [
        ("HV 10", "HVV", "own.ron:7:", "`HVV` is not a known unit"),
        (
            "(90, 100)",
            "(96, 100)",
            "own.ron:5:",
            "does not contain its value 95",
        ),
        ("Copper", "Coper", "own.ron:2:", "did you mean `Copper`?"),
        (
            "source: \"weighed\"",
            "sorce: \"weighed\"",
            "own.ron:3:",
            "did you mean `source`?",
        ),
    ] {
        let said = check(&OWN.replacen(from, to, 1), 2);
        assert!(said.contains(place) && said.contains(words), "{to}: {said}");
    }
    said(&folder, &["material", "check", "none.ron"], 2);
}

/// Cases find materials by their other names, those of own files too, and describe their own.
#[test]
fn cases_use_other_names_and_own_materials() {
    let folder = TempFolder::new("material-case");
    std::fs::create_dir(folder.join("materials")).unwrap();
    std::fs::write(folder.join("materials/bronze.ron"), OWN).unwrap();
    let case = |pin: &str, disc: &str| {
        let text = format!(
            r#"(
    name: "a block on a floor", dimension: 2, time: (step: 1e-3, end: 0.01), gravity: [0.0, -9.81],
    materials: {{"pin": {pin}, "disc": {disc}}},
    interfaces: [(
        name: "dry", between: ("pin", "disc"), contact: "coulomb", wear: "archard",
        parameters: (contact: {{"mu": 0.3}}, wear: {{"K": 1e-4}}),
    )],
    bodies: [(name: "floor", material: "disc", shapes: [HalfSpace(normal: [0.0, 1.0])])],
    grains: [List(material: "pin", grains: [(at: [0.0, 0.01], radius: 0.01)])],
)"#
        );
        std::fs::write(folder.join("case.ron"), text).unwrap();
        let words = ["check", "case.ron", "--no-timing", "--inputs"];
        said(&folder, &words, 0)
    };
    // The wear coefficient K over the hardness of the bronze, which is the softer one.
    let coefficient = |text: &str| {
        let line = text.lines().find(|l| l.trim_start().starts_with("k "));
        let words = line.unwrap_or_else(|| panic!("{text}")).split_whitespace();
        words.take(3).collect::<Vec<_>>().join(" ")
    };
    let by_file = case("\"bronze\"", "\"bearing_steel_100cr6\"");
    let by_name = case("\"Alloy-7\"", "\"AISI 52100\"");
    let inline = case(OWN, "\"SUJ2\"");
    let expected = 1e-4 / (95.0 * 9.80665e6);
    let found = coefficient(&by_file);
    let found: f64 = found.split(' ').nth(1).unwrap().parse().unwrap();
    assert!(
        (found / expected - 1.0).abs() < 1e-3,
        "{found:e} {expected:e}"
    );
    for other in [&by_name, &inline] {
        assert_eq!(coefficient(other), coefficient(&by_file));
    }
    let run = [
        "run",
        "case.ron",
        "--out",
        "out",
        "--set",
        "output.frames=0",
    ];
    said(&folder, &run, 0);
    // It goes on from its results: the material that the case describes is the same.
    let on = [&run[..], &["--resume", "--set", "time.end=0.02"]].concat();
    said(&folder, &on, 0);
}
