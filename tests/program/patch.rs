//! `fretwork patch`: the shipped files, tables of friction, and what is refused.

use crate::temp::TempFolder;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn patch(file: &Path, out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("patch")
        .args([file, Path::new("--out"), out])
        .output()
        .unwrap()
}

fn answered(file: &Path, out: &Path) -> Value {
    let output = patch(file, out);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{errors}");
    let text = std::fs::read_to_string(out.join("patch.json")).unwrap();
    assert!(out.join("patch.h5").is_file());
    serde_json::from_str(&text).unwrap()
}

fn numbers(of: &Value, path: &str) -> Vec<f64> {
    let points = of["points"].as_array().unwrap().iter();
    points
        .map(|p| p.pointer(path).unwrap().as_f64().unwrap())
        .collect()
}

/// Strokes of a ball go from stick over partial to gross slip, in which Q/P is mu, with the band of
/// the members.
#[test]
fn a_ball_frets_on_a_flat() {
    let folder = TempFolder::new("patch-ball");
    let got = answered(Path::new("patches/ball_on_flat.ron"), &folder.join("out"));
    let adhesion = numbers(&got, "/adhesion");
    assert!(
        adhesion.windows(2).all(|w| w[0] <= w[1] + 1e-9),
        "{adhesion:?}"
    );
    let last = adhesion.len() - 1;
    assert!((adhesion[last] - 0.6).abs() < 1e-6);
    assert!((numbers(&got, "/adhesion_band/low")[last] - 0.5).abs() < 1e-6);
    assert!((numbers(&got, "/adhesion_band/high")[last] - 0.7).abs() < 1e-6);
    assert_eq!(numbers(&got, "/stuck")[last], 0.0);
    let loops = std::fs::read_to_string(folder.join("out/loop_4.csv")).unwrap();
    assert!(loops.starts_with("displacement [m],force [N]\n"), "{loops}");
}

/// A wheel S1002 on a rail 60E1 in the middle of the track: the contact angle is that of the
/// Manchester benchmark there, 0.029 (under 10 kN, by CONTACT), and its spin drives the wheel away
/// from the track.
#[test]
fn standard_profiles_touch_under_an_angle() {
    let folder = TempFolder::new("patch-profiles");
    let file = Path::new("patches/wheel_on_rail_profiles.ron");
    let got = answered(file, &folder.join("out"));
    let of = |path: &str| got.pointer(path).unwrap().as_f64().unwrap();
    let angle = of("/contact/inclination");
    assert!((angle - 0.029).abs() < 0.01, "{angle}");
    assert!((of("/contact/vertical_load") / 75e3 - 1.0).abs() < 1e-9);
    assert!((of("/load") * angle.cos() / 75e3 - 1.0).abs() < 1e-9);
    let spin = -angle.sin() / of("/contact/rolling_radii/0");
    assert!((of("/contact/spin") / spin - 1.0).abs() < 1e-9);
    for found in numbers(&got, "/motion/Rolling/spin") {
        assert_eq!(found, of("/contact/spin"));
    }
    assert!(numbers(&got, "/force/1").iter().all(|f| *f > 0.0));
}

const WHEEL: &str = r#"(
    name: "a wheel", materials: {"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"},
    bodies: ((material: "wheel", radius: 0.46 m), (material: "rail", across: 0.3 m)),
    interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "tabulated", tables: (contact: "mu.csv"))],
    load: 75 kN, speed: 20 m/s, cells: 24, motion: Rolling(along: 10 %),
)"#;

fn with_table(folder: &Path, table: &str, text: &str) -> Output {
    std::fs::write(folder.join("mu.csv"), table).unwrap();
    std::fs::write(folder.join("wheel.ron"), text).unwrap();
    patch(&folder.join("wheel.ron"), &folder.join("out"))
}

