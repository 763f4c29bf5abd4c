//! Imposed motion: bodies are at all times where their functions of time place them, and the work
//! of the motion is booked.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::record::encoding::{decode, encode};
use fretwork::record::run::{RunOptions, run};
use fretwork::scene::LoadedCase;
use fretwork::step::Simulation;
use nalgebra::Vector3;
use std::f64::consts::TAU;

const H: f64 = 1e-3;

fn text(dimension: usize, lines: &str) -> String {
    let interfaces = match lines.contains("interfaces:") {
        true => "",
        false => "interfaces: [],",
    };
    format!(
        r#"(
    name: "drives", dimension: {dimension},
    solver: (tolerance: 1e-13, norm: Velocity, max_iterations: 100000, test_every: 1),
    materials: {{"glass": "glass_bead"}},
    {interfaces}
    {lines}
)"#
    )
}

fn loaded(dimension: usize, lines: &str) -> LoadedCase {
    scene::loaded_text(&text(dimension, lines))
}

fn build<S: Space>(lines: &str) -> Simulation<S> {
    scene::text(&text(S::D, lines))
}

/// One body of 3 kg with this drive on one degree of freedom.
fn driven<S: Space>(dof: &str, drive: &str, theta: f64, more: &str) -> Simulation<S> {
    let at = vec!["0.25"; S::D].join(", ");
    build(&format!(
        r#"time: (step: {H:?}, end: 1000.0, theta: {theta:?}),
        bodies: [(name: "body", material: "glass", shapes: [Balls([([{}], 0.01)])], position: [{at}],
                  mass: 3.0, inertia: 2.0, dofs: ({dof}: {drive}))],
        {more}"#,
        vec!["0.0"; S::D].join(", ")
    ))
}

fn step<S: Space>(s: &mut Simulation<S>) {
    s.step().unwrap_or_else(|e| panic!("{e}"));
}

type Way = fn(f64) -> f64;

/// Drives, the paths that they impose, and the initial velocities.
const DRIVES: [(&str, Way, f64); 9] = [
    (
        "Displacement(Sine(amplitude: 0.01, frequency: 20.0))",
        |t| 0.01 * (TAU * 20.0 * t).sin(),
        0.01 * TAU * 20.0,
    ),
    (
        "Displacement(Sine(amplitude: 0.01, frequency: 20.0, phase: 0.5, offset: 3.0, start: 0.0313))",
        |t| 0.01 * ((TAU * 20.0 * (t - 0.0313).max(0.0) + 0.5).sin() - 0.5f64.sin()),
        0.0,
    ),
    (
        "Displacement(Ramp(from: 0.0, to: 0.1, start: 0.0, end: 0.1))",
        |t| t.min(0.1),
        1.0,
    ),
    (
        "Displacement(Ramp(from: 1.0, to: 0.9, start: 0.0302, end: 0.0709))",
        |t| -0.1 * ((t - 0.0302) / 0.0407).clamp(0.0, 1.0),
        0.0,
    ),
    // There are corners at ends of steps (0.03 and 0.1), within steps, several within one step, and
    // a jump.
    (
        "Displacement(Table([(0.0, 0.0), (0.03, 0.06), (0.0504, 0.02), (0.0811, 0.0), (0.0813, 0.01), (0.0815, -0.03), (0.1, 0.0), (0.1200001, 0.0), (0.1200002, 0.05)]))",
        |t| {
            const P: [(f64, f64); 9] = [
                (0.0, 0.0),
                (0.03, 0.06),
                (0.0504, 0.02),
                (0.0811, 0.0),
                (0.0813, 0.01),
                (0.0815, -0.03),
                (0.1, 0.0),
                (0.1200001, 0.0),
                (0.1200002, 0.05),
            ];
            let piece = P.windows(2).find(|w| t < w[1].0);
            piece.map_or(0.05, |w| {
                w[0].1 + (w[1].1 - w[0].1) / (w[1].0 - w[0].0) * (t - w[0].0)
            })
        },
        2.0,
    ),
    ("Velocity(Constant(-0.7))", |t| -0.7 * t, -0.7),
    (
        "Velocity(Sine(amplitude: 0.3, frequency: 20.0, phase: 0.4, offset: 0.1))",
        |t| 0.1 * t - 0.3 / (TAU * 20.0) * ((TAU * 20.0 * t + 0.4).cos() - 0.4f64.cos()),
        0.1 + 0.3 * 0.389_418_342_308_650_5,
    ),
    (
        "Velocity(Ramp(from: -1.0, to: 1.0, start: 0.0204, end: 0.0604))",
        |t| {
            let u = (t - 0.0204).clamp(0.0, 0.04);
            -t + 25.0 * u * u + 2.0 * (t - 0.0604).max(0.0)
        },
        -1.0,
    ),
    // The velocity jumps at 0.05 and 0.0702.
    (
        "Velocity(Table([(0.0, 1.0), (0.05, 1.0), (0.05000000001, -1.0), (0.0702, -1.0), (0.07020000001, 0.5)]))",
        |t| t.min(0.05) - (t - 0.05).clamp(0.0, 0.0202) + 0.5 * (t - 0.0702).max(0.0),
        1.0,
    ),
];

