//! Friction that depends on the sliding velocity, compared with closed forms: creep, a step of
//! velocity, stability on a spring, elastic bodies.
//!
//! Rate-and-state friction: mu = mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c), in steady sliding mu_0 +
//! (a - b) ln(V/V_0). A step from V_1 to V_2 changes friction by a ln(V_2/V_1) at once and by (a -
//! b) ln(V_2/V_1) in the end (A. Ruina, J. Geophys. Res. 88 (1983) 10359-10370). Sliding on a
//! spring is steady above the stiffness (b - a) P/D_c, and not below (ibid.).

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::{Simulation, StepReport};

const MU_0: f64 = 0.6;
const V_0: f64 = 1e-6;

/// A block of 1 kg without rotation on a plane, with a contact law.
fn block<S: Space>(law: &str, step: f64, theta: f64, dofs: &str) -> Simulation<S> {
    let (up, at) = if S::D == 2 {
        ("0.0, 1.0", "0.0, 0.1")
    } else {
        ("0.0, 0.0, 1.0", "0.0, 0.0, 0.1")
    };
    let center = if S::D == 2 {
        "0.0, 0.0"
    } else {
        "0.0, 0.0, 0.0"
    };
    let text = format!(
        r#"(
    name: "block", dimension: {}, time: (step: {step:e}, end: 1.0, theta: {theta}),
    detection: (alert: 1e-3, skin: 1e-2),
    materials: {{"grain": "verification_grain", "puller": "verification_grain"}},
    solver: (tolerance: 1e-10, norm: Velocity),
    interfaces: [(name: "floor", between: ("grain", "grain"), {law})],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [{up}])]),
        (name: "block", material: "grain", mass: 1.0, shapes: [Balls([([{center}], 0.1)])], position: [{at}], dofs: ({dofs})),
    ],
    output: (frames: 0, views: 0),
)"#,
        S::D
    );
    built(&text)
}

fn built<S: Space>(text: &str) -> Simulation<S> {
    scene::text::<S>(text)
}

fn rate_and_state(a: f64, b: f64, d_c: f64, slip_law: bool) -> String {
    let slip_law = if slip_law { 1.0 } else { 0.0 };
    format!(
        r#"contact: "rate-and-state", parameters: (contact: {{"mu_0": {MU_0}, "a": {a}, "b": {b}, "v_0": {V_0:e}, "d_c": {d_c:e}, "slip_law": {slip_law}}})"#
    )
}

fn step<S: Space>(s: &mut Simulation<S>) -> StepReport {
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.solver.converged, "step {}", s.state.steps);
    assert!(
        report.agreement.friction <= 1e-3,
        "step {}: {:?}",
        s.state.steps,
        report.agreement
    );
    report
}

/// Friction coefficient of the only contact.
fn mu<S: Space>(s: &Simulation<S>) -> f64 {
    let contact = &s.state.network.contacts[0];
    let n = contact.normal.dot(&contact.impulse);
    S::tangential(&contact.normal, &contact.impulse).norm() / n
}

fn near(what: &str, got: f64, wanted: f64, share: f64) {
    assert!(
        (got - wanted).abs() <= share * wanted.abs(),
        "{what}: {got:e} is not {wanted:e} within {share:e}"
    );
}

