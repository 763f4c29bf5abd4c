//! Bodies held between others by friction alone, where contacts are hyperstatic: whether they hang
//! or fall follows from Coulomb's bound on the sum of the friction forces.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;
use std::f64::consts::PI;

/// Mass of the held body (kg), force of each pad (N), gravity (m/s^2).
const MASS: f64 = 0.045;
const FORCE: f64 = 1.2;
const G: f64 = 9.81;

/// Friction at which two pads just hold the weight: 2 mu F = m g.
fn least_friction() -> f64 {
    MASS * G / (2.0 * FORCE)
}

/// A body between two pads that are pressed together along x; bodies with "held" in their names are
/// watched.
struct Pinched {
    bodies: String,
    /// Grains of the scene, as in a case.
    grains: String,
    dimension: usize,
}

impl Pinched {
    fn new(dimension: usize, pad: &str, bodies: &[(&str, [f64; 3], f64)]) -> Self {
        Self {
            bodies: Self::pinched(dimension, pad, bodies, [0.0; 3], ""),
            grains: String::new(),
            dimension,
        }
    }

    /// Returns independent copies of a pinched body, 0.1 m apart.
    fn copies(count: usize, pad: &str, bodies: &[(&str, [f64; 3], f64)]) -> Self {
        let all = (0..count).map(|k| {
            let at = [0.0, 0.1 * k as f64, 0.0];
            Self::pinched(3, pad, bodies, at, &format!("_{k}"))
        });
        Self {
            bodies: all.collect(),
            grains: String::new(),
            dimension: 3,
        }
    }

