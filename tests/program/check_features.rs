//! `fretwork check` lists the features that a scene enables or not, with the bytes of each.

use crate::temp::TempFolder;
use std::process::Command;

/// Output of `check` for a case: the enabled features, the disabled ones, and the whole text.
fn check(case: &str, sets: &[&str]) -> (Vec<String>, Vec<String>, String) {
    let path = format!("cases/{case}.ron");
    let mut args = vec!["check", "--verbose", &path];
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

/// Text of an enabled feature.
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
    let (features, off, text) = check("wheel_rail_rigid", &[]);
    assert!(on(&features, "bonds").contains("bytes a bond"));
    assert!(on(&features, "damage").contains("in "));
    assert!(!off.iter().any(|f| f == "friction"));
    assert!(text.contains("memory a grain") && text.contains("memory a contact"));
    let (shear, _, _) = check("shear_cell_3d", &[]);
    assert_eq!(on(&shear, "dimensions"), "3 velocities, 3 spins a body");
    assert!(on(&shear, "wear").contains("archard"));
    assert!(on(&shear, "projection of overlaps").starts_with("beyond 1e-4 "));
    assert_eq!(on(&shear, "periodic"), "along x, y");
    // Outputs are those of the case.
    assert!(on(&shear, "views").starts_with("10, "));
    let (quiet, off, _) = check("shear_cell_3d", &["output.views=0", "output.frames=0"]);
    assert!(off.contains(&"views".to_owned()) && off.contains(&"frames".to_owned()));
    assert!(!quiet.iter().any(|f| f.starts_with("views")));
}

/// The bytes of a record are those of its numbers: n, p_n, p_t, shift, two inverses of W, mu and
/// two indices.
#[test]
fn the_row_of_a_contact_is_as_small_as_its_numbers() {
    let (_, _, disks) = check("benchmarks/disks_box_5000", &[]);
    let numbers = |d: usize| d + 1 + (d - 1) + 4;
    assert!(
        disks.contains(&format!(" {} bytes in the sweep", 8 * numbers(2) + 8)),
        "{disks}"
    );
}

/// Changes during the run and measures are listed: the gate of `silo`, the servo and the drive of a
/// phase of `plane_shear`.
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

/// A folder with a case, taken away at the end.
struct Made(TempFolder);

impl Made {
    fn new(name: &str, text: &str) -> Self {
        let folder = TempFolder::new(&format!("check-{name}"));
        std::fs::write(folder.join("case.ron"), text).unwrap();
        Self(folder)
    }

    fn check(&self, sets: &[&str]) -> String {
        let case = self.0.join("case.ron").display().to_string();
        let mut args = vec!["check", "--verbose", &case];
        for set in sets {
            args.extend(["--set", set]);
        }
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(&args)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let left: Vec<_> = std::fs::read_dir(&self.0).unwrap().collect();
        assert_eq!(left.len(), 1, "check wrote something: {left:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }
}

/// Two bonded free disks of 0.1 m, beside a wall that moves at 1 mm/s.
const PAIR: &str = r#"(
    name: "a bonded pair",
    dimension: 2,
    time: (step: 1e-4, end: 0.1),
    materials: {"grain": "verification_grain"},
    interfaces: [(name: "bond", between: ("grain", "grain"), contact: "frictionless", cohesion: "mac", damage: "mac",
        parameters: (cohesion: {"c_n": 1e9, "c_t": 1e9}, damage: {"w": 0.1, "b": 0.0, "beta_broken": 0.0}))],
    bodies: [(name: "wall", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])], position: [0.0, -5.0],
        dofs: (y: Velocity(Constant(1e-3))))],
    grains: [List(material: "grain", grains: [(at: [0.0, 0.0], radius: 0.1), (at: [0.2, 0.0], radius: 0.1)])],
)"#;

/// The number after a word of a text.
fn after(text: &str, word: &str) -> f64 {
    let rest = text.split(word).nth(1);
    let number = rest.and_then(|r| r.split_whitespace().next());
    let number = number.map(|n| n.trim_end_matches([',', ':', ';']));
    let value = number.and_then(|n| n.parse().ok());
    value.unwrap_or_else(|| panic!("no number after `{word}` in {text}"))
}

