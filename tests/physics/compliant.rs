//! Compliant contacts compared with closed forms: force, impact, chain, partial slip; energy; every
//! method of the solver.

use crate::scene;
use crate::stepping::{closes, go};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::f64::consts::PI;
use std::path::Path;

/// E* of two bodies of `STEEL` (Pa), and R.
pub const MODULUS: f64 = 2e9 / (2.0 * (1.0 - 0.09));
/// Hertz' spring of a material of 2 GPa.
pub const HERTZ: &str = r#"contact: "hertz-mindlin""#;

pub fn moduli(more: &str) -> String {
    format!("young_1: 2e9, young_2: 2e9, poisson_1: 0.3, poisson_2: 0.3, {more}")
}

/// A scene whose bodies are of one material with one contact law and its parameters.
fn built<S: Space>(law: &str, parameters: &str, step: f64, rest: &str) -> Simulation<S> {
    built_with_alert(1e-3, law, parameters, step, rest)
}

/// The scene with an alert distance (m).
pub fn built_with_alert<S: Space>(
    alert: f64,
    law: &str,
    parameters: &str,
    step: f64,
    rest: &str,
) -> Simulation<S> {
    let text = format!(
        r#"(
    name: "compliant",
    dimension: {},
    time: (step: {step:e}, end: 1.0),
    detection: (alert: {alert:e}, skin: 5e-3),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), {law}, parameters: (contact: {{{parameters}}}))],
    output: (frames: 0, views: 0),
    {rest}
)"#,
        S::D
    );
    let text = quote(&text);
    scene::text::<S>(&text)
}

/// Puts the keys of parameters into quotes.
fn quote(text: &str) -> String {
    let mut out = text.to_owned();
    for name in [
        "young_1",
        "young_2",
        "poisson_1",
        "poisson_2",
        "restitution",
        "mu",
        "stiffness",
        "ratio",
        "force",
    ] {
        out = out.replace(&format!("{name}: "), &format!("\"{name}\": "));
    }
    out
}

pub fn steps<S: Space>(s: &mut Simulation<S>, n: usize) {
    go(s, n);
    closes(s, 1e-12);
}

fn near(got: f64, wanted: f64, share: f64) {
    assert!(
        (got - wanted).abs() <= share * wanted.abs(),
        "{got:e} is not {wanted:e} within {share:e}"
    );
}

/// A ball at rest under its weight: P = 4/3 E* sqrt(R) d^(3/2); a disk: P = pi/4 E* d (K. L.
/// Johnson, Contact Mechanics, 4.2).
#[test]
fn a_body_at_rest_has_the_overlap_of_its_weight() {
    let parameters = moduli("restitution: 0.05, mu: 0.3");
    let mut s: Simulation<Dim3> = built(
        HERTZ,
        &parameters,
        2e-5,
        r#"gravity: [0.0, 0.0, -9.81],
        grains: [List(material: "grain", grains: [(at: [0.0, 0.0, 0.05], radius: 0.05)])],
        bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])])]"#,
    );
    steps(&mut s, 4000);
    let weight = s.state.bodies.mass[0] * 9.81;
    let wanted = (0.75 * weight / (MODULUS * 0.05f64.sqrt())).powf(2.0 / 3.0);
    near(-s.state.network.contacts[0].gap, wanted, 1e-6);
    near(
        s.state.network.contacts[0].spring.energy[0],
        0.4 * weight * wanted,
        2e-2,
    );
    let mut s: Simulation<Dim2> = built(
        HERTZ,
        &parameters,
        2e-5,
        r#"gravity: [0.0, -9.81],
        grains: [List(material: "grain", grains: [(at: [0.0, 0.05], radius: 0.05)])],
        bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])]"#,
    );
    steps(&mut s, 4000);
    let weight = s.state.bodies.mass[0] * 9.81;
    near(
        -s.state.network.contacts[0].gap,
        weight / (0.25 * PI * MODULUS),
        1e-6,
    );
}

