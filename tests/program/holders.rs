//! Phases of holders of deformable bodies.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn shipped(case: &str) -> PathBuf {
    PathBuf::from(format!("{ROOT}/cases/{case}.ron"))
}

fn call(word: &str, case: &Path, sets: &[&str], out: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.arg(word).arg(case);
    for set in sets {
        command.args(["--set", set]);
    }
    if let Some(out) = out {
        command.arg("--out").arg(out);
    }
    command.output().unwrap()
}

/// The table of a run, without the column of the phase.
fn table(case: &str, sets: &[&str], name: &str) -> Vec<(String, Vec<f64>)> {
    table_of(&shipped(case), sets, name)
}

fn table_of(case: &Path, sets: &[&str], name: &str) -> Vec<(String, Vec<f64>)> {
    let folder: PathBuf =
        std::env::temp_dir().join(format!("fretwork-holders-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    let output = call("run", case, sets, Some(&folder));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {said}");
    let text = std::fs::read_to_string(folder.join("statistics.csv")).unwrap();
    let _ = std::fs::remove_dir_all(&folder);
    let mut rows = text.lines().filter(|l| !l.starts_with('#'));
    let mut columns: Vec<(String, Vec<f64>)> = rows
        .next()
        .unwrap()
        .split(',')
        .map(|n| (n.to_owned(), Vec::new()))
        .collect();
    for row in rows {
        for (column, value) in columns.iter_mut().zip(row.split(',')) {
            column.1.push(value.parse().unwrap_or(f64::NAN));
        }
    }
    columns.retain(|c| c.0 != "phase");
    columns
}

fn same(case: &str, common: &[&str], phases: &[&str], stages: &[&str], moves: &str) {
    let a = table(case, &[common, phases].concat(), "phases");
    let b = table(case, &[common, stages].concat(), "stages");
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.0, b.0);
        if a.0.contains("_holder_") {
            // The phase begins at the sum of the steps, not at a number of the file.
            let most = a.1.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let mut pairs = a.1.iter().zip(&b.1);
            assert!(pairs.all(|(a, b)| (a - b).abs() <= 1e-9 * most), "{}", a.0);
        }
    }
    let column = a.iter().find(|c| c.0 == moves);
    let column =
        column.unwrap_or_else(|| panic!("{:?}", a.iter().map(|c| &c.0).collect::<Vec<_>>()));
    let most = column.1.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!((most / 1e-6 - 1.0).abs() < 0.02, "{most}");
}

/// A half-space that phases press, move and hold moves as with equal drives in stages.
#[test]
fn a_phase_drives_a_half_space() {
    let load =
        "half_spaces.sphere.dofs.z=Force(Ramp(from: 0.0, to: -99.52, start: 0.0, end: 4e-3))";
    let phases = r#"phases=[
        (name: "press", until: After(5e-3)),
        (name: "rub", drives: {"sphere": (x: Displacement(Sine(amplitude: 1e-6, frequency: 20.0)))}, until: Time(0.03)),
        (name: "hold", drives: {"sphere": (x: Fixed, z: Force(-50.0))}),
    ]"#;
    same(
        "sphere_on_flat_fretting",
        &["time.end=0.04", "output.figures=false", "output.views=0"],
        &[load, "half_spaces.sphere.dofs.x=Fixed", phases],
        &[
            "half_spaces.sphere.dofs.z=Stages([(until: 0.03, drive: Force(Ramp(from: 0.0, to: -99.52, start: 0.0, end: 4e-3))), (drive: Force(-50.0))])",
            "half_spaces.sphere.dofs.x=Stages([(until: 5e-3, drive: Fixed), (until: 0.03, drive: Displacement(Sine(amplitude: 1e-6, frequency: 20.0, start: 5e-3))), (drive: Fixed)])",
        ],
        "sphere_holder_x [m]",
    );
}

const COARSE: [&str; 8] = [
    "time.end=0.04",
    "output.figures=false",
    "output.views=0",
    "output.frames=0",
    "elastic.flat.mesh=Block(x: (from: -0.02, to: 0.02, size: 4e-4, fine: (-1.6e-3, 1.6e-3), growth: 1.6), y: (from: -0.02, to: 0.0, size: 4e-4, fine: (-8e-4, 0.0), growth: 1.6))",
    "elastic.cylinder.mesh=Block(x: (from: -0.02, to: 0.02, size: 4e-4, fine: (-1.6e-3, 1.6e-3), growth: 1.6), y: (from: 0.0, to: 0.02, size: 4e-4, fine: (0.0, 8e-4), growth: 1.6), round: (side: \"bottom\", radius: 0.5))",
    "elastic.cylinder.supports.0.y=Force(Ramp(from: 0.0, to: -178.9e3, start: 0.0, end: 4e-3))",
    "friction.start=5e-3",
];