/// Largest distance from the path over the steps of 0.15 s; the ledger must close in each.
fn off<S: Space>(mut s: Simulation<S>, way: Way, at: impl Fn(&Simulation<S>) -> f64) -> f64 {
    let mut worst = at(&s).abs();
    for _ in 0..150 {
        step(&mut s);
        worst = worst.max((at(&s) - way(s.state.time)).abs());
        let e = &s.state.energy;
        assert!(e.residual.abs() <= 1e-13 * e.scale, "{e:?}");
    }
    worst
}

#[test]
fn imposed_translations_are_on_their_paths() {
    for (drive, way, first) in DRIVES {
        // The jumps of the last table last 1e-11 s.
        let bound = if drive.contains("0.05000000001") {
            5e-11
        } else {
            1e-14
        };
        for theta in [0.5, 0.7, 1.0] {
            let s = driven::<Dim2>("x", drive, theta, "gravity: [3.0, -9.81],");
            // In motion from the beginning, the velocity is exact to the order of the step.
            let v = s.state.bodies.velocity[0].x;
            let order = if theta == 0.5 { 2e-3 } else { 0.1 };
            assert!(
                (v - first).abs() <= order * first.abs().max(0.1),
                "{drive}: {v} {first}"
            );
            assert!((s.state.energy.initial_kinetic - 1.5 * v * v).abs() < 1e-15);
            let worst = off(s, way, |s| s.state.bodies.position[0].x - 0.25);
            assert!(worst <= bound, "{drive}, theta {theta}: {worst:e}");
            let s = driven::<Dim3>("z", drive, theta, "gravity: [0.0, 2.0, -9.81],");
            let worst = off(s, way, |s| s.state.bodies.position[0].z - 0.25);
            assert!(worst <= bound, "{drive}, theta {theta}: {worst:e}");
        }
    }
}

#[test]
fn imposed_rotations_are_on_their_paths() {
    for (drive, way, first) in DRIVES {
        let bound = if drive.contains("0.05000000001") {
            5e-11
        } else {
            1e-14
        };
        for theta in [0.5, 1.0] {
            let s = driven::<Dim2>("rz", drive, theta, "");
            assert!((s.state.bodies.spin[0].x - first).abs() <= 0.1 * first.abs().max(0.1));
            let worst = off(s, way, |s| s.state.bodies.rotation[0]);
            assert!(worst <= bound, "{drive}, theta {theta}: {worst:e}");
            for (name, axis) in [("rx", Vector3::x()), ("ry", Vector3::y())] {
                let s = driven::<Dim3>(name, drive, theta, "");
                let worst = off(s, way, |s| {
                    s.state.bodies.rotation[0].scaled_axis().dot(&axis)
                });
                assert!(worst <= bound, "{drive}, theta {theta}: {worst:e}");
            }
        }
    }
}

/// The body is free under a force, then on a path that begins at its position, then at a velocity,
/// then fixed: the work of the drives is the kinetic energy that they supply.
#[test]
fn stages_take_over_where_the_body_is() {
    let mut s = driven::<Dim2>(
        "x",
        "Stages([(until: Some(0.02), drive: Force(Constant(6.0))),
                 (until: Some(0.04), drive: Displacement(Sine(amplitude: 0.01, frequency: 20.0))),
                 (until: Some(0.0604), drive: Displacement(Ramp(from: 0.0, to: 1.0, start: 0.0, end: 1.0))),
                 (until: Some(0.08), drive: Velocity(Constant(-0.5))),
                 (drive: Fixed)])",
        0.5,
        "",
    );
    let sine = |t: f64| 0.01 * (TAU * 20.0 * t).sin();
    let place = |t: f64| {
        let (fallen, end) = (0.5 * 2.0 * t.min(0.02).powi(2), |a: f64| t.clamp(a, 1.0));
        let turned = sine(end(0.02).min(0.04)) - sine(0.02);
        // A step belongs to the stage of its midpoint.
        let pushed = end(0.04).min(0.06) - 0.04;
        0.25 + fallen + turned + pushed - 0.5 * (end(0.06).min(0.08) - 0.06)
    };
    for _ in 0..100 {
        step(&mut s);
        let (x, expected) = (s.state.bodies.position[0].x, place(s.state.time));
        assert!(
            (x - expected).abs() < 1e-15,
            "{} s: {x} {expected}",
            s.state.time
        );
        let e = &s.state.energy;
        assert!(e.residual.abs() <= 1e-14 * e.scale, "{e:?}");
    }
    assert_eq!(s.state.energy.kinetic, 0.0);
    assert!(s.state.energy.external_work.abs() < 1e-14);
}

