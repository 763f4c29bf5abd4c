//! Changes during a run: gravity, pressures, gates, phases; and drums. All are compared with closed
//! forms.

use crate::scene;
use crate::stepping::steps;
use fretwork::bodies::Bodies;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::f64::consts::PI;
use std::path::Path;

const G: f64 = 9.81;

/// A case of these lines; grains of glass with friction between them.
fn case(dimension: usize, lines: &str) -> String {
    format!(
        r#"(
    name: "programme",
    dimension: {dimension},
    solver: (tolerance: 1e-10),
    materials: {{"glass": "glass_bead"}},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {{"mu": 0.5}}))],
    {lines}
)"#
    )
}

fn build<S: Space>(lines: &str) -> Simulation<S> {
    scene::text(&case(S::D, lines))
}

fn refused(lines: &str, said: &str) {
    let loaded = load_text("refused.ron", &case(2, lines), Path::new("."), &[]);
    let error = match loaded.and_then(|loaded| loaded.build(&search_path())) {
        Err(e) => e.to_string(),
        Ok(_) => panic!("accepted: {lines}"),
    };
    assert!(error.contains(said), "{error}");
}

fn body<S: Space>(bodies: &Bodies<S>, name: &str) -> usize {
    let found = bodies.driven.iter().find(|d| d.name == name);
    found.map_or_else(|| panic!("no body {name}"), |d| d.body as usize)
}

fn close(obtained: f64, expected: f64, tolerance: f64) {
    assert!(
        (obtained - expected).abs() <= tolerance,
        "{obtained} in place of {expected} within {tolerance}"
    );
}

