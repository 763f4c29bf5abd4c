//! Steps that grow where nothing moves, and shrink before a motion begins.

use crate::accuracy::{Folder, reported};
use std::collections::BTreeMap;

const G: f64 = 9.81;
const STEP: f64 = 1e-3;
/// Density of `verification_grain` times a depth of 1 m (kg/m^2).
const DENSITY: f64 = 1000.0;

/// Two disks on a floor, and one above them that is released at 0.5 s.
const DROP: &str = r#"(
    name: "a disk is dropped onto a stack", dimension: 2, time: (step: 1e-3, end: 1.2), gravity: [0.0, -9.81],
    materials: {"grain": "verification_grain"},
    solver: (tolerance: 1e-10, norm: Velocity),
    detection: (alert: 5e-3, skin: 0.02),
    interfaces: [(name: "grain", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "ball", material: "grain", position: [0.0, 0.7], shapes: [Balls([([0.0, 0.0], 0.1)])], mass: 1.0,
            dofs: (x: Fixed, y: Stages([(until: Some(0.5), drive: Fixed), (drive: Free)]), rz: Fixed),
        ),
    ],
    grains: [List(material: "grain", grains: [(at: [0.0, 0.1], radius: 0.1), (at: [0.0, 0.3], radius: 0.1)])],
    uncertainty: (repeats: 0),
    output: (frames: 0, views: 0, figures: false),
)"#;

/// A block on a floor, pushed slowly from 0.2 s on.
const SLIDE: &str = r#"(
    name: "a block is pushed slowly", dimension: 2, time: (step: 1e-3, end: 2.0), gravity: [0.0, -9.81],
    materials: {"grain": "verification_grain"},
    solver: (tolerance: 1e-10, norm: Velocity),
    detection: (alert: 5e-3, skin: 0.02),
    interfaces: [(name: "grain", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "block", material: "grain", position: [0.0, 0.1], shapes: [Balls([([0.0, 0.0], 0.1)])], mass: 1.0,
            dofs: (x: Velocity(Ramp(from: 0.0, to: 1e-3, start: 0.2, end: 0.3)), y: Free, rz: Fixed),
        ),
    ],
    uncertainty: (repeats: 0),
    output: (frames: 0, views: 0, figures: false),
)"#;

type Rows = Vec<BTreeMap<String, f64>>;

/// Runs a case, and reads its rows by the names of their columns, without units.
fn rows(folder: &Folder, case: &str, out: &str, sets: &[&str]) -> Rows {
    let path = folder.0.join("case.ron");
    std::fs::write(&path, case).unwrap();
    let done = folder.run(&path, out, sets);
    assert!(done.status.success(), "{}", reported(&done));
    let mut file = csv::Reader::from_path(folder.0.join(out).join("statistics.csv")).unwrap();
    let names: Vec<String> = file
        .headers()
        .unwrap()
        .iter()
        .map(|name| name.split(' ').next().unwrap().to_owned())
        .collect();
    let row = |record: csv::StringRecord| {
        names
            .iter()
            .cloned()
            .zip(record.iter().map(|x| x.parse().unwrap()))
            .collect()
    };
    file.records().map(|record| row(record.unwrap())).collect()
}

/// Whether a row ends at a time (s).
fn at(row: &BTreeMap<String, f64>, time: f64) -> bool {
    (row["time"] - time).abs() < 1e-9
}

/// A stack at rest carries its weight in steps of any length. A disk is released in the step of the
/// case in which the drive says so, falls on its parabola and lands in the step in which it has
/// fallen by its height.
#[test]
fn a_disk_that_is_dropped_onto_a_stack_at_rest_lands_when_it_should() {
    let folder = Folder::new("drop");
    let rows = rows(&folder, DROP, "drop", &["accuracy=0.03"]);
    let landing = 0.5 + (2.0f64 * 0.2 / G).sqrt();
    let carried = |row: &BTreeMap<String, f64>| -row["floor_fy"];
    let (rest, after): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row["time"] < 0.5 + 1e-9);
    let mass = 2.0 * DENSITY * std::f64::consts::PI * 0.1 * 0.1;
    for row in &rest {
        assert!((carried(row) / (mass * G) - 1.0).abs() < 1e-9, "{row:?}");
    }
    // Half a second takes a few steps, of which one ends at the event.
    assert!(
        rest.len() < 20 && at(rest[rest.len() - 1], 0.5),
        "{}",
        rest.len()
    );
    assert!(rest.iter().any(|row| row["step_length"] > 50.0 * STEP));
    assert!((after[0]["step_length"] - STEP).abs() < 1e-12);
    let (falls, landed): (Vec<_>, Vec<_>) =
        after.into_iter().partition(|row| row["time"] < landing);
    for row in &falls {
        let t = row["time"] - 0.5;
        assert!((row["ball_vy"] + G * t).abs() < 1e-9, "{row:?}");
        assert!(
            (row["ball_y"] - 0.7 + 0.5 * G * t * t).abs() < 1e-9,
            "{row:?}"
        );
        // The displacement is at most a part of the tenth of a radius that the accuracy permits.
        assert!(row["step_length"] * G * t < 0.01, "{row:?}");
    }
    let last = falls[falls.len() - 1];
    assert!(landing - last["time"] < 1.5 * STEP, "{last:?}");
    // The floor receives the momentum of the disk and the weights; the lost energy is that of the
    // fall.
    let stopping = &landed[..4];
    let received: f64 = stopping
        .iter()
        .map(|row| carried(row) * row["step_length"])
        .sum();
    let time = stopping[3]["time"] - last["time"];
    let momentum = -last["ball_vy"] + (mass + 1.0) * G * time;
    assert!(
        (received / momentum - 1.0).abs() < 1e-9,
        "{received} {momentum}"
    );
    let end = landed[landed.len() - 1];
    assert!((end["impact"] - G * 0.2).abs() < 1e-6, "{end:?}");
    assert!((carried(end) / ((mass + 1.0) * G) - 1.0).abs() < 1e-9);
    assert!(end["residual"].abs() < 1e-12 && end["step_length"] > 50.0 * STEP);
    let summary = folder.summary("drop");
    assert_eq!(
        (
            summary["trustworthy"].as_bool(),
            summary["accuracy"]["reached"].as_bool()
        ),
        (Some(true), Some(true))
    );
    assert!(summary["accuracy"]["grown"].as_f64().unwrap() > 0.8);
}

