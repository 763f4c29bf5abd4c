//! Contacts that hold each other: columns of springs between fixed plates, and stacks of different
//! weights.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

/// Gravity (m/s^2).
const G: f64 = 9.81;

/// A column of grains with springs, squeezed between fixed plates so that each contact overlaps by
/// the same.
fn column<S: Space>(grains: usize, law: &str, rest: &str) -> Simulation<S> {
    let at = |z: f64| {
        if S::D == 2 {
            format!("0.0, {z:e}")
        } else {
            format!("0.0, 0.0, {z:e}")
        }
    };
    let height = |k: usize| RADIUS - OVERLAP + k as f64 * (2.0 * RADIUS - OVERLAP);
    let list: Vec<String> = (0..grains)
        .map(|k| format!("(at: [{}], radius: {RADIUS:e})", at(height(k))))
        .collect();
    let (up, down) = if S::D == 2 {
        ("0.0, 1.0", "0.0, -1.0")
    } else {
        ("0.0, 0.0, 1.0", "0.0, 0.0, -1.0")
    };
    let text = format!(
        r#"(
    name: "column", dimension: {}, detection: (alert: 1e-5, skin: 1e-5),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "linear-contact", parameters: (contact: {{{law}}}))],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [{up}])]),
        (name: "roof", material: "grain", shapes: [HalfSpace(normal: [{down}])], position: [{}]),
    ],
    grains: [List(material: "grain", grains: [{}])],
    output: (frames: 0, views: 0, figures: false),
    {rest}
)"#,
        S::D,
        at(height(grains - 1) + RADIUS - OVERLAP),
        list.join(", ")
    );
    scene::text::<S>(&text)
}

/// Radius of the grains, and overlap of each contact (m).
const RADIUS: f64 = 1e-3;
const OVERLAP: f64 = 2.5e-6;

fn stays<S: Space>(grains: usize, stiffness: f64, mu: f64, rest: &str) {
    let law = format!(r#""stiffness": {stiffness:e}, "restitution": 0.1, "mu": {mu}"#);
    let mut s: Simulation<S> = column(grains, &law, rest);
    let wanted = stiffness * OVERLAP;
    for _ in 0..60 {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        let solver = &report.solver;
        assert!(
            solver.converged && solver.iterations < 1000 && !solver.unbounded,
            "{}D, {grains} grains, {stiffness:e} N/m, {rest}, step {}: {solver:?}",
            S::D,
            s.state.steps
        );
        for received in &s.state.received {
            let force = received.0[S::D - 1].abs() / s.options.scheme.h;
            assert!(
                (force / wanted - 1.0).abs() < 0.02,
                "{force} N, not {wanted}"
            );
        }
    }
}

/// All forces are k times the overlap from the first step on, within the permitted error (a
/// hundredth of the work). Forces that balance leave no velocity against which an error could be
/// measured, but they are not an error.
#[test]
fn a_column_of_springs_holds_itself() {
    for (grains, stiffness) in [(1, 1e6), (3, 1e6), (3, 1e4), (10, 1e6), (30, 1e5)] {
        for theta in [0.5, 1.0] {
            for solver in [
                "",
                "norm: Balance",
                "method: Nlgs, norm: Balance",
                "method: Newton",
            ] {
                let rest =
                    format!("time: (step: 1e-3, end: 1.0, theta: {theta}), solver: ({solver})");
                stays::<Dim2>(grains, stiffness, 0.0, &rest);
                stays::<Dim3>(grains, stiffness, 0.4, &rest);
            }
        }
    }
}

/// Results for stacks that stand, see [`stand`].
struct Standing {
    /// Largest displacement of a top cube (m).
    moved: f64,
    /// Ratio of the kinetic energy at the end to that of a step of free fall.
    energy: f64,
    /// Mean number of sweeps per step.
    sweeps: f64,
}

/// Stacks, 1 m apart, of five cubes of 0.2 m with a cube of another density on top, slightly off
/// their axis.
fn stand(density: f64, stacks: usize, tolerance: f64, time: f64) -> Standing {
    let (mut cubes, mut tops) = (Vec::new(), Vec::new());
    let mass = density * 0.008;
    for k in 0..stacks {
        let [x, y] = [k % 4, k / 4].map(|k| k as f64);
        for z in 0..5 {
            let z = 0.1 + 0.2 * f64::from(z);
            cubes.push(format!("(at: [{x}, {y}, {z}], size: (0.2, 0.2, 0.2))"));
        }
        let [x, y] = [x + 0.01, y + 0.02];
        tops.push(format!(
            r#"(name: "top{k}", material: "grain", mass: {mass:e}, position: [{x}, {y}, 1.1], shapes: [Box(size: (0.2, 0.2, 0.2))],
            dofs: (x: Free, y: Free, z: Free, rx: Free, ry: Free, rz: Free)),"#
        ));
    }
    let text = format!(
        r#"(
    name: "stack", dimension: 3, gravity: [0.0, 0.0, -9.81], time: (step: 5e-3, end: 100.0),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.5}}))],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])]),
        {}
    ],
    grains: [Polyhedra(material: "grain", grains: [{}])],
    solver: (tolerance: {tolerance:e}), output: (frames: 0, views: 0, figures: false),
)"#,
        tops.concat(),
        cubes.join(", ")
    );
    let mut s = scene::text::<Dim3>(&text);
    let driven = s.state.bodies.driven.iter();
    let tops = driven.filter(|d| d.name.starts_with("top"));
    let tops: Vec<usize> = tops.map(|d| d.body as usize).collect();
    assert_eq!(tops.len(), stacks);
    let start = s.state.bodies.position.clone();
    let steps = (time / s.options.scheme.h).round() as usize;
    let mut sweeps = 0;
    for _ in 0..steps {
        sweeps += s.step().unwrap_or_else(|e| panic!("{e}")).solver.iterations;
    }
    let moved = |b: &usize| (s.state.bodies.position[*b] - start[*b]).norm();
    let moved = tops.iter().map(moved).fold(0.0, f64::max);
    let kinetic = s.state.bodies.kinetic_energy();
    let falls = G * s.options.scheme.h;
    let free: f64 = s.state.bodies.mass.iter().filter(|m| m.is_finite()).sum();
    Standing {
        moved,
        energy: kinetic / (0.5 * free * falls * falls),
        sweeps: f64::from(sweeps) / steps as f64,
    }
}