/// Phases that repeat in groups drive a part of a body of finite elements.
#[test]
fn phases_drive_a_part_of_a_body_of_elements() {
    let phases = r#"phases=[
        (name: "press", until: Time(5e-3)),
        (name: "to", drives: {"cylinder.top": (x: Displacement(Ramp(from: 0.0, to: 1e-6, start: 0.0, end: 5e-3)))}, until: After(5e-3)),
        (name: "fro", drives: {"cylinder.top": (x: Displacement(Ramp(from: 0.0, to: -1e-6, start: 0.0, end: 5e-3)))}, until: Steps(20), repeat: (from: "to", times: 3)),
    ]"#;
    let mut stages = vec!["(until: 5e-3, drive: Fixed)".to_owned()];
    for k in 1..7 {
        // The times are the ends of steps as the run counts them.
        let (begin, end) = (
            20.0 * f64::from(k) * 2.5e-4,
            20.0 * f64::from(k + 1) * 2.5e-4,
        );
        let to = if k % 2 == 1 { "1e-6" } else { "-1e-6" };
        let until = if k < 6 {
            format!("until: {end}, ")
        } else {
            String::new()
        };
        stages.push(format!(
            "({until}drive: Displacement(Ramp(from: 0.0, to: {to}, start: {begin}, end: {end})))"
        ));
    }
    let stages = format!(
        "elastic.cylinder.supports.0.x=Stages([{}])",
        stages.join(", ")
    );
    let common = [&COARSE[1..], &["time.end=0.035"]].concat();
    let a = table(
        "cylinder_on_flat_fretting",
        &[
            &common[..],
            &["elastic.cylinder.supports.0.x=Fixed", phases],
        ]
        .concat(),
        "elements-phases",
    );
    let b = table(
        "cylinder_on_flat_fretting",
        &[&common[..], &[&stages]].concat(),
        "elements-stages",
    );
    let x = |t: &[(String, Vec<f64>)]| {
        t.iter()
            .find(|c| c.0 == "cylinder_top_x [m]")
            .unwrap()
            .1
            .clone()
    };
    let (a, b) = (x(&a), x(&b));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-15, "{a} and {b}");
    }
    let most = a.iter().fold(0.0, |m: f64, x| m.max(*x));
    assert!((most / 1e-6 - 1.0).abs() < 0.02, "{most}");
}

fn column<'a>(table: &'a [(String, Vec<f64>)], name: &str) -> &'a [f64] {
    let found = table.iter().find(|c| c.0.starts_with(name));
    &found.unwrap_or_else(|| panic!("no {name}")).1
}

/// A phase that begins when all is at rest moves the body as a drive that begins at that time.
#[test]
fn a_phase_that_begins_at_rest_drives_a_half_space() {
    let load =
        "half_spaces.sphere.dofs.z=Force(Ramp(from: 0.0, to: -99.52, start: 0.0, end: 4e-3))";
    let run = |until: &str, name: &str| {
        let phases = format!(
            r#"phases=[(name: "press", until: {until}), (name: "rub", drives: {{"sphere": (x: Displacement(Sine(amplitude: 1e-6, frequency: 20.0)))}})]"#
        );
        let sets = [
            "time.end=0.03",
            "output.figures=false",
            "output.views=0",
            "output.every=1",
            load,
            "half_spaces.sphere.dofs.x=Fixed",
            &phases,
        ];
        table("sphere_on_flat_fretting", &sets, name)
    };
    let rest = run(
        "AtRest(energy: Some(1e-9), held: 5e-3, at_most: Some(0.02))",
        "rest",
    );
    let (time, x) = (column(&rest, "time"), column(&rest, "sphere_holder_x"));
    let first = x.iter().position(|x| *x != 0.0).unwrap();
    let begun = time[first - 1];
    assert!(begun > 4.9e-3 && begun < 0.015, "{begun}");
    let timed = run(&format!("Time({begun:?})"), "time");
    for name in ["sphere_holder_x", "sphere_holder_fx", "sphere_holder_fz"] {
        assert_eq!(column(&rest, name), column(&timed, name), "{name}");
    }
    for (t, x) in time[first..].iter().zip(&x[first..]) {
        let expected = 1e-6 * (40.0 * std::f64::consts::PI * (t - begun)).sin();
        assert!((x - expected).abs() < 1e-9 * 1e-6 + 1e-6 * 1e-6, "{t}: {x}");
    }
}