#[track_caller]
fn near(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got / expected - 1.0).abs() <= tolerance,
        "{got} for {expected}"
    );
}

/// MAC: the strength is sqrt(w C) at u_0 = sqrt(w/C), and a hundredth of it is left at 4.64 u_0.
/// For two disks of mass m and inertia m r^2/2 with a bond of k a N/m, a = r/2, omega^2 = 2 k a/m
/// along the normal, and three times that along the tangent.
#[test]
fn bonds_are_weighed_against_step_and_load_by_driving_them() {
    let made = Made::new("pair", PAIR);
    let text = made.check(&[]);
    assert!(
        text.contains("bond: 1 contacts at the start, reduced radius 5.00e-2 m"),
        "{text}"
    );
    near(after(&text, "opened: strength "), 1e4, 2e-3);
    near(after(&text, "sheared: strength "), 1e4, 2e-3);
    near(after(&text, "Pa at "), 1e-5, 1e-2);
    let critical = 100f64.cbrt() * 1e-5;
    near(after(&text, "broken at "), critical, 1e-2);
    near(after(&text, "m by `wall`, "), 1e-3 * 1e-4 / critical, 2e-2);
    let mass = 1000.0 * std::f64::consts::PI * 0.01;
    let omega = (2.0 * 1e9 * 0.05 / mass).sqrt();
    near(after(&text, "frequency of a bond: "), 1e-4 * omega, 1e-2);
    near(after(&text, " opened, "), 1e-4 * omega * 3f64.sqrt(), 1e-2);
    // Unfavourable values are reported with advice.
    let fast = made.check(&["time.step=1e-2", "time.end=1.0"]);
    assert!(
        fast.contains("NOT RESOLVED: a bond that takes all of it breaks within"),
        "{fast}"
    );
    assert!(
        fast.contains("NOT RESOLVED: bonds are treated quasi-statically"),
        "{fast}"
    );
    let advised = after(&fast, "its fracture energy is wrong; time.step of ");
    near(advised, 0.07 * critical / 1e-3, 0.1);
    // Another law with equal response gives an equal report.
    let other = made.check(&[
        "interfaces.bond.cohesion=elastic-bond",
        "interfaces.bond.damage=linear-softening",
        "interfaces.bond.parameters.cohesion={}",
        "interfaces.bond.parameters.damage={}",
    ]);
    assert!(other.contains("opened: strength "), "{other}");
    // A bond that breaks at its peak has no softening whose energy could be wrong.
    let brittle = made.check(&[
        "time.step=1e-1",
        "time.end=1.0",
        "interfaces.bond.cohesion=elastic-bond",
        "interfaces.bond.damage=mohr-coulomb-brittle",
        "interfaces.bond.parameters.cohesion={}",
        "interfaces.bond.parameters.damage={}",
    ]);
    let slide = brittle.lines().find(|l| l.contains("slide a step"));
    let slide = slide.unwrap_or_else(|| panic!("{brittle}"));
    assert!(
        slide.contains("NOT RESOLVED: a bond that takes all of it breaks within")
            && !slide.contains("fracture energy"),
        "{slide}"
    );
}

/// The pressure is the weight of the grains above.
#[test]
fn strength_is_told_over_the_pressure_of_the_scene() {
    let made = Made::new("weight", PAIR);
    let text = made.check(&["gravity=[0.0, -10.0]"]);
    // Two disks have 31.4 kg each, on 0.4 m.
    let pressure = 2.0 * 1000.0 * std::f64::consts::PI * 0.01 * 10.0 / 0.4;
    assert!(
        text.contains("estimated from the weight of the grains"),
        "{text}"
    );
    near(after(&text, "of the grains ("), pressure, 1e-2);
    let strong = made.check(&["gravity=[0.0, -0.001]"]);
    assert!(strong.contains("STRONG"), "{strong}");
    let weak = made.check(&["gravity=[0.0, -10000.0]"]);
    assert!(weak.contains("WEAK"), "{weak}");
}

