//! Phases of what holds deformable bodies.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn call(word: &str, case: &str, sets: &[&str], out: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.arg(word).arg(format!("{ROOT}/cases/{case}.ron"));
    for set in sets {
        command.args(["--set", set]);
    }
    if let Some(out) = out {
        command.arg("--out").arg(out);
    }
    command.output().unwrap()
}

/// The table of a run, without the column that tells the phase.
fn table(case: &str, sets: &[&str], name: &str) -> Vec<(String, Vec<f64>)> {
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
        let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&a.1), bits(&b.1), "{}", a.0);
    }
    let column = a.iter().find(|c| c.0 == moves);
    let column =
        column.unwrap_or_else(|| panic!("{:?}", a.iter().map(|c| &c.0).collect::<Vec<_>>()));
    let most = column.1.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!((most / 1e-6 - 1.0).abs() < 0.02, "{most}");
}

/// A half-space that phases press, rub and hold moves as with the same drives in stages, bit by bit.
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

/// The same of a part of a body of finite elements, in rounds that repeat.
#[test]
fn phases_drive_a_part_of_a_body_of_elements() {
    let phases = r#"phases=[
        (name: "press", until: Time(5e-3)),
        (name: "to", drives: {"cylinder.top": (x: Displacement(Ramp(from: 0.0, to: 1e-6, start: 0.0, end: 5e-3)))}, until: After(5e-3)),
        (name: "fro", drives: {"cylinder.top": (x: Displacement(Ramp(from: 0.0, to: -1e-6, start: 0.0, end: 5e-3)))}, until: Steps(20), repeat: (from: "to", times: 3)),
    ]"#;
    let mut stages = vec!["(until: 5e-3, drive: Fixed)".to_owned()];
    for k in 1..7 {
        // Ends of steps as the run counts them.
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

#[test]
fn what_phases_cannot_do_with_a_holder_is_refused() {
    let drive = |what: &str| format!("phases=[(name: \"rub\", drives: {what})]");
    for (case, phases, said) in [
        ("cylinder_on_flat_fretting", drive(r#"{"cylinder": (x: Fixed)}"#), "cylinder.top"),
        ("cylinder_on_flat_fretting", drive(r#"{"flat.bottom": (rz: Fixed)}"#), "does not turn"),
        ("cylinder_on_flat_fretting", drive(r#"{"flat.bottom": (y: Pressure(value: 1e5))}"#), "needs rigid walls"),
        ("sphere_on_flat_fretting", drive(r#"{"shpere": (x: Fixed)}"#), "did you mean `sphere`?"),
        (
            "sphere_on_flat_fretting",
            r#"phases=[(name: "rest", until: AtRest(energy: Some(1e-9), held: 1e-3)), (name: "rub", drives: {"sphere": (x: Fixed)})]"#.to_owned(),
            "is not known before the run",
        ),
        (
            "sphere_on_flat_fretting",
            r#"phases=[(name: "press", until: After(5e-3)), (name: "rub", drives: {"sphere": (z: Fixed)})]"#.to_owned(),
            "imposes motion at one time and a force at another",
        ),
    ] {
        let output = call("check", case, &["time.end=0.02", &phases, "output.views=0"], None);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{phases}: {text}");
        assert!(text.contains(said), "{phases}: {text}");
    }
}