/// A block of steel on a rigid floor, pressed by a servo over the distance of two walls of which
/// one moves, and dragged along.
const BLOCK: &str = r#"(
    name: "servo",
    dimension: 2,
    time: (step: 1e-3, end: 0.04, theta: 1.0),
    materials: {"steel": "rail_steel_r260"},
    detection: (alert: 1e-5, skin: 1e-4),
    interfaces: [(name: "contact", between: ("steel", "steel"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    solver: (method: Newton, tolerance: 1e-12, norm: Velocity),
    bodies: [
        (name: "floor", material: "steel", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "left", material: "steel", shapes: [HalfSpace(normal: [1.0, 0.0])], position: [-0.02, 0.0]),
        (name: "right", material: "steel", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [0.02, 0.0], dofs: (x: Velocity(Constant(0.1)))),
    ],
    elastic: [(
        name: "block",
        material: "steel",
        mesh: Block(x: (from: -5e-3, to: 5e-3, size: 1e-3), y: (from: 0.0, to: 5e-3, size: 1e-3)),
        supports: [(part: "top", x: Fixed, y: Force(Constant(0.0)))],
        touches: Points("bottom"),
    )],
    phases: [
        (name: "settle", until: AtRest(energy: Some(1e-6), held: 2e-3)),
        (
            name: "drag",
            drives: {"block.top": (
                x: Velocity(Constant(1e-3)),
                y: Pressure(value: Ramp(from: 0.0, to: -1e6, start: 0.0, end: 0.01), between: [("left", "right")]),
            )},
        ),
    ],
    output: (frames: 0, views: 0, every: 1, figures: false),
)"#;

/// A servo on the holder of a deformable body keeps the pressure while the area grows and the
/// surface slips: Q = mu P.
#[test]
fn a_servo_presses_what_holds_a_deformable_body() {
    let file = std::env::temp_dir().join(format!("fretwork-servo-{}.ron", std::process::id()));
    std::fs::write(&file, BLOCK).unwrap();
    let rows = table_of(&file, &[], "servo");
    let _ = std::fs::remove_file(&file);
    let (time, force) = (column(&rows, "time"), column(&rows, "block_top_fy"));
    let (x, along) = (column(&rows, "block_top_x"), column(&rows, "block_top_fx"));
    let first = x.iter().position(|x| *x != 0.0).unwrap();
    let begun = time[first - 1];
    assert!(begun < 5e-3, "{begun}");
    for (t, f) in time.iter().zip(force).skip(first + 11) {
        // The area is measured at the start of a step of 1e-3 s.
        let expected = -1e6 * (0.04 + 0.1 * (t - 1e-3));
        assert!((f / expected - 1.0).abs() < 1e-9, "{t}: {f} for {expected}");
    }
    let last = force.len() - 1;
    let friction = along[last].abs() / force[last].abs();
    assert!((friction / 0.3 - 1.0).abs() < 1e-3, "{friction}");
}

#[test]
fn what_phases_cannot_do_with_a_holder_is_refused() {
    let drive = |what: &str| format!("phases=[(name: \"rub\", drives: {what})]");
    for (case, phases, said) in [
        ("cylinder_on_flat_fretting", drive(r#"{"cylinder": (x: Fixed)}"#), "cylinder.top"),
        ("cylinder_on_flat_fretting", drive(r#"{"flat.bottom": (rz: Fixed)}"#), "does not turn"),
        ("cylinder_on_flat_fretting", drive(r#"{"cylinder.top": (y: Pressure(value: Constant(1e5)))}"#), "a pressure needs the length along x"),
        ("cylinder_on_flat_fretting", drive(r#"{"flat.bottom": (y: Force(Constant(1e5)))}"#), "imposes motion at one time and a force at another"),
        ("sphere_on_flat_fretting", drive(r#"{"shpere": (x: Fixed)}"#), "did you mean `sphere`?"),
        (
            "sphere_on_flat_fretting",
            r#"phases=[(name: "press", until: After(5e-3)), (name: "rub", drives: {"sphere": (z: Fixed)})]"#.to_owned(),
            "imposes motion at one time and a force at another",
        ),
    ] {
        let output = call("check", &shipped(case), &["time.end=0.02", &phases, "output.views=0"], None);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{phases}: {text}");
        assert!(text.contains(said), "{phases}: {text}");
    }
}