/// Functions of a phase use its own time; a repeated phase begins again at the position of the
/// body.
#[test]
fn phases_begin_where_the_body_is() {
    let mut s = driven::<Dim2>(
        "y",
        "Free",
        0.5,
        r#"phases: [
            (name: "go", until: After(0.0303), drives: {"body": (x: Displacement(Sine(amplitude: 0.01, frequency: 20.0)))}),
            (name: "on", until: Steps(40), drives: {"body": (x: Velocity(Ramp(from: 2.0, to: 0.0, start: 0.0, end: 0.0205)))}),
            (name: "tap", until: Steps(20), drives: {"body": (x: Displacement(Table([(0.0, 0.0), (0.0055, 0.01), (0.011, 0.0)])))},
             repeat: (times: 3)),
        ],"#,
    );
    assert!((s.state.bodies.velocity[0].x / (0.01 * TAU * 20.0) - 1.0).abs() < 2e-3);
    assert!(s.state.energy.initial_kinetic > 0.0);
    let mut started = s.state.bodies.position[0].x;
    for _ in 0..130 {
        step(&mut s);
        let begun = s.state.control.begun();
        let now = &begun[begun.len() - 1];
        let t = s.state.time - now.start;
        let way = match now.name.as_str() {
            "go" => 0.01 * (TAU * 20.0 * t).sin(),
            "on" => {
                let u = t.min(0.0205);
                2.0 * u - u * u / 0.0205
            }
            _ => 0.01 * (1.0 - (t / 0.0055 - 1.0).abs()).max(0.0),
        };
        let x = s.state.bodies.position[0].x;
        assert!((x - started - way).abs() < 2e-15, "{}: {x}", s.state.time);
        assert!(s.state.energy.residual.abs() <= 1e-13 * s.state.energy.scale);
        if now.end.is_some() {
            started = x;
        }
    }
    assert!(s.phases_finished());
}

/// After 100,000 steps bodies are at their positions to the precision of a time and an angle of
/// that size.
#[test]
fn a_long_run_does_not_drift() {
    const STEPS: u32 = 100_000;
    for (drive, way) in [(DRIVES[0].0, DRIVES[0].1), (DRIVES[6].0, DRIVES[6].1)] {
        let mut s = driven::<Dim2>("x", drive, 0.5, "");
        let mut worst = 0.0f64;
        for n in 1..=STEPS {
            step(&mut s);
            let t = f64::from(n) * H;
            assert!((s.state.time - t).abs() <= 2.0 * f64::EPSILON * t);
            worst = worst.max((s.state.bodies.position[0].x - 0.25 - way(t)).abs());
        }
        let angle = TAU * 20.0 * f64::from(STEPS) * H;
        let bound = 4.0 * f64::EPSILON * (0.01 * angle + way(s.state.time).abs());
        assert!(worst <= bound, "{drive}: {worst:e}, {bound:e}");
    }
    // The velocity is a table of a sawtooth, whose integral is also tested.
    let points: Vec<String> = (0..=5000)
        .map(|k| {
            format!(
                "({:?}, {:?})",
                0.0203 * f64::from(k),
                0.3 * f64::from(k % 2)
            )
        })
        .collect();
    let drive = format!("Velocity(Table([{}]))", points.join(", "));
    let mut s = driven::<Dim2>("x", &drive, 0.5, "");
    for _ in 0..STEPS {
        step(&mut s);
    }
    let teeth = (s.state.time / 0.0203).floor();
    let left = s.state.time - 0.0203 * teeth;
    let rising = teeth % 2.0 == 0.0;
    let part = 0.5 * 0.3 * left * left / 0.0203;
    let way = 0.15 * 0.0203 * teeth + if rising { part } else { 0.3 * left - part };
    let x = s.state.bodies.position[0].x - 0.25;
    assert!((x - way).abs() < 1e-13 * way, "{x} {way}");
}