/// Impact of two equal balls: the duration is 2.868 (m*^2/(R E*^2 v))^(1/5) (K. L. Johnson, eq.
/// 11.25), and the restitution is the given one. The loss of the scheme is of first order in the
/// step.
#[test]
fn an_impact_lasts_and_rebounds_as_hertz_says() {
    let impact = |restitution: f64, step: f64| {
        let mut s: Simulation<Dim3> = built(
            HERTZ,
            &moduli(&format!("restitution: {restitution:?}, mu: 0.0")),
            step,
            r#"grains: [List(material: "grain", grains: [
                (at: [-0.0501, 0.0, 0.0], radius: 0.05, velocity: [0.5, 0.0, 0.0]),
                (at: [0.0501, 0.0, 0.0], radius: 0.05, velocity: [-0.5, 0.0, 0.0])])]"#,
        );
        let mut touched = 0;
        while s.state.time < 1.2e-3 {
            steps(&mut s, 1);
            touched += usize::from(
                s.state
                    .network
                    .contacts
                    .iter()
                    .any(|c| c.spring.force_n > 0.0),
            );
        }
        let apart = (s.state.bodies.velocity[0] - s.state.bodies.velocity[1]).norm();
        (apart, touched as f64 * step, s.state.bodies.mass[0])
    };
    let (apart, time, mass) = impact(1.0, 1e-6);
    let wanted = 2.868 * ((0.5 * mass).powi(2) / (0.025 * MODULUS * MODULUS)).powf(0.2);
    near(time, wanted, 1e-2);
    near(apart, 1.0, 1e-2);
    let (finer, ..) = impact(1.0, 5e-7);
    near((1.0 - apart) / (1.0 - finer), 2.0, 0.1);
    for restitution in [0.8, 0.4, 0.1] {
        let (apart, ..) = impact(restitution, 1e-6);
        near(apart, restitution, 2e-2);
    }
}

/// A chain of n balls pressed together between walls: the lowest frequency is 2 sqrt(k/m) sin(pi/(2
/// (n + 1))), which corresponds to the speed of sound of long waves, 2 R sqrt(k/m).
#[test]
fn a_chain_has_the_speed_of_sound_of_its_springs() {
    const N: usize = 20;
    let (radius, overlap, k) = (0.05, 1e-5, 1e6);
    let spacing = 2.0 * radius - overlap;
    let at = |i: usize| radius - overlap + spacing * i as f64;
    let wave = |i: usize| 1e-3 * (PI * (i + 1) as f64 / (N + 1) as f64).sin();
    let grains: Vec<String> = (0..N)
        .map(|i| {
            let (x, v) = (at(i), wave(i));
            format!("(at: [{x:?}, 0.0, 0.0], radius: {radius:?}, velocity: [{v:e}, 0.0, 0.0])")
        })
        .collect();
    let end = at(N - 1) + radius - overlap;
    let mut s: Simulation<Dim3> = built(
        r#"contact: "linear-contact""#,
        &format!("stiffness: {k:e}, mu: 0.0"),
        1e-5,
        &format!(
            r#"grains: [List(material: "grain", grains: [{}])],
            bodies: [
                (name: "left", material: "grain", shapes: [HalfSpace(normal: [1.0, 0.0, 0.0])]),
                (name: "right", material: "grain", shapes: [HalfSpace(normal: [-1.0, 0.0, 0.0], at: [{end:?}, 0.0, 0.0])]),
            ]"#,
            grains.join(", ")
        ),
    );
    let mass = s.state.bodies.mass[0];
    let amplitude = |s: &Simulation<Dim3>| -> f64 {
        (0..N).map(|i| s.state.bodies.velocity[i].x * wave(i)).sum()
    };
    // The velocity of the mode is a cosine: its first zero is at a quarter of a period, its second
    // at three quarters.
    let (mut zeros, mut last) = (Vec::new(), amplitude(&s));
    while zeros.len() < 2 {
        steps(&mut s, 1);
        let now = amplitude(&s);
        if now * last <= 0.0 {
            zeros.push(s.state.time - 1e-5 * now / (now - last));
        }
        last = now;
    }
    let wanted = 2.0 * (k / mass).sqrt() * (PI / (2.0 * (N + 1) as f64)).sin();
    near(PI / (zeros[1] - zeros[0]), wanted, 1e-3);
}

