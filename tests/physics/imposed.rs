//! Contacts of bodies whose motion is imposed: springs, bonds and dampers carry the forces that
//! their laws give for the imposed positions and velocities. The drives feel them, and supply the
//! energy that springs store and friction dissipates.

use crate::scene;
use crate::stepping::{closes, go};
use fretwork::bodies::Driven;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;
use std::f64::consts::PI;

const RADIUS: f64 = 0.02;

/// A ball over a fixed plate; `dofs` are those of the ball. Interfaces are given with their
/// parameters.
fn ball<S: Space>(interface: &str, step: f64, dofs: &str, more: &str) -> Simulation<S> {
    let (normal, place) = match S::D {
        2 => ("[0.0, 1.0]", format!("[0.0, {RADIUS:?}]")),
        _ => ("[0.0, 0.0, 1.0]", format!("[0.0, 0.0, {RADIUS:?}]")),
    };
    let zero = if S::D == 2 {
        "[0.0, 0.0]"
    } else {
        "[0.0, 0.0, 0.0]"
    };
    let text = format!(
        r#"(
    name: "imposed", dimension: {}, time: (step: {step:e}, end: 1.0),
    detection: (alert: 1e-3, skin: 1e-3),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), {interface})],
    bodies: [
        (name: "plate", material: "grain", shapes: [HalfSpace(normal: {normal})]),
        (name: "ball", material: "grain", mass: 1.0, position: {place},
         shapes: [Balls([({zero}, {RADIUS:?})])], dofs: ({dofs})),
    ],
    output: (frames: 0, views: 0),
    {more}
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

fn steps<S: Space>(s: &mut Simulation<S>, n: usize) {
    go(s, n);
    closes(s, 1e-12);
}

/// Force of the contacts on the ball (N; N/m in 2D) and their moment (N m).
fn felt<S: Space>(s: &Simulation<S>) -> (S::Vector, S::Spin) {
    let named = |d: &Driven| d.name == "ball";
    let place = s.state.bodies.driven.iter().position(named).unwrap();
    let over = 1.0 / s.options.scheme.h;
    let (p, m) = s.state.received[place];
    (p * over, m * over)
}

fn near(got: f64, wanted: f64, share: f64) {
    assert!(
        (got - wanted).abs() <= share * wanted.abs(),
        "{got:e} is not {wanted:e} within {share:e}"
    );
}

const HERTZ: &str = r#"contact: "hertz-mindlin", parameters: (contact: {
    "young_1": 7e10, "young_2": 7e10, "poisson_1": 0.33, "poisson_2": 0.33, "mu": 0.3})"#;

const PUSH: &str = "Displacement(Ramp(from: 0.0, to: -2e-6, start: 0.0, end: 0.01))";

/// A ball has F = 4/3 E* sqrt(R) d^(3/2) and the work 2/5 F d; a cylinder F = pi/4 E* d and F d/2
/// (K. L. Johnson, Contact Mechanics, 4.2). All methods are tested. When the ball is drawn back the
/// force is zero, and does not pull.
#[test]
fn an_imposed_indentation_is_that_of_hertz() {
    let (modulus, depth) = (7e10 / (2.0 * (1.0 - 0.33 * 0.33)), 2e-6f64);
    let hertz = 4.0 / 3.0 * modulus * RADIUS.sqrt() * depth.powf(1.5);
    near(hertz, 20.95, 1e-3);
    for method in ["Auto", "Nlgs", "Newton", "Interior", "Apgd", "Cpg"] {
        let solver = format!("solver: (method: {method}),");
        let mut s: Simulation<Dim3> = ball(HERTZ, 5e-5, &format!("z: {PUSH}"), &solver);
        steps(&mut s, 300);
        near(felt(&s).0.z, hertz, 1e-3);
        near(s.state.energy.external_work, 0.4 * hertz * depth, 2e-2);
        near(s.state.energy.elastic, 0.4 * hertz * depth, 1e-2);
    }
    let mut s: Simulation<Dim2> = ball(HERTZ, 5e-5, &format!("y: {PUSH}"), "");
    steps(&mut s, 300);
    let force = 0.25 * PI * modulus * depth;
    near(felt(&s).0.y, force, 1e-6);
    near(s.state.energy.external_work, 0.5 * force * depth, 2e-2);
    let back = "y: Displacement(Table([(0.0, 0.0), (0.005, -2e-6), (0.01, 2e-6), (1.0, 2e-6)]))";
    let mut s: Simulation<Dim2> = ball(HERTZ, 5e-5, back, "");
    steps(&mut s, 100);
    near(felt(&s).0.y, force, 2e-2);
    steps(&mut s, 150);
    assert_eq!(felt(&s).0.norm(), 0.0);
}