/// Blocks at rest move by less than a fiftieth of their size in five seconds at the default
/// tolerance, whatever lies on top, and by a tenth of that at a tenth of the tolerance. (Without
/// the part of the error that counts powers of either sign, the top moved by 20 mm under a ratio of
/// 1000.) Stacks that do not touch each other stand like a single one. An error shared out among
/// all contacts made sixteen stacks under a ratio of 1000 fall, with a third of the kinetic energy
/// of a step of free fall after half a second.
#[test]
fn light_blocks_carry_heavy_ones() {
    for (ratio, stacks, tolerance, time, bound) in [
        (1.0, 1, 1e-4, 5.0, 4e-3),
        (10.0, 1, 1e-4, 5.0, 4e-3),
        (10.0, 1, 1e-5, 5.0, 4e-4),
        (1000.0, 1, 1e-4, 5.0, 4e-3),
        (10.0, 16, 1e-4, 5.0, 4e-3),
        (1000.0, 16, 1e-4, 0.5, 4e-3),
    ] {
        let stood = stand(1e3 * ratio, stacks, tolerance, time);
        let Standing {
            moved,
            energy,
            sweeps,
        } = stood;
        let name = format!("ratio {ratio}, {stacks} stacks, tolerance {tolerance:e}");
        println!("{name}: {moved:e} m, {energy:e} of a step of free fall, {sweeps} sweeps a step");
        assert!(moved < bound, "{name}: {moved:e} m");
        assert!(energy < 0.1, "{name}: {energy:e} of a step of free fall");
    }
}

/// A ball that attraction holds to a plate in steady motion carries no force, and costs no sweeps.
/// The residual of its impulses from round-off and the tolerance, beside a ball that is pressed on
/// a floor, is not an error of the step. The friction by the tangential motion of the plate must be
/// found once.
#[test]
fn a_grain_that_sticks_to_a_moving_plate_is_no_error() {
    let text = r#"(
    name: "stuck", dimension: 2, time: (step: 2e-4, end: 1.0),
    solver: (tolerance: 1e-3, max_iterations: 500),
    materials: {"grain": "verification_grain"},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", cohesion: "constant-attraction",
        parameters: (contact: {"mu": 0.4}, cohesion: {"stress": 0.0, "force": 16.0, "range": 1e-4}))],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "pressed", material: "grain", mass: 0.05, inertia: 1e-6, position: [0.0, 0.004], shapes: [Balls([([0.0, 0.0], 0.004)])],
            dofs: (x: Free, y: Force(-1000.0), rz: Free)),
        (name: "plate", material: "grain", position: [0.0, 0.1], shapes: [Balls([([0.03, 0.0], 0.004), ([0.038, 0.0], 0.004), ([0.046, 0.0], 0.004)])],
            dofs: (x: Velocity(Constant(0.7)))),
    ],
    grains: [List(material: "grain", grains: [(at: [0.034, 0.09307], radius: 0.004, velocity: [0.7, 0.0]), (at: [0.042, 0.09307], radius: 0.0039)])],
    output: (frames: 0, views: 0, figures: false),
)"#;
    let mut s = scene::text::<Dim2>(text);
    let mut sweeps = 0;
    for k in 1..=2000 {
        let solver = s.step().unwrap_or_else(|e| panic!("{e}")).solver;
        assert!(solver.converged, "step {k}: {solver:?}");
        sweeps += solver.iterations;
    }
    println!("{} sweeps a step", f64::from(sweeps) / 2000.0);
    assert!(sweeps < 2000 * 30);
}