/// A body that moves from time zero has its energy before the first step; a corner of the path
/// costs m (v_s^2 - v_e^2)/2.
#[test]
fn jumps_of_the_velocity_are_work_of_the_drive() {
    let table = "Displacement(Table([(0.0, 0.0), (0.01, 0.02), (0.03, -0.08)]))";
    for theta in [0.5, 1.0] {
        let mut s = driven::<Dim2>("x", table, theta, "");
        let expected = [(10, 2.0, 0.0), (20, -5.0, 1.5 * 21.0), (5, 0.0, -1.5 * 4.0)];
        for (steps, v, work) in expected {
            for _ in 0..steps {
                step(&mut s);
                assert!((s.state.bodies.velocity[0].x - v).abs() < 1e-12);
                assert!(
                    (s.state.energy.external_work - work).abs() < 1e-11,
                    "{:?}",
                    s.state.energy
                );
                assert!((s.state.energy.kinetic - 1.5 * v * v).abs() < 1e-11);
            }
        }
        assert!((s.state.energy.initial_kinetic - 6.0).abs() < 1e-12);
    }
}

/// A wall that moves from time zero hits a touching body with its velocity: the body leaves with
/// (1 + e) V.
#[test]
fn a_wall_hits_with_the_velocity_it_starts_with() {
    let mut s: Simulation<Dim2> = build(
        r#"time: (step: 1e-3, end: 1.0),
        interfaces: [(name: "all", between: ("glass", "glass"), contact: "frictionless",
                      parameters: (contact: {"restitution_n": 0.6}))],
        bodies: [(name: "wall", material: "glass", shapes: [HalfSpace(normal: [1.0, 0.0])],
                  dofs: (x: Displacement(Ramp(from: 0.0, to: 1.0, start: 0.0, end: 2.0))))],
        grains: [List(material: "glass", grains: [(at: [0.01, 0.0], radius: 0.01)])],"#,
    );
    let grain = s.state.bodies.grains().next().unwrap();
    for _ in 0..3 {
        step(&mut s);
        let v = s.state.bodies.velocity[grain].x;
        assert!((v - 1.6 * 0.5).abs() < 1e-12, "{v}");
        assert!(s.state.energy.residual.abs() < 1e-13 * s.state.energy.scale);
    }
}

/// A block held by friction on a floor that oscillates smoothly moves with it: after ten periods it
/// has slipped by less than the square of the step's angle.
#[test]
fn what_sticks_goes_along() {
    let (a, f) = (1e-3, 5.0);
    let slip = |h: f64, theta: f64| {
        let mut s: Simulation<Dim2> = build(&format!(
            r#"time: (step: {h:?}, end: 10.0, theta: {theta:?}), gravity: [0.0, -9.81],
            interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {{"mu": 0.5}}))],
            bodies: [
                (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])],
                 dofs: (x: Displacement(Sine(amplitude: {a:?}, frequency: {f:?}, phase: {:?})))),
                (name: "block", material: "glass", position: [0.0, 0.01],
                 shapes: [Polygon(points: [(-0.02, -0.01), (0.02, -0.01), (0.02, 0.01), (-0.02, 0.01)])],
                 dofs: (x: Free, y: Free, rz: Free)),
            ],"#,
            0.25 * TAU
        ));
        let body = |s: &Simulation<Dim2>, k: usize| {
            s.state.bodies.position[s.state.bodies.driven[k].body as usize].x
        };
        let (floor, block) = (body(&s, 0), body(&s, 1));
        let steps = (10.0 / f / h).round() as u32;
        let mut worst = 0.0f64;
        for _ in 0..steps {
            step(&mut s);
            worst = worst.max((body(&s, 1) - block - (body(&s, 0) - floor)).abs());
        }
        assert!(s.state.energy.residual.abs() < 1e-10 * s.state.energy.scale);
        worst
    };
    for h in [2e-3f64, 1e-3] {
        let angle = TAU * f * h;
        let found = slip(h, 0.5);
        println!(
            "slip {found:e} m at h = {h:e}, {:e} of A (w h)^2",
            found / (a * angle * angle)
        );
        assert!(found < 0.05 * a * angle * angle, "{found:e}");
    }
}