/// A ball that is pressed by a displacement and dragged has the friction mu F, which dissipates its
/// work.
#[test]
fn an_imposed_drag_has_the_friction_of_its_spring() {
    let (k, depth, speed, mu) = (1e6, 1e-5, 0.01, 0.25);
    let law = format!(
        r#"contact: "linear-contact", parameters: (contact: {{"stiffness": {k:e}, "mu": {mu:?}, "ratio": 0.8}})"#
    );
    let press = format!("Displacement(Ramp(from: 0.0, to: -{depth:e}, start: 0.0, end: 0.001))");
    fn drag<S: Space>(law: &str, dofs: &str) -> (S::Vector, f64) {
        let mut s: Simulation<S> = ball(law, 1e-5, dofs, "");
        steps(&mut s, 500);
        let before = s.state.energy;
        steps(&mut s, 1000);
        let work = s.state.energy.external_work - before.external_work;
        near(s.state.energy.friction - before.friction, work, 1e-9);
        (felt(&s).0, work)
    }
    let (force, work) = drag::<Dim2>(
        &law,
        &format!("x: Velocity(Constant({speed:?})), y: {press}"),
    );
    near(force.y, k * depth, 1e-9);
    near(force.x, -mu * k * depth, 1e-9);
    near(work, mu * k * depth * speed * 0.01, 1e-9);
    let (force, work) = drag::<Dim3>(
        &law,
        &format!("x: Velocity(Constant({speed:?})), y: Velocity(Constant({speed:?})), z: {press}"),
    );
    near(force.z, k * depth, 1e-9);
    near(force.x, -mu * k * depth / 2f64.sqrt(), 1e-9);
    near(work, mu * k * depth * speed * 0.01 * 2f64.sqrt(), 1e-9);
}

/// A ball that turns on a fixed axle presses a spring; another ball is free along one axis only.
#[test]
fn a_ball_on_an_axle_is_pressed_and_turned() {
    let (k, depth, mu) = (1e6, 1e-5, 0.25);
    let law = format!(
        r#"contact: "linear-contact", parameters: (contact: {{"stiffness": {k:e}, "mu": {mu:?}, "ratio": 0.8}})"#
    );
    let press = format!("Displacement(Ramp(from: 0.0, to: -{depth:e}, start: 0.0, end: 0.001))");
    let dofs = format!("x: Velocity(Constant(0.01)), y: {press}, rz: Free");
    let mut s: Simulation<Dim2> = ball(&law, 1e-5, &dofs, "");
    steps(&mut s, 400);
    near(felt(&s).0.y, k * depth, 1e-9);
    // Friction turns the ball until it rolls, and then oscillates on its spring.
    steps(&mut s, 20_000);
    let b = s.state.bodies.driven[1].body as usize;
    near(s.state.bodies.spin[b][0], -0.01 / RADIUS, 0.2);
    let dofs = format!("x: Free, y: Fixed, z: {press}");
    let mut s: Simulation<Dim3> = ball(&law, 1e-5, &dofs, "");
    steps(&mut s, 400);
    near(felt(&s).0.z, k * depth, 1e-9);
}