/// Kinks of a drive end steps, slow sliding is made in long steps, and the work is that of friction
/// over the path.
#[test]
fn a_slow_drive_is_followed_in_long_steps() {
    let folder = Folder::new("slide");
    let rows = rows(
        &folder,
        SLIDE,
        "slide",
        &["accuracy=(of: Forces, share: 0.05)"],
    );
    assert!(rows.len() < 150, "{}", rows.len());
    for kink in [0.2, 0.3] {
        let k = rows
            .iter()
            .position(|row| at(row, kink))
            .expect("a row at each kink");
        assert!(
            (rows[k + 1]["step_length"] - STEP).abs() < 1e-12,
            "{:?}",
            rows[k + 1]
        );
    }
    let ramp = rows
        .iter()
        .filter(|row| row["time"] > 0.2 && row["time"] < 0.3);
    assert!(ramp.map(|row| row["step_length"]).fold(0.0, f64::max) < 0.1 / 20.0 + 1e-9);
    let end = &rows[rows.len() - 1];
    let path = 1e-3 * (0.5 * 0.1 + 1.7);
    assert!((end["block_x"] - path).abs() < 1e-12, "{end:?}");
    assert!(
        (end["friction"] / (0.3 * G * path) - 1.0).abs() < 1e-9,
        "{end:?}"
    );
    assert!(end["step_length"] > 20.0 * STEP && end["residual"].abs() < 1e-14);
}

/// Rows every given number of steps of the case are at equal times as without growth, and a largest
/// step is kept.
#[test]
fn records_stay_where_they_are_and_the_largest_step_is_kept() {
    let folder = Folder::new("records");
    let every = rows(
        &folder,
        DROP,
        "every",
        &["accuracy=0.03", "output.every=30"],
    );
    let times: Vec<f64> = every.iter().map(|row| row["time"]).collect();
    assert_eq!(times.len(), 40);
    for (k, time) in times.iter().enumerate() {
        assert!((time - 0.03 * (k + 1) as f64).abs() < 1e-9, "{time}");
    }
    let bounded = rows(
        &folder,
        DROP,
        "bounded",
        &["accuracy=(of: Forces, largest_step: 7.5e-3)"],
    );
    let longest = bounded
        .iter()
        .map(|row| row["step_length"])
        .fold(0.0, f64::max);
    assert!((longest - 7e-3).abs() < 1e-12, "{longest}");
    let fixed = rows(
        &folder,
        DROP,
        "fixed",
        &["accuracy=(of: Forces, largest_step: 1e-3)"],
    );
    let plain = rows(&folder, DROP, "plain", &[]);
    assert_eq!(fixed.len(), plain.len());
    for (a, b) in fixed.iter().zip(&plain) {
        assert!(b.iter().all(|(name, value)| a[name] == *value));
    }
}

/// Rows are equal for any number of threads.
#[test]
fn steps_that_grow_have_the_same_bits_on_any_number_of_threads() {
    let folder = Folder::new("threads");
    let case = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("cases/benchmarks/disks_box_5000.ron");
    let mut read = Vec::new();
    for threads in ["1", "3"] {
        let done = std::process::Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["run", "--threads", threads, "--no-report", "--out"])
            .arg(folder.0.join(threads))
            .arg(&case)
            .args(
                [
                    "time.end=0.02",
                    "solver.tolerance=1e-3",
                    "accuracy=0.2",
                    "output.frames=0",
                    "output.views=1",
                    "output.figures=false",
                ]
                .iter()
                .flat_map(|s| ["--set", s]),
            )
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", reported(&done));
        assert!(
            folder.summary(threads)["accuracy"]["grown"]
                .as_f64()
                .unwrap()
                > 0.5
        );
        read.push(std::fs::read(folder.0.join(threads).join("statistics.csv")).unwrap());
    }
    assert!(read[0] == read[1]);
}

/// Invalid bounds are rejected with the field and its valid values.
#[test]
fn bounds_that_cannot_be_are_refused() {
    let folder = Folder::new("refused");
    let path = folder.0.join("case.ron");
    std::fs::write(&path, DROP).unwrap();
    for (set, words) in [
        (
            "accuracy=(share: 0.03, largest_step: 1e-4)",
            ["largest_step", "at least time.step"],
        ),
        (
            "accuracy=(of: Forces, finest_step: 1e-4)",
            ["finest_step", "steps only grow"],
        ),
    ] {
        let refused = folder.run(&path, "refused", &[set]);
        assert_eq!(refused.status.code(), Some(2));
        let text = reported(&refused);
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    }
}