/// Friction over slip velocity, read where the whole patch slips at 2 m/s, with its interval as the
/// band; a table that ends at 1 m/s is left.
#[test]
fn friction_from_a_table() {
    let folder = TempFolder::new("patch-table");
    let text = |fastest: f64| {
        format!(
            "slip_rate [m/s],friction,friction_low,friction_high\n0,0.5,0.45,0.55\n{fastest},0.3,0.25,0.4\n"
        )
    };
    for (fastest, expected, left) in [
        (4.0, [0.4, 0.35, 0.475], false),
        (1.0, [0.3, 0.25, 0.4], true),
    ] {
        let output = with_table(&folder, &text(fastest), WHEEL);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{errors}");
        let json = std::fs::read_to_string(folder.join("out/patch.json")).unwrap();
        let got: Value = serde_json::from_str(&json).unwrap();
        let paths = ["/adhesion", "/adhesion_band/low", "/adhesion_band/high"];
        for (path, expected) in paths.into_iter().zip(expected) {
            let found = numbers(&got, path)[0];
            assert!(
                (found - expected).abs() < 0.005,
                "{path}: {found} {expected}"
            );
        }
        assert_eq!(json.contains("NOT IN RANGE"), left, "{json}");
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(said.contains("have notes"), left, "{said}");
    }
}

const COULOMB: &str = r#"(
    name: "a wheel", materials: {"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"},
    bodies: ((material: "wheel", radius: 0.46 m), (material: "rail", across: 0.3 m)),
    interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "coulomb", parameters: (contact: {"mu": 0.4}))],
    load: 75 kN, speed: 20 m/s, cells: 24, motion: Rolling(along: 10 %),
)"#;

/// Solves a changed file; returns its exit code, what it printed, and its errors.
fn changed(folder: &Path, changes: &[(&str, &str)]) -> (Option<i32>, String, String) {
    let mut text = COULOMB.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let output = with_table(folder, "slip_rate [m/s],friction\n0,0.5\n4,0.3\n", &text);
    let [said, errors] = [output.stdout, output.stderr].map(|t| String::from_utf8(t).unwrap());
    (output.status.code(), said, errors)
}

/// What the theory does not hold for is said beside the results, in the words of `contact-patch`.
#[test]
fn limits_of_the_theory_are_noted() {
    let folder = TempFolder::new("patch-limits");
    let small = ("radius: 0.46 m", "radius: 5 mm");
    let narrow = ("across: 0.3 m", "radius: 5 mm, across: 5 mm");
    for (changes, noted, words) in [
        (
            &[("radius: 0.46 m", "radius: 460")][..],
            true,
            "RADIUS IN METRES: `460` without a unit is 460 m; if it is in millimetres write 460mm",
        ),
        (&[small, narrow], true, "NOT HERTZ: the patch, "),
        (&[small, narrow], true, "NOT ELASTIC: "),
        (
            &[("speed: 20 m/s", "speed: 150 m/s"), ("10 %", "50 %")],
            true,
            "where wheel has melted",
        ),
        (&[], false, "BEYOND SHAKEDOWN: 1.122 GPa is above"),
        (
            &[
                ("load: 75 kN", "load: 10 kN"),
                ("\"mu\": 0.4", "\"mu\": 0.1"),
            ],
            false,
            "\nverdict: all points converged, within the range of the theory\n",
        ),
        // The force of full slip is the largest one, and no creepage follows from it.
        (
            &[("Rolling(along: 10 %)", "Pulling(force: -29.9999 kN)")],
            true,
            "AT THE LIMIT: a force of 30.00 kN",
        ),
        (
            &[("Rolling(along: 10 %)", "Pulling(force: -20 kN)")],
            false,
            " % +- ",
        ),
    ] {
        let (code, said, errors) = changed(&folder, changes);
        assert_eq!(code, Some(0), "{changes:?}: {errors}");
        assert!(said.contains(words), "{changes:?}: {said}");
        let verdict = said.lines().find(|l| l.starts_with("verdict")).unwrap();
        assert_eq!(verdict.contains("notes"), noted, "{changes:?}: {verdict}");
    }
    let above = [("Rolling(along: 10 %)", "Pulling(force: -30.01 kN)")];
    let (code, _, errors) = changed(&folder, &above);
    let words =
        "does not carry a force of 30010.0 N along the rolling: with this law it has at most";
    assert!(code == Some(2) && errors.contains(words), "{errors}");
}