/// A bond carries k x A along and across, and its damping d v A; the work of the drives is its
/// energy.
#[test]
fn an_imposed_opening_pulls_a_bond() {
    let law = r#"contact: "coulomb", cohesion: "elastic-bond", bonds: Start, bonds_within: 1e-6,
        parameters: (contact: {"mu": 0.0}, cohesion: {"k_n": 2e12, "k_t": 1e12, "d_n": 3e8, "d_t": 2e8})"#;
    fn pulled<S: Space>(law: &str, dofs: &str) -> [Simulation<S>; 2] {
        let at = |n: usize| {
            let mut s: Simulation<S> = ball(law, 1e-5, dofs, "");
            steps(&mut s, n);
            s
        };
        [at(500), at(1500)]
    }
    fn area<S: Space>(s: &Simulation<S>) -> f64 {
        s.state
            .network
            .memory
            .iter()
            .flat_map(|m| &m.bonds)
            .next()
            .unwrap()
            .area
    }
    let pull = "Displacement(Ramp(from: 0.0, to: 1e-7, start: 0.0, end: 0.01))";
    let [moving, still] = pulled::<Dim2>(law, &format!("x: {pull}, y: {pull}"));
    let a = area(&still);
    near(felt(&still).0.y, -2e12 * 1e-7 * a, 1e-6);
    near(felt(&still).0.x, -1e12 * 1e-7 * a, 1e-3);
    near(felt(&moving).0.y, -(2e12 * 0.5e-7 + 3e8 * 1e-5) * a, 1e-2);
    let e = still.state.energy;
    near(e.elastic, 0.5 * 3e12 * 1e-14 * a, 1e-3);
    near(e.viscous, 5e8 * 1e-5 * 1e-7 * a, 1e-2);
    near(e.external_work, e.elastic + e.viscous, 1e-3);
    let [_, still] = pulled::<Dim3>(law, &format!("x: {pull}, z: {pull}"));
    let a = area(&still);
    near(felt(&still).0.z, -2e12 * 1e-7 * a, 1e-6);
    near(felt(&still).0.x, -1e12 * 1e-7 * a, 1e-3);
}

/// A ball is pushed into a body of finite elements whose upper side is held: no point that the ball
/// touches can move.
#[test]
fn a_held_side_of_a_deformable_body_presses_a_spring() {
    let text = r#"(
    name: "held", dimension: 2, time: (step: 1e-5, end: 1.0),
    detection: (alert: 1e-4, skin: 1e-3),
    materials: {"steel": "rail_steel_r260"},
    interfaces: [(name: "all", between: ("steel", "steel"), contact: "linear-contact",
        parameters: (contact: {"stiffness": 1e8, "mu": 0.3, "ratio": 0.8}))],
    elastic: [(name: "block", material: "steel",
        mesh: Block(x: (from: -0.02, to: 0.02, size: 0.01), y: (from: -0.02, to: 0.0, size: 0.01)),
        supports: [(part: "bottom", x: Fixed, y: Fixed), (part: "top", x: Fixed, y: Fixed)],
        touches: Surface("top"))],
    bodies: [(name: "ball", material: "steel", mass: 1.0, position: [0.0, 0.02], shapes: [Balls([([0.0, 0.0], 0.02)])],
        dofs: (x: Velocity(Constant(0.0)), y: Displacement(Ramp(from: 0.0, to: -1e-5, start: 0.0, end: 0.001))))],
    output: (frames: 0, views: 0),
)"#;
    let mut s = scene::text::<Dim2>(text);
    steps(&mut s, 300);
    let touching = s.state.network.contacts.iter();
    let touching = touching.filter(|c| c.impulse.norm() > 0.0).count();
    assert!(touching > 0);
    near(felt(&s).0.y, touching as f64 * 1e8 * 1e-5, 1e-6);
    near(s.state.energy.external_work, s.state.energy.elastic, 3e-2);
}
