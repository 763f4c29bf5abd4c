//! Bodies held between others by friction alone, where contacts are hyperstatic: Coulomb's bound on the sum of the friction forces says whether
//! they hang or fall.

use fretwork::geometry::space::{Dim2, Dim3};
use fretwork::scene::build::Dimensional;
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::Path;

/// Mass of what is held (kg), force of each pad (N), gravity (m/s^2).
const MASS: f64 = 0.045;
const FORCE: f64 = 1.2;
const G: f64 = 9.81;

/// Friction at which two pads just hold the weight: 2 mu F = m g.
fn least_friction() -> f64 {
    MASS * G / (2.0 * FORCE)
}

/// A body between two pads that are pressed together along x; names of the bodies with "held" are watched.
struct Pinched {
    bodies: String,
    dimension: usize,
}

impl Pinched {
    fn new(dimension: usize, pad: &str, bodies: &[(&str, [f64; 3], f64)]) -> Self {
        let place = |at: &[f64; 3]| {
            let at: Vec<String> = at[..dimension].iter().map(|x| format!("{x:e}")).collect();
            at.join(", ")
        };
        let free = if dimension == 2 {
            "x: Free, y: Free, rz: Free"
        } else {
            "x: Free, y: Free, z: Free, rx: Free, ry: Free, rz: Free"
        };
        let mut all = String::new();
        for (name, x, force) in [("left", -9e-3, FORCE), ("right", 9e-3, -FORCE)] {
            all += &format!(
                r#"(name: "{name}", material: "grain", mass: 0.1, position: [{}], shapes: [{pad}], dofs: (x: Force({force}))),"#,
                place(&[x, 0.0, 0.0])
            );
        }
        for (k, (shape, at, mass)) in bodies.iter().enumerate() {
            all += &format!(
                r#"(name: "held{k}", material: "grain", mass: {mass}, position: [{}], shapes: [{shape}], dofs: ({free})),"#,
                place(at)
            );
        }
        Self {
            bodies: all,
            dimension,
        }
    }

    /// The scene with a friction, solver settings and step.
    fn scene<S: Dimensional>(&self, mu: f64, solver: &str, step: f64) -> Simulation<S> {
        let gravity = if self.dimension == 2 {
            "0.0, -9.81"
        } else {
            "0.0, 0.0, -9.81"
        };
        let text = format!(
            r#"(
    name: "pinched", dimension: {}, gravity: [{gravity}],
    time: (step: {step:e}, end: 10.0),
    solver: ({solver}),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": {mu:e}}}))],
    bodies: [{}],
    output: (frames: 0, views: 0, figures: false),
)"#,
            self.dimension, self.bodies
        );
        let loaded = load_text("pinched.ron", &text, Path::new("."), &[]);
        let built = loaded.and_then(|l| l.build_in::<S>(&search_path()));
        built.unwrap_or_else(|e| panic!("{e}\n{text}")).simulation
    }

    /// The largest speed and displacement of what is held after a time, along gravity.
    fn falls<S: Dimensional>(&self, mu: f64, solver: &str, step: f64, time: f64) -> [f64; 2] {
        let mut s: Simulation<S> = self.scene(mu, solver, step);
        let held: Vec<usize> = s
            .state
            .bodies
            .driven
            .iter()
            .filter(|d| d.name.starts_with("held"))
            .map(|d| d.body as usize)
            .collect();
        let start = s.state.bodies.position.clone();
        for _ in 0..(time / step).round() as usize {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let down = S::D - 1;
        held.iter().fold([0.0f64; 2], |[v, d], b| {
            let moved = s.state.bodies.position[*b] - start[*b];
            [
                v.max(s.state.bodies.velocity[*b][down].abs()),
                d.max(moved[down].abs()),
            ]
        })
    }
}

const PAD: &str = "Box(size: (0.01, 0.05, 0.06))";
const PAD_2D: &str =
    "Polygon(points: [(-0.005, -0.03), (0.005, -0.03), (0.005, 0.03), (-0.005, 0.03)])";

fn capsule(direction: [f64; 3]) -> String {
    let end = direction.map(|x| 0.01 * x);
    let [x, y, z] = end;
    format!(
        "Capsule(from: ({:e}, {:e}, {:e}), to: ({x:e}, {y:e}, {z:e}), radius: 0.004)",
        -x, -y, -z
    )
}