/// V = V_0 exp((F/P - mu_0)/(a - b)) under a force, in steps far above 2 V m/(a P) = 4e-5 s, with
/// which the velocity at the start of the step would determine the result.
#[test]
fn creep_under_a_force_has_its_velocity_at_any_step() {
    let (a, load) = (0.015, 100.0);
    for (b, ratio) in [(0.0, 0.65), (0.0, 0.62), (0.005, 0.63)] {
        let v = V_0 * ((ratio - MU_0) / (a - b)).exp();
        let law = rate_and_state(a, b, 1e-8, false);
        for h in [1e-4, 1e-2, 1.0] {
            for theta in [0.5, 1.0] {
                let f = ratio * load;
                let plane = format!("x: Force(Constant({f})), y: Force(Constant({}))", -load);
                let mut s = block::<Dim2>(&law, h, theta, &plane);
                (0..150).for_each(|_| drop(step(&mut s)));
                near("plane", s.state.bodies.velocity[1].x, v, 0.01);
                let solid = format!(
                    "x: Force(Constant({})), y: Force(Constant({})), z: Force(Constant({}))",
                    0.6 * f,
                    -0.8 * f,
                    -load
                );
                let mut s = block::<Dim3>(&law, h, theta, &solid);
                (0..150).for_each(|_| drop(step(&mut s)));
                let velocity = &s.state.bodies.velocity[1];
                near("solid", velocity.x, 0.6 * v, 0.01);
                near("solid", velocity.y, -0.8 * v, 0.01);
                near("mu", mu(&s), ratio, 1e-3);
            }
        }
    }
}

/// Friction increases by a ln 10 in the step in which the velocity increases tenfold, and then
/// decays at the rate V_2/D_c of the slip law to a change of (a - b) ln 10.
#[test]
fn a_step_of_velocity_is_the_textbook_one() {
    let (a, b, d_c) = (0.01, 0.015, 1e-5);
    let decade = 10f64.ln();
    for slip_law in [false, true] {
        let law = rate_and_state(a, b, d_c, slip_law);
        let dofs = "x: Velocity(Table([(0.0, 1e-6), (0.99999, 1e-6), (0.999999, 1e-5), (1e3, 1e-5)])), y: Force(Constant(-100.0))";
        let mut s = block::<Dim2>(&law, 1e-2, 1.0, dofs);
        (0..99).for_each(|_| drop(step(&mut s)));
        near("before", mu(&s), MU_0, 1e-6);
        // The velocity increases at the end of the first of these steps.
        (0..2).for_each(|_| drop(step(&mut s)));
        near("at once", mu(&s) - MU_0, a * decade, 0.02);
        for n in 1..400 {
            step(&mut s);
            let state = (-1e-5 * 1e-2 * f64::from(n) / d_c).exp();
            let expected = if slip_law {
                (a - b + b * state) * decade
            } else {
                // The exact state is theta = D_c/V_2 (1 + 9 exp(-V_2 t/D_c)).
                (a - b) * decade + b * (1.0 + 9.0 * state).ln()
            };
            let got = mu(&s) - MU_0;
            assert!((got - expected).abs() < 6e-4, "{n}: {got} {expected}");
        }
    }
}

/// A block pulled at V_0 through a spring slides steadily above K_c = (b - a) P/D_c; below it a
/// disturbance grows to stick-slip.
#[test]
fn a_spring_is_stable_above_the_critical_stiffness() {
    let (a, b, d_c, load) = (0.01, 0.015, 1e-5, 100.0);
    let critical = (b - a) * load / d_c;
    for (share, steady) in [(1.5, true), (0.7, false)] {
        for h in [0.1, 1.0] {
            let text = format!(
                r#"(
    name: "spring", dimension: 2, time: (step: {h:e}, end: 1.0, theta: 1.0),
    detection: (alert: 1e-3, skin: 1e-2),
    materials: {{"grain": "verification_grain", "puller": "verification_grain"}},
    solver: (tolerance: 1e-10, norm: Velocity),
    interfaces: [
        (name: "floor", between: ("grain", "grain"), {}),
        (name: "spring", between: ("grain", "puller"), contact: "frictionless", cohesion: "elastic-foundation", area_factor: 10.0,
         parameters: (cohesion: {{"k_n": {:e}, "k_t": 0.0}})),
    ],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "block", material: "grain", mass: 1.0, shapes: [Balls([([0.0, 0.0], 0.1)])], position: [0.0, 0.1],
         dofs: (x: Force(Constant(60.02)), y: Force(Constant(-100.0)))),
        (name: "puller", material: "puller", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [0.1005, 0.0],
         dofs: (x: Velocity(Constant(1e-6)))),
    ],
    output: (frames: 0, views: 0),
)"#,
                rate_and_state(a, b, d_c, false),
                share * critical
            );
            let mut s = built::<Dim2>(&text);
            let (mut low, mut high) = (f64::INFINITY, 0.0f64);
            // The force is that of steady sliding with a disturbance of 2 % in velocity; 600 s are
            // 60 D_c/V_0.
            while s.state.time < 600.0 && (steady || low > 0.9 && high < 1.1) {
                step(&mut s);
                if s.state.time > 500.0 || !steady && s.state.time > 1.0 {
                    let v = s.state.bodies.velocity[1].x / V_0;
                    (low, high) = (low.min(v), high.max(v));
                }
            }
            if steady {
                assert!(low > 0.99 && high < 1.01, "{share} {h}: {low} to {high}");
            } else {
                assert!(low < 0.9 || high > 1.1, "{share} {h}: {low} to {high}");
            }
        }
    }
}