/// A ball is pressed on a plate that moves to and fro by less than gross slip needs: the loop is
/// that of Mindlin and Deresiewicz, K. L. Johnson, eq. 7.57, with the compliances (2 - nu)/G of
/// both bodies.
#[test]
fn a_tangential_loop_takes_the_energy_of_partial_slip() {
    let (mu, press, radius, nu) = (0.4, 100.0, 0.05, 0.3);
    let shear = 2e9 / (2.0 * (1.0 + nu));
    let k_0 = |a: f64| 8.0 * a * shear / (2.0 * (2.0 - nu));
    let a = (0.75 * press * radius / MODULUS).cbrt();
    for x in [0.5, 0.8] {
        let reach = 1.5 * mu * press / k_0(a) * (1.0 - (1.0f64 - x).powf(2.0 / 3.0));
        let (period, step) = (0.02, 1e-5);
        let mut s: Simulation<Dim3> = built(
            HERTZ,
            &moduli(&format!("restitution: 0.1, mu: {mu:?}")),
            step,
            &format!(
                r#"bodies: [
                (name: "plate", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])]),
                (name: "ball", material: "grain", mass: 0.5, position: [0.0, 0.0, {radius:?}],
                 shapes: [Balls([([0.0, 0.0, 0.0], {radius:?})])],
                 dofs: (x: Displacement(Sine(amplitude: {reach:e}, frequency: 50.0, start: 0.02)), y: Fixed,
                        z: Force(Constant(-{press:?})), rx: Fixed, ry: Fixed, rz: Fixed)),
            ]"#
            ),
        );
        let cycle = (period / step) as usize;
        steps(&mut s, 2 * cycle + cycle / 4);
        let force = s.state.network.contacts[0].spring.force_t.norm();
        near(force, x * mu * press, 1e-2);
        let before = s.state.energy.friction;
        steps(&mut s, cycle);
        let lost = s.state.energy.friction - before;
        let y: f64 = 1.0 - x;
        let shape = 1.0 - y.powf(5.0 / 3.0) - 5.0 * x / 6.0 * (1.0 + y.powf(2.0 / 3.0));
        let both = 2.0 * (2.0 - nu) / shear;
        let wanted = 9.0 * (mu * press).powi(2) / (10.0 * a) * both * shape;
        near(lost, wanted, 1e-2);
    }
}

/// A ball pushed along a plate beyond the friction bound moves as on a rigid contact, for any
/// stiffness; the energy of the springs decreases with 1/k.
#[test]
fn stiff_contacts_tend_to_rigid_ones() {
    let pushed = |law: &str, parameters: &str| {
        let mut s: Simulation<Dim2> = built(
            law,
            parameters,
            1e-4,
            r#"gravity: [4.905, -9.81],
            grains: [List(material: "grain", grains: [(at: [0.0, 0.05], radius: 0.05)])],
            bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])]"#,
        );
        steps(&mut s, 2000);
        (s.state.bodies.velocity[0], s.state.bodies.spin[0])
    };
    let (rigid, turn) = pushed(r#"contact: "coulomb""#, "mu: 0.1");
    // The ball slides: v = (g_x - mu g_y) t.
    near(rigid.x, (4.905 - 0.981) * 0.2, 1e-6);
    let mut errors = Vec::new();
    for k in [1e6, 1e7, 1e8, 1e10] {
        let (v, w) = pushed(
            r#"contact: "linear-contact""#,
            &format!("stiffness: {k:e}, mu: 0.1, restitution: 0.1"),
        );
        errors.push(((v - rigid).norm() / rigid.norm()).max((w - turn).norm() / turn.norm()));
    }
    assert!(errors.windows(2).all(|e| e[1] <= e[0]), "{errors:?}");
    assert!(errors[3] < 1e-6, "{errors:?}");
}