/// A list of loads has a result under each, by itself and in one table.
#[test]
fn a_patch_is_solved_under_each_of_its_loads() {
    let folder = TempFolder::new("patch-loads");
    let both = [
        ("load: 75 kN", "load: [10 kN, 80 kN]"),
        ("10 %", "[0.1 %, 10 %]"),
    ];
    let (code, said, errors) = changed(&folder, &both);
    assert_eq!(code, Some(0), "{errors}");
    assert!(
        said.contains("loads.html") && said.contains("load_2"),
        "{said}"
    );
    let json = std::fs::read_to_string(folder.join("out/patch.json")).unwrap();
    let all: Value = serde_json::from_str(&json).unwrap();
    let [small, large] = [0, 1].map(|k| &all["loads"][k]);
    // By Hertz the pressure grows with the cube root of the load.
    let pressure = |of: &Value| of["pressure"].as_f64().unwrap();
    assert!((pressure(large) / pressure(small) - 2.0).abs() < 0.02);
    // The creepage at which all slips grows with the patch.
    let [few, many] = [small, large].map(|of| numbers(of, "/adhesion"));
    assert!(few[0] > many[0] && (few[1] - many[1]).abs() < 1e-5);
    let table = std::fs::read_to_string(folder.join("out/loads.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    assert!(table.starts_with("load [N],pressure [Pa],area [m^2],creepage_along"));
    for (k, answer) in [small, large].into_iter().enumerate() {
        let own = folder.join(format!("out/load_{}/patch.json", k + 1));
        let own: Value = serde_json::from_str(&std::fs::read_to_string(own).unwrap()).unwrap();
        assert_eq!(&own, answer);
    }
    let none = [("load: 75 kN", "load: []")];
    assert!(changed(&folder, &none).2.contains("give one, or a list"));
}

#[test]
fn wrong_files_are_refused_with_a_sentence() {
    let folder = TempFolder::new("patch-wrong");
    let table = "slip_rate [m/s],friction\n0,0.5\n4,0.3\n";
    for (from, to, says) in [
        ("load: 75 kN", "load: -75 kN", "must be above zero"),
        ("load: 75 kN", "load: 75 kg", "`kg`"),
        (
            "\"rail_steel_r260\"",
            "\"rail_steel_r261\"",
            "did you mean `rail_steel_r260`",
        ),
        (
            "across: 0.3 m",
            "across: -0.3 m",
            "conform across the motion",
        ),
        ("cells: 24", "cells: 25", "an even number"),
        ("along: 10 %", "along: 10", "in per cent write 10 %"),
        ("\"mu.csv\"", "\"nu.csv\"", "nu.csv"),
        (
            "contact: \"tabulated\"",
            "contact: \"coulomb\"",
            "reads no table",
        ),
        (
            "contact: \"tabulated\"",
            "contact: \"coulom\"",
            "did you mean `coulomb`",
        ),
        (
            "(material: \"rail\"",
            "(material: \"rails\"",
            "no material `rails`",
        ),
        ("speed: 20 m/s,", "", "such as `speed: 100 km/h`"),
        (
            "speed: 20 m/s,",
            "speed: 20 m/s, temperature: 20,",
            "write 293.15 K for 20 degrees Celsius, or 20 K",
        ),
        (
            "Rolling(along: 10 %)",
            "Pulling(force: -60 kN)",
            "does not carry a force of 60.00 kN",
        ),
    ] {
        assert!(WHEEL.contains(from), "{from}");
        let output = with_table(&folder, table, &WHEEL.replace(from, to));
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{to}: {errors}");
        assert!(errors.contains(says), "{to}: {errors}");
    }
}