    /// Returns two pads at a position, and the body that they pinch.
    fn pinched(
        dimension: usize,
        pad: &str,
        bodies: &[(&str, [f64; 3], f64)],
        origin: [f64; 3],
        suffix: &str,
    ) -> String {
        let place = |at: &[f64; 3]| {
            let at = at.iter().zip(origin).map(|(x, o)| format!("{:e}", x + o));
            let at: Vec<String> = at.take(dimension).collect();
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
                r#"(name: "{name}{suffix}", material: "grain", mass: 0.1, position: [{}], shapes: [{pad}], dofs: (x: Force({force}))),"#,
                place(&[x, 0.0, 0.0])
            );
        }
        for (k, (shape, at, mass)) in bodies.iter().enumerate() {
            all += &format!(
                r#"(name: "held{k}{suffix}", material: "grain", mass: {mass}, position: [{}], shapes: [{shape}], dofs: ({free})),"#,
                place(at)
            );
        }
        all
    }

    /// The scene with a friction, solver settings and step.
    fn scene<S: Space>(&self, mu: f64, solver: &str, step: f64) -> Simulation<S> {
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
    grains: [{}],
    output: (frames: 0, views: 0, figures: false),
)"#,
            self.dimension, self.bodies, self.grains
        );
        scene::text::<S>(&text)
    }

    /// Largest speed and displacement of held bodies along gravity after a time.
    fn falls<S: Space>(&self, mu: f64, solver: &str, step: f64, time: f64) -> [f64; 2] {
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

/// Held bodies, by name.
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

/// Time of the runs (s), after which a body in free fall would have 0.39 m/s and 7.8 mm.
const TIME: f64 = 0.04;

/// With 1.05 times the least friction a pinched body hangs: its displacement is within the error of
/// the solution, the tolerance times a multiple of the velocity p/m that the force of a pad would
/// give it in a step, over the whole time.
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

/// With 0.95 times the least friction the body falls at g/20: all contacts slide at their bound.
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

/// The step in which a second solution was found reports it.
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

/// Seventeen independent pinched capsules hang, and so does one beside balls at rest on a floor,
/// whose contacts are more than the search accepts in one set. The number of solutions is reported
/// in the first step, and no set is too large.
#[test]
fn what_is_pinched_hangs_whatever_else_there_is() {
    let mu = 1.05 * least_friction();
    let level = capsule([0.0, 1.0, 0.0]);
    let one = [(level.as_str(), [0.0; 3], MASS)];
    let mut beside = Pinched::new(3, PAD, &one);
    let balls: Vec<String> = (0..65)
        .map(|k| {
            format!(
                "(at: [{:e}, 0.0, 0.01], radius: 0.01)",
                1.0 + 0.03 * f64::from(k)
            )
        })
        .collect();
    beside.grains = format!(r#"List(material: "grain", grains: [{}])"#, balls.join(", "));
    beside.bodies += r#"(name: "floor", material: "grain", shapes: [Box(size: (5.0, 1.0, 0.1), at: (3.2, 0.0, -0.05))]),"#;
    for (name, pinched) in [
        ("copies", Pinched::copies(17, PAD, &one)),
        ("balls", beside),
    ] {
        let [v, d] = pinched.falls::<Dim3>(mu, "tolerance: 1e-6", 1e-3, TIME);
        let slow = 20.0 * 1e-6 * FORCE * 1e-3 / MASS;
        assert!(
            v < slow && d < slow * TIME + 1e-6,
            "{name}: {v:e} m/s, {d:e} m"
        );
        let mut s: Simulation<Dim3> = pinched.scene(mu, "tolerance: 1e-6", 1e-3);
        let reported: Vec<bool> = (0..10).map(|_| s.step().unwrap().solver.several).collect();
        assert!(
            reported[0] && !reported[1..].contains(&true),
            "{name}: {reported:?}"
        );
        let mut s: Simulation<Dim3> = pinched.scene(mu, "tolerance: 1e-6", 1e-3);
        assert!(
            (0..10).all(|_| !s.step().unwrap().solver.not_searched),
            "{name}"
        );
    }
}

/// Bodies that slide separately on a floor are separate sets: each has one solution, since its load
/// is its weight, and the friction of a step is mu m g h whatever the others do.
#[test]
fn blocks_that_slide_have_one_solution() {
    let blocks: Vec<String> = (0..20)
        .map(|k| {
            let [x, v] = [0.3 * f64::from(k), 0.05 * f64::from(k + 1)];
            format!("(at: [{x:e}, 0.0, 0.05], size: (0.1, 0.1, 0.1), velocity: [{v:e}, 0.0, 0.0])")
        })
        .collect();
    let (mu, h) = (0.3, 1e-3);
    let pinched = Pinched {
        bodies:
            r#"(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])]),"#
                .to_owned(),
        grains: format!(
            r#"Polyhedra(material: "grain", grains: [{}])"#,
            blocks.join(", ")
        ),
        dimension: 3,
    };
    let mut s: Simulation<Dim3> = pinched.scene(mu, "tolerance: 1e-8", h);
    for step in 1..=60 {
        let report = s.step().unwrap();
        assert!(
            !report.solver.several && !report.solver.not_searched,
            "{step}"
        );
        let moving = s.state.bodies.velocity.iter().take(20);
        for (k, v) in moving.enumerate() {
            let wanted = (0.05 * (k + 1) as f64 - mu * G * h * f64::from(step)).max(0.0);
            assert!(
                (v[0] - wanted).abs() < 1e-6,
                "{k}, {step}: {} m/s, not {wanted}",
                v[0]
            );
        }
    }
}

/// If a set is too large to search, a loaded contact of it that begins to slide is reported:
/// capsules that two pads hold between plates without gravity, and that fall with it. Nothing is
/// reported while they hold, for fewer capsules, or for capsules held by the pads themselves, whose
/// sets are searched.
#[test]
fn sets_too_large_to_search_are_told() {
    let level = capsule([0.0, 1.0, 0.0]);
    let thin = level.replace("radius: 0.004", "radius: 0.003");
    for (count, plates, reported) in [
        (80, true, true),
        (80, false, false),
        (20, false, false),
        (1, false, false),
    ] {
        let place = |k: i32| 0.03 * f64::from(k) - 0.015 * f64::from(count - 1);
        let shape = if plates { &thin } else { &level };
        let mut held: Vec<(&str, [f64; 3], f64)> = (0..count)
            .map(|k| (shape.as_str(), [0.0, place(k), 0.0], MASS))
            .collect();
        let long = 0.035 * f64::from(count);
        let plate = format!("Box(size: (0.001, {long:?}, 0.06))");
        if plates {
            held.extend([-1.0, 1.0].map(|side| (plate.as_str(), [3.5e-3 * side, 0.0, 0.0], 1e-3)));
        }
        let pad = format!("Box(size: (0.01, {long:?}, 0.06))");
        let pinched = Pinched::new(3, &pad, &held);
        let mu = 0.5 * least_friction();
        let mut s: Simulation<Dim3> = pinched.scene(mu, "tolerance: 1e-6", 1e-3);
        let gravity = std::mem::replace(&mut s.state.gravity, [0.0; 3].into());
        let not_searched = |s: &mut Simulation<Dim3>| {
            let solver = s.step().unwrap().solver;
            assert!(!solver.pinched);
            solver.not_searched
        };
        let held = (0..3).all(|_| !not_searched(&mut s));
        // Plates move a little until they fit the held bodies.
        assert!(held || plates, "{count} that hold");
        s.state.gravity = gravity;
        assert_eq!(not_searched(&mut s), reported, "{count} that fall");
    }
}

/// Friction between pads and debris.
const MU: f64 = 0.7;

/// Displacement of the lowest grain in half a second (m).
fn fallen<S: Space>(s: Simulation<S>) -> f64 {
    fallen_but(s, &[])
}

/// Checks the displacement of the bodies that are not among `but`. If they fall, the run must
/// report it before they are lower by a tenth of a millimetre.
fn fallen_but<S: Space>(mut s: Simulation<S>, but: &[usize]) -> f64 {
    let driven: Vec<usize> = (s.state.bodies.driven.iter())
        .map(|d| d.body as usize)
        .collect();
    let start = s.state.bodies.position.clone();
    let (mut reported, mut fallen) = (false, 0.0);
    for step in 1..=500 {
        let solver = s.step().unwrap_or_else(|e| panic!("{e}")).solver;
        reported |= solver.several || solver.pinched;
        let grains = (0..start.len()).filter(|b| !driven.contains(b) && !but.contains(b));
        let down = grains.map(|b| start[b][S::D - 1] - s.state.bodies.position[b][S::D - 1]);
        fallen = down.fold(0.0, f64::max);
        assert!(
            reported || fallen < 1e-4,
            "{fallen:e} m after {step} steps, and nothing is reported"
        );
    }
    fallen
}

/// Displacement of the lowest of balls or disks side by side in half a second (m), between two pads
/// whose friction carries 1.3 times their weight; the force of the pads varies by a fraction of it,
/// 20 times per second.
fn debris_falls(dimension: usize, count: i32, solver: &str, varies: f64) -> f64 {
    let pinched = debris(dimension, count, varies);
    match dimension {
        2 => fallen::<Dim2>(pinched.scene(MU, solver, 1e-3)),
        _ => fallen::<Dim3>(pinched.scene(MU, solver, 1e-3)),
    }
}

/// Displacement of pinched disks while a disk bounces on a floor beside them and another rolls on
/// it.
fn debris_falls_beside(count: i32) -> f64 {
    let mut pinched = debris(2, count, 0.1);
    pinched.bodies += r#"(name: "floor", material: "grain", position: [2.0, 0.0], shapes: [Polygon(points: [(-1.0, -0.1), (1.0, -0.1), (1.0, 0.0), (-1.0, 0.0)])]),"#;
    pinched.grains = pinched.grains.replace(
        "grains: [",
        "grains: [(at: [1.5, 4e-3], radius: 4e-3, velocity: [0.5, 0.0]), (at: [2.0, 0.1], radius: 4e-3), ",
    );
    let s: Simulation<Dim2> = pinched.scene(MU, "", 1e-3);
    let moves = |b: &usize| s.state.bodies.position[*b][0] > 1.0;
    let moves: Vec<usize> = s.state.bodies.grains().filter(moves).collect();
    assert_eq!(moves.len(), 2);
    fallen_but(s, &moves)
}

/// Two pads and the bodies between them, see [`debris_falls`].
fn debris(dimension: usize, count: i32, varies: f64) -> Pinched {
    let (radius, capacity) = (4e-3, 1.3);
    let volume = match dimension {
        2 => PI * radius * radius,
        _ => 4.0 / 3.0 * PI * radius.powi(3),
    };
    let weight = f64::from(count) * volume * 1000.0 * G;
    let force = capacity * weight / (2.0 * MU);
    let at = |k: i32| match dimension {
        2 => format!("[0.0, {:e}]", 0.012 * f64::from(k)),
        _ => format!("[0.0, {:e}, 0.0]", 0.012 * f64::from(k)),
    };
    let balls: Vec<String> = (0..count)
        .map(|k| format!("(at: {}, radius: {radius:e})", at(k)))
        .collect();
    let middle = 0.006 * f64::from(count - 1);
    let half = 0.006 * f64::from(count) + 0.01;
    let pad = |name: &str, side: f64| {
        let (place, shape) = match dimension {
            2 => (
                format!("[{:e}, {middle:e}]", side * 0.009),
                format!(
                    "Polygon(points: [(-0.005, -{half:e}), (0.005, -{half:e}), (0.005, {half:e}), (-0.005, {half:e})])"
                ),
            ),
            _ => (
                format!("[{:e}, {middle:e}, 0.0]", side * 0.009),
                format!("Box(size: (0.01, {:e}, 0.02))", 2.0 * half),
            ),
        };
        let (mean, amplitude) = (-side * force, varies * force);
        format!(
            r#"(name: "{name}", material: "grain", mass: 0.1, position: {place}, shapes: [{shape}], dofs: (x: Force(Sine(offset: {mean:e}, amplitude: {amplitude:e}, frequency: 20.0)))),"#
        )
    };
    Pinched {
        bodies: pad("left", -1.0) + &pad("right", 1.0),
        grains: format!(r#"List(material: "grain", grains: [{}])"#, balls.join(", ")),
        dimension,
    }
}

/// Bodies that friction can hold hang from the first step, in sets with more contacts than those
/// that are searched in every step. A sweep would load only the first contact, and sweeps in one
/// order from step to step would amplify round-off until one slides.
#[test]
fn what_many_contacts_pinch_hangs() {
    for (dimension, count) in [(3, 40), (3, 127), (3, 500), (2, 34), (2, 60), (2, 127)] {
        let fallen = debris_falls(dimension, count, "", 0.0);
        println!("{dimension}D, {count}: {fallen:e} m");
        // The free fall is 1.2 m.
        assert!(fallen < 1e-5, "{dimension}D, {count}: {fallen:e} m");
    }
}

/// Under a force that varies by a tenth, or beside moving bodies, the errors of a step change
/// hyperstatic impulses until some contacts slide at the default tolerance, which is reported; with
/// Newton's method at 1e-6 they do not.
#[test]
fn what_many_contacts_pinch_hangs_or_is_told_to_fall() {
    for (dimension, count) in [(3, 127), (2, 60), (2, 129), (2, 500)] {
        let at_default = debris_falls(dimension, count, "", 0.1);
        println!("{dimension}D, {count}: {at_default:e} m");
    }
    for (dimension, count) in [(3, 127), (2, 34), (2, 129)] {
        let solver = "method: Newton, tolerance: 1e-6";
        let fallen = debris_falls(dimension, count, solver, 0.1);
        println!("{dimension}D, {count}: {fallen:e} m by Newton's method");
        assert!(fallen < 1e-5, "{dimension}D, {count}: {fallen:e} m");
    }
    for count in [60, 129] {
        let fallen = debris_falls_beside(count);
        println!("{count} beside what moves: {fallen:e} m");
    }
}
