//! `fretwork check` lists what a scene has switched on and what is off, with the bytes that each takes.

use std::process::Command;

/// What `check` says of a case: the features that are on, those that are off, and the whole text.
fn check(case: &str, sets: &[&str]) -> (Vec<String>, Vec<String>, String) {
    let path = format!("cases/{case}.ron");
    let mut args = vec!["check", &path];
    for set in sets {
        args.extend(["--set", set]);
    }
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(&args)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let mut on = Vec::new();
    let lines = text.lines().skip_while(|l| !l.starts_with("  on "));
    for line in lines.take_while(|l| !l.starts_with("  off ")) {
        on.push(line.trim().trim_start_matches("on ").trim().to_owned());
    }
    let off = text.lines().find_map(|l| l.strip_prefix("  off "));
    let off = off.unwrap_or_else(|| panic!("no line `off` in {text}"));
    let off = off.trim().split(", ").map(str::to_owned).collect();
    (on, off, text)
}

/// The text of a feature that is on.
fn on<'a>(features: &'a [String], name: &str) -> &'a str {
    let found = features
        .iter()
        .find_map(|f| f.strip_prefix(&format!("{name}: ")));
    found.unwrap_or_else(|| panic!("`{name}` is not on: {features:?}"))
}

const FRICTIONLESS: [&str; 2] = [
    "interfaces.0.contact=frictionless",
    "interfaces.0.parameters.contact={}",
];

#[test]
fn a_frictionless_scene_of_disks_has_neither_friction_nor_rotation_nor_memory() {
    let box_of_disks = "benchmarks/disks_box_5000";
    let (with, off, _) = check(box_of_disks, &[]);
    assert_eq!(on(&with, "dimensions"), "2 velocities, 1 spins a body");
    assert_eq!(on(&with, "friction"), "in grains");
    assert_eq!(on(&with, "rotation"), "5000 bodies turn freely");
    assert!(off.iter().any(|f| f == "bonds") && off.iter().any(|f| f == "history variables"));
    let (without, off, _) = check(box_of_disks, &FRICTIONLESS);
    for name in [
        "friction",
        "friction against rotation",
        "rotation",
        "bonds",
        "attraction without bonds",
        "damage",
        "healing",
        "wear",
        "surfaces that recede",
        "history variables",
        "periodic",
        "position correction",
        "projection of overlaps",
        "implicit coupling",
        "inertia scaling",
    ] {
        assert!(off.iter().any(|f| f == name), "{name} is not off");
        assert!(!without.iter().any(|f| f.starts_with(&format!("{name}:"))));
    }
}

#[test]
fn bonds_damage_and_history_are_listed_with_their_bytes() {
    let (features, off, text) = check("wheel_rail_fretting", &[]);
    assert!(on(&features, "bonds").contains("bytes a bond"));
    assert!(on(&features, "damage").contains("in "));
    assert!(!off.iter().any(|f| f == "friction"));
    assert!(text.contains("memory a grain") && text.contains("memory a contact"));
    let (shear, _, _) = check("shear_cell_3d", &[]);
    assert_eq!(on(&shear, "dimensions"), "3 velocities, 3 spins a body");
    assert!(on(&shear, "wear").contains("archard"));
    assert!(on(&shear, "projection of overlaps").starts_with("beyond 1e-4 "));
    assert_eq!(on(&shear, "periodic"), "along x, y");
    // Outputs as the case has them.
    assert!(on(&shear, "views").starts_with("10, "));
    let (quiet, off, _) = check("shear_cell_3d", &["output.views=0", "output.frames=0"]);
    assert!(off.contains(&"views".to_owned()) && off.contains(&"frames".to_owned()));
    assert!(!quiet.iter().any(|f| f.starts_with("views")));
}

/// The bytes of a record are those of its numbers: n, p_n, p_t, shift, two inverses of W, mu and two indices.
#[test]
fn the_row_of_a_contact_is_as_small_as_its_numbers() {
    let (_, _, disks) = check("benchmarks/disks_box_5000", &[]);
    let numbers = |d: usize| d + 1 + (d - 1) + 4;
    assert!(
        disks.contains(&format!(" {} bytes in the sweep", 8 * numbers(2) + 8)),
        "{disks}"
    );
}

/// What changes during a run and what is measured: of `silo` the gate, of `plane_shear` the servo and the drive of a phase.
#[test]
fn the_programme_and_the_measures_are_listed() {
    let (silo, off, _) = check("silo", &[]);
    assert_eq!(on(&silo, "phases"), "fill, lower, drain");
    assert_eq!(on(&silo, "gates"), "gate with phase drain");
    assert_eq!(on(&silo, "measures"), "held (Mass)");
    assert!(off.iter().any(|f| f == "servo pressure"));
    let (shear, off, _) = check("plane_shear", &[]);
    assert_eq!(on(&shear, "servo pressure"), "top y");
    assert_eq!(on(&shear, "imposed motion"), "top x");
    assert!(off.iter().any(|f| f == "gates") && off.iter().any(|f| f == "imposed force"));
}

/// A box of disks has no servo, no phases and no measures.
#[test]
fn what_does_not_change_is_off() {
    let (_, off, _) = check("benchmarks/disks_box_5000", &[]);
    for name in ["phases", "servo pressure", "gates", "measures"] {
        assert!(off.iter().any(|f| f == name), "{name} is not off");
    }
}