/// What is held, by name.
fn shapes() -> Vec<(&'static str, Pinched)> {
    let at = [0.0; 3];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let one = |shape: &str| Pinched::new(3, PAD, &[(shape, at, MASS)]);
    let level = capsule([0.0, 1.0, 0.0]);
    let prism: Vec<String> = [
        [4, 2],
        [4, -2],
        [-4, 2],
        [-4, -2],
        [1, 6],
        [-1, 6],
        [1, -6],
        [-1, -6],
    ]
    .iter()
    .flat_map(|[x, y]| [-6, 9].map(|z| format!("({x}e-3, {y}e-3, {z}e-3)")))
    .collect();
    vec![
        ("level capsule", one(&level)),
        ("inclined capsule", one(&capsule([0.0, half, half]))),
        ("upright capsule", one(&capsule([0.0, 0.0, 1.0]))),
        ("box", one("Box(size: (0.008, 0.02, 0.016))")),
        (
            "prism",
            one(&format!("Polyhedron(points: [{}])", prism.join(", "))),
        ),
        (
            "two capsules",
            Pinched::new(
                3,
                PAD,
                &[
                    (&level, [0.0, 0.0, 0.01], 0.5 * MASS),
                    (&level, [0.0, 0.0, -0.01], 0.5 * MASS),
                ],
            ),
        ),
    ]
}

fn flat_shapes() -> Vec<(&'static str, Pinched)> {
    let one = |shape: &str| Pinched::new(2, PAD_2D, &[(shape, [0.0; 3], MASS)]);
    vec![
        ("disk", one("Balls([([0.0, 0.0], 0.004)])")),
        (
            "polygon",
            one(
                "Polygon(points: [(-0.004, -0.008), (0.004, -0.008), (0.004, 0.008), (-0.004, 0.008)])",
            ),
        ),
    ]
}

/// Time of the runs (s): a body in free fall would be at 0.39 m/s and 7.8 mm.
const TIME: f64 = 0.04;

/// With 1.05 times the least friction what is pinched hangs: its displacement is within the error of the solution, at most the
/// tolerance times some of the velocity p/m that the force of a pad would give it in a step, and that for all of the time.
#[test]
fn a_pinched_body_hangs_below_the_capacity_of_its_contacts() {
    let mu = 1.05 * least_friction();
    let check = |name: &str, solver: &str, step: f64, tolerance: f64, [v, d]: [f64; 2]| {
        let slow = 20.0 * tolerance * FORCE * step / MASS;
        assert!(
            v < slow.max(1e-12) && d < slow.max(1e-12) * TIME + 1e-6,
            "{name}, {solver}, {step}: {v:e} m/s, {d:e} m"
        );
    };
    for (name, pinched) in shapes() {
        for (method, tolerance, step) in [
            ("Auto", 1e-4, 1e-3),
            ("Auto", 1e-8, 2e-3),
            ("Nlgs", 1e-4, 5e-3),
            ("Anderson", 1e-6, 1e-3),
        ] {
            let solver = format!("method: {method}, tolerance: {tolerance:e}");
            let fell = pinched.falls::<Dim3>(mu, &solver, step, TIME);
            check(name, &solver, step, tolerance, fell);
        }
    }
    for (name, pinched) in flat_shapes() {
        let fell = pinched.falls::<Dim2>(mu, "tolerance: 1e-4", 1e-3, TIME);
        check(name, "Auto", 1e-3, 1e-4, fell);
    }
}

/// With 0.95 times the least friction it falls at g/20: all contacts slide at their bound.
#[test]
fn a_pinched_body_falls_above_the_capacity_of_its_contacts() {
    for (name, pinched) in shapes() {
        let [v, _] = pinched.falls::<Dim3>(0.95 * least_friction(), "tolerance: 1e-6", 1e-3, TIME);
        let wanted = 0.05 * G * TIME;
        assert!(
            (v / wanted - 1.0).abs() < 0.02,
            "{name}: {v} m/s, not {wanted}"
        );
    }
    for (name, pinched) in flat_shapes() {
        let [v, _] = pinched.falls::<Dim2>(0.95 * least_friction(), "tolerance: 1e-6", 1e-3, TIME);
        let wanted = 0.05 * G * TIME;
        assert!(
            (v / wanted - 1.0).abs() < 0.02,
            "{name}: {v} m/s, not {wanted}"
        );
    }
}

/// The step in which a second solution was found says so.
#[test]
fn several_solutions_are_reported() {
    let all = shapes();
    let (_, capsule) = all.iter().find(|(n, _)| *n == "level capsule").unwrap();
    let mut s: Simulation<Dim3> = capsule.scene(1.05 * least_friction(), "tolerance: 1e-6", 1e-3);
    let report = s.step().unwrap();
    assert!(
        report.solver.several && report.solver.converged,
        "{:?}",
        report.solver
    );
    assert!(!s.step().unwrap().solver.several);
}