/// A law with increasing friction on elastic half-spaces: all cells slide, and friction is mu_0 +
/// (a - b) ln(V/V_0) for any step.
#[test]
fn elastic_cells_slide_steadily_under_a_law_that_rises() {
    let (a, b, v) = (0.015, 0.005, 1e-4);
    let expected = MU_0 + (a - b) * f64::ln(v / V_0);
    for h in [1e-2, 1e-3] {
        let text = format!(
            r#"(
    name: "rate and state on elastic bodies", dimension: 2, time: (step: {h:e}, end: 0.5, theta: 1.0),
    materials: {{"steel": "contact_steel"}},
    detection: (alert: 2e-5, skin: 2e-4),
    interfaces: [(name: "c", between: ("steel", "steel"), {})],
    solver: (tolerance: 1e-8, norm: Velocity),
    half_spaces: [
        (name: "flat", material: "steel", x: (from: -7.5e-4, to: 7.5e-4, size: 1.25e-4), depth: 0.02, touches: Surface),
        (name: "cyl", material: "steel", side: Above, x: (from: -7.5e-4, to: 7.5e-4, size: 1.25e-4), depth: 0.02, profile: Summit(x: 0.1), mass: 10.0,
         dofs: (x: Velocity(Ramp(from: 0.0, to: {v:e}, start: 0.01, end: 0.03)), y: Force(Ramp(from: 0.0, to: -2.4e5, start: 0.0, end: 0.01))), touches: Points),
    ],
    output: (frames: 0, views: 0),
)"#,
            rate_and_state(a, b, 1e-6, false)
        );
        let mut s = built::<Dim2>(&text);
        while s.state.time < 0.3 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let mut means = [0.0; 2];
        while s.state.time < 0.32 {
            step(&mut s);
            for contact in &s.state.network.contacts {
                means[0] += contact.impulse.x;
                means[1] += contact.impulse.y;
            }
        }
        near("friction", (means[0] / means[1]).abs(), expected, 2e-3);
    }
}

/// Decreasing friction: a block that decelerates under mu(V) = mu_d + (mu_s - mu_d) exp(-V/V_s) has
/// at the end of every step the friction of its velocity, and comes to rest without an exception.
#[test]
fn falling_friction_is_that_at_the_end_of_the_step() {
    let law = r#"contact: "velocity-weakening", parameters: (contact: {"mu_s": 0.6, "mu_d": 0.2, "v_s": 0.5})"#;
    let dofs = "x: Free, y: Force(Constant(-100.0))";
    let mut s = block::<Dim2>(law, 1e-3, 0.5, dofs);
    s.state.bodies.velocity[1].x = 1.0;
    let mut slid = 0;
    for _ in 0..100 {
        step(&mut s);
        let v = s.state.bodies.velocity[1].x;
        if v > 1e-6 {
            near("mu", mu(&s), 0.2 + 0.4 * (-v / 0.5).exp(), 2e-3);
            slid += 1;
        }
    }
    assert!(slid > 20 && s.state.bodies.velocity[1].x.abs() < 1e-9);
}