/// A heap settles under its weight: every method gives equal positions within the tolerance.
#[test]
fn every_method_serves_compliant_contacts() {
    let heap = |method: &str| {
        let mut s: Simulation<Dim2> = built(
            r#"contact: "linear-contact""#,
            "stiffness: 1e7, mu: 0.4, restitution: 0.5",
            1e-4,
            &format!(
                r#"solver: (method: {method}, norm: Velocity, tolerance: 1e-8, max_iterations: 200000),
            gravity: [0.0, -9.81], seed: 3,
            grains: [Lattice(material: "grain", count: 30, radius: (0.02, 0.03), low: [-0.2, 0.03], high: [0.2, 0.6])],
            bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
                     (name: "left", material: "grain", shapes: [HalfSpace(normal: [1.0, 0.0], at: [-0.2, 0.0])]),
                     (name: "right", material: "grain", shapes: [HalfSpace(normal: [-1.0, 0.0], at: [0.2, 0.0])])]"#
            ),
        );
        steps(&mut s, 1500);
        assert!(
            s.state
                .network
                .contacts
                .iter()
                .any(|c| c.spring.force_t != 0.0 * c.spring.force_t)
        );
        s.state.bodies.position.clone()
    };
    let wanted = heap("Nlgs");
    for method in [
        "NlgsSymmetric",
        "Anderson",
        "Pg",
        "Cpg",
        "Pcpg",
        "Apgd",
        "Newton",
        "Interior",
        "Auto",
    ] {
        let got = heap(method);
        let off = got.iter().zip(&wanted).map(|(a, b)| (a - b).norm());
        let worst = off.fold(0.0, f64::max);
        assert!(worst < 1e-6, "{method}: {worst:e}");
    }
}

/// Two balls that overlap at the start separate with the energy of their spring, which is booked as
/// supplied.
#[test]
fn overlaps_of_the_initial_state_bring_their_energy() {
    let (overlap, k) = (1e-4, 1e6);
    let mut s: Simulation<Dim3> = built(
        r#"contact: "linear-contact""#,
        &format!("stiffness: {k:e}, mu: 0.0"),
        1e-6,
        &format!(
            r#"grains: [List(material: "grain", grains: [
                (at: [0.0, 0.0, 0.0], radius: 0.05), (at: [{:?}, 0.0, 0.0], radius: 0.05)])]"#,
            0.1 - overlap
        ),
    );
    let stored = 0.5 * k * overlap * overlap;
    steps(&mut s, 1);
    near(s.state.energy.external_work, stored, 1e-9);
    steps(&mut s, 4000);
    near(s.state.energy.kinetic, stored, 1e-2);
    near(s.state.energy.scheme, stored - s.state.energy.kinetic, 1e-2);
}

/// A stiff Hertz contact reaches its equilibrium in large steps too, k h^2/m from 30 to 3e4, and
/// after a kick.
#[test]
fn stiff_contacts_come_to_rest_in_large_steps() {
    for step in [2e-4, 1e-3, 5e-3] {
        let mut s: Simulation<Dim3> = built(
            HERTZ,
            &moduli("restitution: 0.05, mu: 0.3"),
            step,
            r#"gravity: [0.0, 0.0, -9.81],
            grains: [List(material: "grain", grains: [(at: [0.0, 0.0, 0.05], radius: 0.05)])],
            bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])])]"#,
        );
        let weight = s.state.bodies.mass[0] * 9.81;
        let wanted = (0.75 * weight / (MODULUS * 0.05f64.sqrt())).powf(2.0 / 3.0);
        for kick in [0.0, wanted / step] {
            s.state.bodies.velocity[0].z += kick;
            for _ in 0..400 {
                s.step().unwrap_or_else(|e| panic!("{e}"));
            }
            near(-s.state.network.contacts[0].gap, wanted, 1e-3);
        }
    }
}