/// The run time is estimated from a few steps; a failing step is reported and does not crash;
/// `--no-timing` omits the steps.
#[test]
fn the_run_time_is_estimated() {
    let (_, _, text) = check("silo", &[]);
    let line = text.lines().find(|l| l.trim().starts_with("run time"));
    let line = line.unwrap_or_else(|| panic!("{text}"));
    for word in [
        "about ",
        " on one thread, between ",
        "steps timed",
        "contacts and",
        "iterations",
    ] {
        assert!(line.contains(word), "{line}");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["check", "cases/silo.ron", "--no-timing"])
        .output()
        .unwrap();
    assert!(!String::from_utf8_lossy(&output.stdout).contains("run time"));
}

/// A small disk is beside a bonded pair: the median pair is that of the large disks, the lightest
/// pair has its own radius and masses. Before there are contacts the lightest grain is paired with
/// every other one.
#[test]
fn grains_of_different_size_are_weighed_in_pairs() {
    let (large, small) = (0.1, 0.02);
    let mass = |r: f64| 1000.0 * std::f64::consts::PI * r * r;
    let ratio = |a: f64, b: f64| a * b / (a + b) * (1.0 / mass(a) + 1.0 / mass(b));
    let beside = r#"grains: [List(material: "grain", grains: [(at: [0.4, 0.0], radius: 0.1), "#;
    for gap in [0.0, 0.05] {
        let little = format!(
            "(at: [{:?}, 0.0], radius: {small:?})",
            -(large + small + gap)
        );
        let text = PAIR
            .replace(r#"grains: [List(material: "grain", grains: ["#, beside)
            .replace("radius: 0.1)])]", &format!("radius: 0.1), {little}])]"));
        let text = if gap > 0.0 {
            text.replace("[0.2, 0.0]", "[0.25, 0.0]")
                .replace("[0.4, 0.0]", "[0.5, 0.0]")
        } else {
            text
        };
        let made = Made::new(&format!("sizes-{gap}"), &text);
        let bonds = made.check(&[]);
        assert_eq!(bonds.contains("no contact yet"), gap > 0.0, "{bonds}");
        // Of all pairs of these sizes, and with a wall, the ratio of area to mass decides.
        let lightest = ratio(large, small).max(small / mass(small));
        let normal = 1e-4 * (1e9 * lightest).sqrt();
        near(after(&bonds, "frequency of a bond: "), normal, 1e-2);
        // Along the tangent two disks have three times the ratio of stiffness to mass, due to their
        // rotation.
        let median = 1e-4 * (1e9 * 3.0 * ratio(large, large)).sqrt();
        near(after(&bonds, "pair of bodies ("), median, 1e-2);
        // A spring of 1e9 N/m per metre acts on these pairs.
        let springs = made.check(&[
            "interfaces.bond.contact=linear-contact",
            "interfaces.bond.parameters.contact={\"stiffness\": 1e9, \"restitution\": 0.5, \"mu\": 0.3}",
        ]);
        let per_mass = |a: f64, b: f64| 1e-8 * 1e9 * (1.0 / mass(a) + 1.0 / mass(b));
        near(after(&springs, "k h^2/m "), per_mass(large, large), 0.06);
        near(
            after(&springs, "bodies, up to "),
            per_mass(large, small),
            0.06,
        );
    }
}

/// `cargo test -p fretwork-elastic --test memory` compares these numbers with the allocated memory.
#[test]
fn the_memory_and_cost_of_deformable_bodies_are_told() {
    let (_, _, text) = check("cylinder_on_flat_fretting", &[]);
    for reported in [
        "flat: 9657 points, 19008 elements",
        "19096 unknowns; memory: matrix 3.3 MB, factor 8.0 MB, compliance of the surface 3.5 kB a point",
        "factorised once, 44 million operations",
        "MB of deformable bodies",
        "run time             about",
    ] {
        assert!(text.contains(reported), "no `{reported}` in {text}");
    }
    let (_, _, text) = check("sphere_on_flat_fretting", &[]);
    assert!(
        text.contains("768 unknowns; memory: tables of influences 152 kB"),
        "{text}"
    );
    let (_, _, text) = check("verification/rubber_block", &[]);
    assert!(
        text.contains("each iteration of a step: one factorisation of"),
        "{text}"
    );
}