/// A free grain under gravity that rotates by a right angle in a second: v = g (2/pi) (1, -1), and
/// the ledger has the work.
#[test]
fn gravity_turns() {
    let mut s = build::<Dim2>(
        "time: (step: 1e-3, end: 1.0), gravity: [0.0, -9.81],
        gravity_drive: Turned(angle: Ramp(from: 0.0, to: 1.5707963267948966, start: 0.0, end: 1.0)),
        grains: [List(material: \"glass\", grains: [(at: [0.0, 0.0], radius: 0.01)])]",
    );
    steps(&mut s, 1000);
    let v = s.state.bodies.velocity[0];
    close(v.x, G * 2.0 / PI, 1e-5);
    close(v.y, -G * 2.0 / PI, 1e-5);
    assert!(s.state.energy.relative_residual() < 1e-12);
}

/// A lid under p between walls that separate at V: v = p (L0 t + V t^2/2)/m.
#[test]
fn a_servo_follows_the_length() {
    let (p, l0, speed, m, t) = (-200.0, 0.5, 0.3, 4.0, 0.4);
    let mut s = build::<Dim2>(
        "time: (step: 1e-4, end: 1.0),
        bodies: [
            (name: \"left\", material: \"glass\", shapes: [HalfSpace(normal: [1.0, 0.0])]),
            (name: \"right\", material: \"glass\", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [0.5, 0.0],
             dofs: (x: Velocity(Constant(0.3)))),
            (name: \"lid\", material: \"glass\", shapes: [HalfSpace(normal: [0.0, -1.0])], mass: 4.0,
             dofs: (y: Pressure(value: Constant(-200.0), between: [(\"left\", \"right\")]))),
        ]",
    );
    steps(&mut s, 4000);
    let lid = body(&s.state.bodies, "lid");
    let exact = p * (l0 * t + speed * t * t / 2.0) / m;
    close(s.state.bodies.velocity[lid].y, exact, 1e-4 * exact.abs());
    assert!(s.state.energy.relative_residual() < 1e-12);
    refused(
        "time: (step: 1e-3, end: 1.0), bodies: [(name: \"lid\", material: \"glass\", mass: 1.0,
            shapes: [HalfSpace(normal: [0.0, -1.0])], dofs: (y: Pressure(value: Constant(-1.0))))]",
        "a pressure needs the length along x",
    );
}

/// A grain rests on a gate, which vanishes at 0.1 s; then it falls freely.
#[test]
fn a_gate_vanishes() {
    let mut s = build::<Dim2>(
        "time: (step: 1e-3, end: 1.0), gravity: [0.0, -9.81],
        bodies: [(name: \"gate\", material: \"glass\", vanishes: 0.1, shapes: [HalfSpace(normal: [0.0, 1.0])])],
        grains: [List(material: \"glass\", grains: [(at: [0.0, 0.01], radius: 0.01)])]",
    );
    steps(&mut s, 100);
    close(s.state.bodies.position[0].y, 0.01, 1e-12);
    steps(&mut s, 200);
    close(s.state.bodies.position[0].y, 0.01 - 0.5 * G * 0.04, 1e-9);
    assert!(s.state.network.contacts.is_empty());
}

/// A block is pushed for 0.2 s without friction, then slides freely with a friction of 0.3 to rest:
/// it takes v/(mu g), over a path of v^2/(2 mu g).
#[test]
fn phases_hand_the_state_over() {
    let mut s = build::<Dim2>(
        "time: (step: 1e-3, end: 9.0), gravity: [0.0, -9.81],
        bodies: [
            (name: \"floor\", material: \"glass\", shapes: [HalfSpace(normal: [0.0, 1.0])]),
            (name: \"block\", material: \"glass\", shapes: [Balls([([0.0, 0.01], 0.01)])],
             dofs: (y: Free)),
        ],
        phases: [
            (name: \"push\", friction: {\"all\": 0.0}, until: After(0.2),
             drives: {\"block\": (x: Velocity(Constant(1.0)))}),
            (name: \"slide\", friction: {\"all\": 0.3}, until: Steps(400), drives: {\"block\": (x: Free)}),
            (name: \"move\", until: Time(0.8),
             drives: {\"block\": (x: Velocity(Ramp(from: 0.0, to: 2.0, start: 0.1, end: 0.2)))}),
        ]",
    );
    let block = body(&s.state.bodies, "block");
    let mut places = Vec::new();
    while !s.phases_finished() {
        steps(&mut s, 1);
        if s.state
            .control
            .begun()
            .last()
            .is_some_and(|b| b.end.is_some())
        {
            places.push(s.state.bodies.position[block].x);
        }
    }
    let slid = 1.0 / (2.0 * 0.3 * G);
    close(places[0], 0.2, 1e-14);
    close(places[1] - places[0], slid, 1e-3);
    // The ramp uses the time since the phase began: 0.1 s of rest, then 0.1 s to 2 m/s.
    close(places[2] - places[1], 0.5 * 2.0 * 0.1, 1e-14);
    let begun = s.state.control.begun();
    let ends: Vec<_> = begun.iter().map(|b| b.ended_by).collect();
    assert_eq!(ends, [Some("duration"), Some("steps"), Some("time")]);
    close(begun[2].start, 0.6, 1e-9);
    close(s.state.time, 0.8, 1e-9);
    assert!(s.state.energy.relative_residual() < 1e-9);
}

/// A grain falls by h: rest comes after the fall, sqrt(2 h/g), and `held`.
#[test]
fn a_phase_ends_at_rest() {
    let mut s = build::<Dim2>(
        "time: (step: 1e-4, end: 9.0), gravity: [0.0, -9.81],
        bodies: [(name: \"floor\", material: \"glass\", shapes: [HalfSpace(normal: [0.0, 1.0])])],
        grains: [List(material: \"glass\", grains: [(at: [0.0, 0.11], radius: 0.01)])],
        phases: [(name: \"fall\", until: AtRest(share: 1e-4, held: 0.02))]",
    );
    while !s.phases_finished() {
        steps(&mut s, 1);
    }
    close(s.state.time, (2.0 * 0.1 / G).sqrt() + 0.02, 5e-4);
    assert_eq!(s.state.control.begun()[0].ended_by, Some("rest"));
}

#[test]
fn phases_that_cannot_be_followed_are_refused() {
    let head = "time: (step: 1e-3, end: 1.0), bodies: [(name: \"floor\", material: \"glass\",
        shapes: [HalfSpace(normal: [0.0, 1.0])])], phases: ";
    for (phases, said) in [
        ("[(name: \"a\"), (name: \"b\")]", "so it needs `until`"),
        (
            "[(name: \"a\", open: [\"flor\"])]",
            "there is no body `flor`",
        ),
        (
            "[(name: \"a\", friction: {\"al\": 0.1})]",
            "there is no interface `al`",
        ),
        (
            "[(name: \"a\", friction: {\"all\": -1.0})]",
            "`mu` must lie in",
        ),
        (
            "[(name: \"a\", drives: {\"floor\": (rx: Fixed)})]",
            "there is no rx",
        ),
        (
            "[(name: \"a\", drives: {\"floor\": (x: Free)})]",
            "needs a `mass`",
        ),
        (
            "[(name: \"a\", until: AtRest(share: 1e-4, held: 0.1))]",
            "without gravity",
        ),
        (
            "[(name: \"a\", until: AtRest(held: 0.1))]",
            "rest needs a measure",
        ),
        (
            "[(name: \"a\", until: After(-1.0))]",
            "a duration must be positive",
        ),
        (
            "[(name: \"a\", gravity: [1.0])]",
            "one finite number an axis",
        ),
    ] {
        refused(&format!("{head}{phases}"), said);
    }
}

/// In a drum that rotates at W a disk rolls at a fixed position at the lowest point with the spin W
/// R/r.
#[test]
fn a_disk_rolls_in_a_drum() {
    let mut s = build::<Dim2>(
        "time: (step: 1e-3, end: 9.0), gravity: [0.0, -9.81],
        bodies: [(name: \"drum\", material: \"glass\", shapes: [Drum(radius: 0.2)], dofs: (rz: Velocity(Constant(3.0))))],
        grains: [List(material: \"glass\", grains: [(at: [0.0, -0.15], radius: 0.05, spin: [12.0])])]",
    );
    steps(&mut s, 500);
    close(s.state.bodies.spin[0][0], 12.0, 1e-3);
    close(s.state.bodies.position[0].x, 0.0, 1e-5);
    let drum = s.state.received[0];
    // The drum carries the weight; nothing is dragged.
    let weight = s.state.bodies.mass[0] * G * s.options.scheme.h;
    close(drum.0.y / weight, -1.0, 1e-4);
    close(drum.1[0] / weight / 0.2, 0.0, 1e-4);
}

/// A sphere that rolls in a fixed cylinder oscillates like a pendulum of length 7/5 (R - r).
#[test]
fn a_sphere_swings_in_a_cylinder() {
    let (big, small, angle) = (0.2, 0.02, 0.05f64);
    let reach = big - small;
    let (x, z) = (reach * angle.sin(), -reach * angle.cos());
    let mut s = build::<Dim3>(&format!(
        "time: (step: 1e-4, end: 9.0), gravity: [0.0, 0.0, -9.81],
        bodies: [(name: \"drum\", material: \"glass\", shapes: [Drum(radius: 0.2, axis: 1)])],
        grains: [List(material: \"glass\", grains: [(at: [{x:?}, 0.3, {z:?}], radius: 0.02)])]"
    ));
    let period = 2.0 * PI * (7.0 / 5.0 * reach / G).sqrt();
    let mut before = (0.0, x);
    while s.state.bodies.position[0].x > 0.0 {
        before = (s.state.time, s.state.bodies.position[0].x);
        steps(&mut s, 1);
    }
    let now = (s.state.time, s.state.bodies.position[0].x);
    let crossing = before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1);
    close(crossing / (0.25 * period), 1.0, 2e-3);
    close(s.state.bodies.position[0].y, 0.3, 1e-9);
}

/// A block slides to and fro under its weight in five cycles of a group of two phases: it ends at
/// its initial position, and friction has dissipated mu m g along the whole path.
#[test]
fn a_group_of_phases_is_repeated() {
    let (stroke, cycles) = (0.02, 5);
    let mut s = build::<Dim2>(
        "time: (step: 1e-3, end: 9.0), gravity: [0.0, -9.81],
        bodies: [
            (name: \"floor\", material: \"glass\", shapes: [HalfSpace(normal: [0.0, 1.0])]),
            (name: \"block\", material: \"glass\", shapes: [Balls([([0.0, 0.01], 0.01)])], dofs: (y: Free)),
        ],
        phases: [
            (name: \"rest\", until: Steps(3)),
            (name: \"to\", until: After(0.2), drives: {\"block\": (x: Velocity(Constant(0.1)))}),
            (name: \"fro\", until: After(0.2), drives: {\"block\": (x: Velocity(Constant(-0.1)))},
             repeat: (from: \"to\", times: 5)),
            (name: \"last\", until: Steps(1), drives: {\"block\": (x: Velocity(Constant(0.0)))}),
        ]",
    );
    let block = body(&s.state.bodies, "block");
    let mut furthest = 0.0f64;
    while !s.phases_finished() {
        steps(&mut s, 1);
        furthest = furthest.max(s.state.bodies.position[block].x);
    }
    let names: Vec<&str> = s
        .state
        .control
        .begun()
        .iter()
        .map(|b| b.name.as_str())
        .collect();
    let group = ["to", "fro"].repeat(cycles);
    assert_eq!(names, [&["rest"][..], &group, &["last"]].concat());
    close(furthest, stroke, 1e-15);
    close(s.state.bodies.position[block].x, 0.0, 1e-15);
    let work = 0.5 * s.state.bodies.mass[block] * G * 2.0 * stroke * cycles as f64;
    close(s.state.energy.friction / work, 1.0, 0.02);
    assert!(s.state.energy.relative_residual() < 1e-9);
}

/// A floor taps a grain three times: it flies for 2 V/g each time, and the next tap waits until it
/// is at rest.
#[test]
fn taps_wait_for_rest() {
    let (v, held) = (0.3, 0.02);
    let mut s = build::<Dim2>(
        "time: (step: 1e-4, end: 9.0), gravity: [0.0, -9.81],
        bodies: [(name: \"floor\", material: \"glass\", shapes: [HalfSpace(normal: [0.0, 1.0])])],
        grains: [List(material: \"glass\", grains: [(at: [0.0, 0.01], radius: 0.01)])],
        phases: [
            (name: \"tap\", until: Steps(50), drives: {\"floor\": (y: Velocity(Constant(0.3)))}),
            (name: \"settle\", until: AtRest(share: 1e-4, held: 0.02), drives: {\"floor\": (y: Velocity(Constant(0.0)))},
             repeat: (from: \"tap\", times: 3)),
        ]",
    );
    while !s.phases_finished() {
        steps(&mut s, 1);
    }
    let settled = s
        .state
        .control
        .begun()
        .iter()
        .filter(|b| b.name == "settle");
    let times: Vec<f64> = settled
        .map(|b| b.end.unwrap_or(f64::NAN) - b.start)
        .collect();
    assert_eq!(times.len(), 3);
    for t in times {
        close(t, 2.0 * v / G + held, 5e-4);
    }
}

#[test]
fn groups_that_cannot_be_repeated_are_refused() {
    let head = "time: (step: 1e-3, end: 1.0), bodies: [(name: \"floor\", material: \"glass\",
        shapes: [HalfSpace(normal: [0.0, 1.0])])], phases: ";
    for (phases, said) in [
        (
            "[(name: \"a\", repeat: (times: 2))]",
            "`a` is repeated, so it needs `until`",
        ),
        (
            "[(name: \"a\", until: Steps(1), repeat: (times: 0))]",
            "is done at least once",
        ),
        (
            "[(name: \"a\", until: Steps(1), repeat: (from: \"b\", times: 2)), (name: \"b\")]",
            "there is no phase up to here named `b`",
        ),
        (
            "[(name: \"a\", until: Steps(1), repeat: (times: 2)),
              (name: \"b\", until: Steps(1), repeat: (from: \"a\", times: 2))]",
            "one group cannot hold another",
        ),
        (
            "[(name: \"a\", until: Steps(1), repeat: (times: 2000000))]",
            "a run has at most 1000000",
        ),
    ] {
        refused(&format!("{head}{phases}"), said);
    }
}

#[test]
fn bands_and_plates_that_mean_nothing_are_refused() {
    let head = "time: (step: 1e-3, end: 1.0), ";
    for (lines, said) in [
        (
            "measures: [Band(name: \"b\", low: [0.0, 0.0], high: [1.0, 1.0], above: 0.0)]",
            "a shear must be positive",
        ),
        (
            "measures: [Band(name: \"b\", low: [0.0], high: [1.0, 1.0], above: 0.5)]",
            "a corner has 2 numbers",
        ),
        ("output: (shear: -1.0)", "must be positive"),
        (
            "bodies: [(name: \"plate\", material: \"glass\", shapes: [Plate(radius: 1.0, hole: 0.1, balls: 0.01)])]",
            "needs three dimensions",
        ),
    ] {
        refused(&format!("{head}{lines}"), said);
    }
}