/// A state saved in the middle of stages, of the integral of a table and of a rotation continues
/// bit by bit.
#[test]
fn a_kept_state_goes_on_along_its_paths() {
    let saw = "Velocity(Table([(0.0, 0.1), (0.0123, 0.4), (0.0247, -0.3), (0.0555, 0.2), (0.0809, 0.1)]))";
    let lines = format!(
        r#"time: (step: 1e-3, end: 10.0),
        bodies: [(name: "body", material: "glass", shapes: [Balls([([0.0, 0.0], 0.01)])], mass: 3.0, inertia: 2.0, dofs: (
            x: Stages([(until: Some(0.0401), drive: {saw}), (drive: {})]), y: {saw}, rz: {}))],"#,
        DRIVES[1].0, DRIVES[0].0
    );
    let mut one: Simulation<Dim2> = build(&lines);
    for at in [7, 30, 45] {
        while one.state.steps < at {
            step(&mut one);
        }
        let mut other: Simulation<Dim2> = build(&lines);
        let bytes = encode(&one.state).unwrap();
        assert!(other.restore(decode(&bytes).unwrap()));
        let mut alone: Simulation<Dim2> = build(&lines);
        for _ in 0..at {
            step(&mut alone);
        }
        for _ in 0..60 {
            step(&mut other);
            step(&mut alone);
            let state = |s: &Simulation<Dim2>| {
                let b = &s.state.bodies;
                let all = [
                    b.position[0].x,
                    b.position[0].y,
                    b.rotation[0],
                    b.velocity[0].x,
                ];
                let more = [
                    b.spin[0].x,
                    s.state.time,
                    s.state.energy.external_work,
                    s.state.energy.kinetic,
                ];
                [all, more]
                    .concat()
                    .iter()
                    .map(|x| x.to_bits())
                    .collect::<Vec<_>>()
            };
            assert_eq!(state(&other), state(&alone));
        }
    }
}

/// The slide of a friction test is the path of its body, and summaries name the drives that the
/// step cannot follow.
#[test]
fn slides_are_the_way_and_summaries_tell_of_coarse_drives() {
    let case = |frequency: f64| {
        loaded(
            2,
            &format!(
                r#"time: (step: 1e-3, end: 0.1), gravity: [0.0, -9.81],
            interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {{"mu": 0.3}}))],
            bodies: [
                (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])]),
                (name: "pin", material: "glass", shapes: [Balls([([0.0, 0.0], 0.01)])], position: [0.0, 0.01],
                 dofs: (x: Displacement(Sine(amplitude: 0.01, frequency: {frequency:?})), y: Free)),
            ],
            friction: (body: "pin", along: 0, normal: 1),
            output: (frames: 0, views: 0, figures: false, every: 1),"#
            ),
        )
    };
    let ran = |frequency: f64| {
        let loaded = case(frequency);
        let built = scene::built(&loaded);
        let name = format!("fretwork-drives-{}-{frequency}", std::process::id());
        let out = std::env::temp_dir().join(name);
        let options = RunOptions {
            out: out.clone(),
            threads: 1,
        };
        let summary = run(&loaded, built, &options, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
        let rows = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
        std::fs::remove_dir_all(out).ok();
        (summary, rows)
    };
    let (summary, rows) = ran(20.0);
    assert!(
        summary.run.warnings.iter().all(|w| !w.contains("DRIVE")),
        "{:?}",
        summary.run.warnings
    );
    let mut lines = rows.lines().filter(|l| !l.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| {
        names
            .iter()
            .position(|n| n.split(' ').next() == Some(name))
            .unwrap()
    };
    let (time, delta) = (column("time"), column("delta"));
    let mut seen = 0;
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let way = 0.01 * (TAU * 20.0 * row[time]).sin();
        assert!((row[delta] - way).abs() < 1e-15, "{} {way}", row[delta]);
        seen += 1;
    }
    assert_eq!(seen, 100);
    for (frequency, heading, words) in [
        (100.0, "COARSE DRIVE", "only 10.0 steps a period"),
        (1000.0, "ALIASED DRIVE", "ALIASES"),
    ] {
        let (summary, _) = ran(frequency);
        let reported = summary.run.warnings.iter().find(|w| w.starts_with(heading));
        let reported = reported.expect("a warning");
        assert!(
            reported.contains("`pin` along x") && reported.contains(words),
            "{reported}"
        );
        assert!(summary.text(false).contains(heading));
        // A coarse path is a note; another frequency than the imposed one is a reason not to trust
        // the run.
        let aliased = heading == "ALIASED DRIVE";
        assert_eq!(
            summary.run.reasons.iter().any(|r| r.starts_with(heading)),
            aliased
        );
        let name = format!("fretwork-drives-{}-{frequency}.ron", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, case(frequency).source.text()).unwrap();
        let mut check = std::process::Command::new(env!("CARGO_BIN_EXE_fretwork"));
        let output = check
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["check", "--verbose"])
            .arg(&path)
            .output()
            .unwrap();
        std::fs::remove_file(path).ok();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && said.contains(words), "{said}");
    }
}