/// A ball hangs below a plate by an attraction of twice its weight, and does not creep along it
/// when gravity is tilted: the spring carries the difference of attraction and weight.
#[test]
fn attraction_presses_a_spring() {
    let (k, angle) = (1e6, 0.1f64);
    let mass = 1000.0 * 4.0 / 3.0 * PI * 0.05f64.powi(3);
    let weight = mass * 9.81;
    let mut s: Simulation<Dim3> = built(
        r#"contact: "linear-contact", cohesion: "constant-attraction""#,
        &format!(
            "stiffness: {k:e}, mu: 0.5, restitution: 0.1}}, cohesion: {{force: {:e}",
            2.0 * weight
        ),
        1e-4,
        &format!(
            r#"gravity: [{:e}, 0.0, -{:e}],
            grains: [List(material: "grain", grains: [(at: [0.0, 0.0, -0.05], radius: 0.05)])],
            bodies: [(name: "plate", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, -1.0])])]"#,
            9.81 * angle.sin(),
            9.81 * angle.cos()
        ),
    );
    // The ball cannot roll.
    s.state.bodies.inverse_inertia[0] = 0.0;
    steps(&mut s, 4000);
    let overlap = weight * (2.0 - angle.cos()) / k;
    near(-s.state.network.contacts[0].gap, overlap, 1e-4);
    let speed = s.state.bodies.velocity[0].norm();
    assert!(speed < 1e-3 * weight / (k * 0.4), "{speed:e}");
}

/// Moduli are those of the materials of the interface, in its order, unless the case gives them; a
/// material without them is rejected.
#[test]
fn moduli_come_from_the_materials() {
    let moduli = |first: &str, parameters: &str| {
        let text = format!(
            r#"(
    name: "moduli", dimension: 3, time: (step: 1e-5, end: 1e-3),
    materials: {{"first": "{first}", "second": "rail_steel_r260"}},
    interfaces: [(name: "all", between: ("first", "second"), contact: "hertz-mindlin", {parameters})],
    grains: [List(material: "first", grains: [(at: [0.0, 0.0, 0.1], radius: 0.05)])],
    bodies: [(name: "floor", material: "second", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])])],
    output: (frames: 0, views: 0),
)"#
        );
        let loaded = load_text("moduli.ron", &text, Path::new("."), &[])?;
        let built = loaded.build_in::<Dim3>(&search_path())?;
        let contact = built.laws[0].contact();
        let value = |name: &str| {
            let at = contact
                .plugin
                .parameters
                .iter()
                .position(|p| p.name == name);
            contact.parameters[at.unwrap()]
        };
        Ok::<_, fretwork::scene::InputError>(
            ["young_1", "poisson_1", "young_2", "poisson_2"].map(value),
        )
    };
    let of_files = moduli("magnetite", "").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(of_files, [1.65e11, 0.35, 2.1e11, 0.3]);
    let own = r#"parameters: (contact: {"young_1": (value: 7.0, unit: "GPa")})"#;
    let given = moduli("magnetite", own).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(given, [7e9, 0.35, 2.1e11, 0.3]);
    let refused = moduli("verification_grain", "").unwrap_err().to_string();
    assert!(
        refused.contains("needs `young` of the material `first`"),
        "{refused}"
    );
}

/// Damped bonds that act in tension only on springs, with damage: they open and close, pull while
/// closed, and would push while open. With the dissipation of the damping the ledger closes for any
/// step.
#[test]
fn damped_bonds_on_springs_keep_the_ledger() {
    for step in [1e-3, 1e-4, 1e-5] {
        for damping in [1e4, 1e5, 1e6] {
            let mut s: Simulation<Dim2> = built(
                r#"contact: "linear-contact", cohesion: "elastic-bond", damage: "linear-softening", bonds: Start, bonds_within: 1e-6"#,
                &format!(
                    r#"stiffness: 1e6, ratio: 0.8, restitution: 0.3, mu: 0.3}},
                    cohesion: {{"k_n": 1e7, "k_t": 1e7, "d_n": {damping:e}, "d_t": {damping:e}}}, damage: {{"strength": 5e3, "energy": 50.0"#
                ),
                step,
                r#"grains: [List(material: "grain", grains: [
                    (at: [0.0, 0.05], radius: 0.05, velocity: [0.02, 0.05]), (at: [0.0, 0.15], radius: 0.05, velocity: [-0.03, -0.3])
                ])],
                bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])]"#,
            );
            steps(&mut s, (0.2 / step) as usize);
            let e = s.state.energy;
            let bonds = s.state.network.memory.iter().flat_map(|m| &m.bonds);
            let lost: f64 = bonds.map(|b| b.energies.viscous).sum();
            assert!(
                lost > 1e-3 * e.initial_kinetic,
                "bonds lost {lost:e}: {e:?}"
            );
        }
    }
}
