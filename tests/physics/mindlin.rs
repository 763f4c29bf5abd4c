//! Tangential forces of compliant contacts under varying loads are compared with an integration
//! annulus by annulus. Friction dissipates energy in every step, and its bound is that of the force
//! including damping.

use crate::scene;
use crate::stepping::{closes, go};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;
use std::f64::consts::TAU;

const RADIUS: f64 = 0.02;
const YOUNG: f64 = 7e10;
const POISSON: f64 = 0.33;
/// E* and G* = 1/(2 (2 - nu)/G) of two bodies of one material (Pa).
const MODULUS: f64 = YOUNG / (2.0 * (1.0 - POISSON * POISSON));
const SHEAR: f64 = YOUNG / (4.0 * (1.0 + POISSON) * (2.0 - POISSON));

fn scene<S: Space>(law: &str, step: f64, rest: &str) -> Simulation<S> {
    let normal = if S::D == 2 {
        "[0.0, 1.0]"
    } else {
        "[0.0, 0.0, 1.0]"
    };
    let text = format!(
        r#"(
    name: "mindlin", dimension: {}, time: (step: {step:e}, end: 1.0),
    detection: (alert: 1e-3, skin: 5e-3), solver: (tolerance: 1e-9, norm: Velocity),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), {law})],
    output: (frames: 0, views: 0),
    bodies: [
        (name: "plate", material: "grain", shapes: [HalfSpace(normal: {normal})]),
    {rest}
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

fn hertz(more: &str) -> String {
    format!(
        r#"contact: "hertz-mindlin", parameters: (contact: {{
        "young_1": {YOUNG:e}, "young_2": {YOUNG:e}, "poisson_1": {POISSON:?}, "poisson_2": {POISSON:?}, {more}}})"#
    )
}

/// Overlap, and displacements along x and y (m), at a fraction of the run.
type Path3 = fn(f64) -> [f64; 3];

/// A ball that follows a path in a number of steps of 1 us.
fn led(law: &str, path: Path3, count: usize) -> Simulation<Dim3> {
    let table = |of: &dyn Fn([f64; 3]) -> f64| {
        let point = |k: usize| {
            format!(
                "({:e}, {:e})",
                k as f64 * 1e-6,
                of(path(k as f64 / count as f64))
            )
        };
        let points: Vec<String> = (0..=count).step_by(5).map(point).collect();
        format!("Displacement(Table([{}]))", points.join(", "))
    };
    scene::<Dim3>(
        law,
        1e-6,
        &format!(
            r#"(name: "ball", material: "grain", mass: 1.0, shapes: [Balls([([0.0, 0.0, 0.0], {RADIUS:?})])], position: [0.0, 0.0, {RADIUS:?}],
            dofs: (x: {}, y: {}, z: {}))]"#,
            table(&|p| p[1]),
            table(&|p| p[2]),
            table(&|p| -p[0]),
        ),
    )
}

/// Tangential force of independent springs side by side, each followed separately: at the radius x
/// the pressure is 2 E* (d - x^2/R) and the tangential stiffness 8 G* per width, |q| <= mu p
/// (Cattaneo and Mindlin for any history, as a sum over flat punches: M. Ciavarella, J. Jaeger).
struct Annuli {
    at: Vec<[f64; 2]>,
    width: f64,
    mu: f64,
}

impl Annuli {
    fn new(mu: f64, overlap: f64) -> Self {
        const COUNT: usize = 400;
        Self {
            at: vec![[0.0; 2]; COUNT],
            width: (RADIUS * overlap).sqrt() / COUNT as f64,
            mu,
        }
    }

    fn step(&mut self, overlap: f64, by: [f64; 2]) -> [f64; 2] {
        let mut force = [0.0; 2];
        for (k, u) in self.at.iter_mut().enumerate() {
            let x = (k as f64 + 0.5) * self.width;
            let pressure = 2.0 * MODULUS * (overlap - x * x / RADIUS).max(0.0);
            let bound = self.mu * pressure / (8.0 * SHEAR);
            for (u, by) in u.iter_mut().zip(by) {
                *u += by;
            }
            let size = u[0].hypot(u[1]);
            if size > bound {
                u.iter_mut().for_each(|u| *u *= bound / size);
            }
            force[0] += 8.0 * SHEAR * self.width * u[0];
            force[1] += 8.0 * SHEAR * self.width * u[1];
        }
        force
    }
}

/// Energy that friction supplies was dissipated by it before.
fn steps<S: Space>(s: &mut Simulation<S>, n: usize) {
    for _ in 0..n {
        go(s, 1);
        let e = s.state.energy;
        assert!(
            e.friction >= -1e-9 * e.scale,
            "friction made {:e} J of {:e} J until step {}",
            -e.friction,
            e.scale,
            s.state.steps
        );
    }
    closes(s, 1e-12);
}

fn ramp(t: f64, points: &[(f64, f64)]) -> f64 {
    let k = points.iter().rposition(|p| p.0 <= t).unwrap();
    let (t0, x0) = points[k];
    match points.get(k + 1) {
        Some((t1, x1)) => x0 + (t - t0) / (t1 - t0) * (x1 - x0),
        None => x0,
    }
}

/// The contact is pressed, sheared, and lifted by half: T decreases by sqrt(2).
fn lifted(t: f64) -> [f64; 3] {
    let depth = ramp(t, &[(0.0, 0.0), (0.3, 2e-6), (0.6, 2e-6), (0.9, 1e-6)]);
    [
        depth,
        ramp(t, &[(0.0, 0.0), (0.35, 0.0), (0.55, 5e-7)]),
        0.0,
    ]
}

/// Load and displacement are out of phase.
fn out_of_phase(t: f64) -> [f64; 3] {
    let s = (5.0 * TAU * t).sin();
    let start = ramp(t, &[(0.0, 0.0), (0.1, 1.0)]);
    [
        start * (2e-6 + 0.8e-6 * s),
        5e-7 * start * (5.0 * TAU * t).cos(),
        0.0,
    ]
}

/// The contact is sheared once, and then the load varies.
fn held(t: f64) -> [f64; 3] {
    let start = ramp(t, &[(0.0, 0.0), (0.1, 1.0)]);
    let cycles = ramp(t, &[(0.0, 0.0), (0.2, 0.0), (0.25, 1.0)]);
    let depth = 2e-6 * start + 0.6e-6 * cycles * (8.0 * TAU * t).sin();
    [depth, ramp(t, &[(0.0, 0.0), (0.1, 0.0), (0.2, 5e-7)]), 0.0]
}

/// The contact is loaded obliquely, and unloaded in another direction.
fn oblique(t: f64) -> [f64; 3] {
    let depth = 2e-6 * ramp(t, &[(0.0, 0.0), (0.5, 1.0), (1.0, 0.05)]);
    [
        depth,
        6e-7 * ramp(t, &[(0.0, 0.0), (0.5, 1.0)]),
        4e-7 * ramp(t, &[(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)]),
    ]
}

/// Forces along paths of overlap and displacement are compared with the annuli, with friction at
/// which a part slips, all slips, and nothing slips.
#[test]
fn forces_follow_any_history_of_load_and_displacement() {
    let paths: [(&str, Path3); 4] = [
        ("lifted", lifted),
        ("out of phase", out_of_phase),
        ("held", held),
        ("oblique", oblique),
    ];
    const COUNT: usize = 2000;
    for (name, path) in paths {
        for mu in [0.15, 0.5, 10.0] {
            let mut s = led(&hertz(&format!("\"mu\": {mu:?}")), path, COUNT);
            let mut annuli = Annuli::new(mu, 3e-6);
            let (mut worst, mut largest, mut last) = (0.0f64, 0.0f64, path(0.0));
            for k in 1..=COUNT {
                let at = path(k as f64 / COUNT as f64);
                let wanted = annuli.step(at[0], [at[1] - last[1], at[2] - last[2]]);
                last = at;
                steps(&mut s, 1);
                // The force of a step is at the place of the next middle.
                let force = s.state.network.contacts.first().map(|c| c.spring.force_t);
                let got = force.map_or([0.0; 2], |f| [f.x, f.y]);
                worst = worst.max((got[0] - wanted[0]).hypot(got[1] - wanted[1]));
                largest = largest.max(wanted[0].hypot(wanted[1]));
            }
            // With very large friction the profile has more corners than are stored.
            let allowed = if mu > 1.0 { 0.16 } else { 0.06 };
            assert!(
                worst < allowed * largest,
                "{name}, mu {mu}: off by {worst:.3} N of {largest:.3} N"
            );
        }
    }
}

/// T of a sticking contact decreases with its radius: 6.30 N at 2 um, 6.30/sqrt(2) N at 1 um, and
/// the energy of the lost springs, (1 - 1/sqrt(2)) T^2/(2 k_0), is friction. At mu = 10 the rim
/// slips a little, where the pressure vanishes: the annuli have 1 % less.
#[test]
fn a_lifted_contact_carries_less() {
    const COUNT: usize = 2000;
    let mut s = led(&hertz("\"mu\": 10.0"), lifted, COUNT);
    steps(&mut s, COUNT);
    let mut annuli = Annuli::new(10.0, 2e-6);
    let (mut last, mut with_rim) = (lifted(0.0), 0.0);
    for k in 1..=COUNT {
        let at = lifted(k as f64 / COUNT as f64);
        with_rim = annuli.step(at[0], [at[1] - last[1], 0.0])[0];
        last = at;
    }
    let k_0 = 8.0 * SHEAR * (RADIUS * 2e-6).sqrt();
    let (force, held) = (k_0 * 5e-7, 0.5 * k_0 * 2.5e-13);
    let found = s.state.network.contacts[0].spring.force_t.norm();
    assert!((found / with_rim - 1.0).abs() < 1e-3, "{found} {with_rim}");
    let without = force / 2f64.sqrt();
    assert!(
        0.985 * without < found && found < without,
        "{found} {without}"
    );
    let (friction, wanted) = (s.state.energy.friction, (1.0 - 0.5f64.sqrt()) * held);
    assert!(
        (friction / wanted - 1.0).abs() < 5e-2,
        "{friction:e} {wanted:e}"
    );
}

/// Wear by slip counts the displacement that is not elastic, delta - T/k_0: under a constant load
/// it is 4 (D - T_D/k_0) in a loop of amplitude D, T_D = mu P (1 - (1 - D/D_s)^1.5) (Mindlin and
/// Deresiewicz).
#[test]
fn wear_counts_the_slip_of_partial_slip() {
    const COUNT: usize = 4000;
    const K: f64 = 1e-14;
    const MU: f64 = 0.5;
    const DEPTH: f64 = 2e-6;
    /// Displacement from which all slips, and the amplitude (m).
    const WHOLE: f64 = MU * MODULUS * DEPTH / (4.0 * SHEAR);
    const AMPLITUDE: f64 = 0.8 * WHOLE;
    fn path(t: f64) -> [f64; 3] {
        let depth = ramp(t, &[(0.0, 0.0), (0.2, DEPTH)]);
        let turns = ramp(t, &[(0.0, 0.0), (0.2, 0.0), (1.0, 2.25)]);
        [depth, AMPLITUDE * (TAU * turns).sin(), 0.0]
    }
    let wears = format!("}}, wear: {{\"k\": {K:e}}})");
    let law = hertz(&format!("\"mu\": {MU:?}")).replace("})", &wears) + ", wear: \"archard\"";
    let mut s = led(&law, path, COUNT);
    // The loop is taken from the second peak to the third.
    let (mut worn, mut from) = (0.0, 0.0);
    let at = |turns: f64| (COUNT as f64 * (0.2 + 0.8 * turns / 2.25)).round() as usize;
    for k in 0..at(2.25) {
        if k == at(1.25) {
            from = worn;
        }
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        worn += report.totals.worn_first;
    }
    let load = 4.0 / 3.0 * MODULUS * RADIUS.sqrt() * DEPTH.powf(1.5);
    let k_0 = 8.0 * SHEAR * (RADIUS * DEPTH).sqrt();
    let force = MU * load * (1.0 - (1.0 - AMPLITUDE / WHOLE).powf(1.5));
    let slip = 4.0 * (AMPLITUDE - force / k_0);
    let ratio = (worn - from) / (K * load * slip);
    println!("wear of a loop over k P s: {ratio}");
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

/// A sphere (a disk) hits a plate and slides throughout: the impulse of friction is mu times the
/// normal one, by which it rotates, omega = 5 mu (1 + e) v_n/(2 R) (a disk 2 mu (1 + e) v_n/R).
#[test]
fn friction_is_that_of_the_force_with_its_damping() {
    const MU: f64 = 0.1;
    fn thrown<S: Space>(law: &str, inertia: f64) -> (f64, f64) {
        let (at, velocity) = match S::D {
            2 => ("[0.0, 0.0201]", "[4.0, -1.0]"),
            _ => ("[0.0, 0.0, 0.0201]", "[4.0, 0.0, -1.0]"),
        };
        let grain = format!("(at: {at}, radius: 0.02, velocity: {velocity})");
        let mut s = scene::<S>(
            law,
            1e-6,
            &format!("],\n grains: [List(material: \"grain\", grains: [{grain}])],"),
        );
        while s.state.time < 2e-3 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let (v, w) = (s.state.bodies.velocity[0], s.state.bodies.spin[0]);
        let normal = v[S::D - 1] + 1.0;
        let turned = w.norm() * inertia * RADIUS;
        ((4.0 - v[0]) / (MU * normal), turned / (MU * normal))
    }
    for e in [0.8, 0.5, 0.2] {
        let soft = format!(
            r#""young_1": 1e9, "young_2": 1e9, "poisson_1": 0.3, "poisson_2": 0.3, "mu": {MU:?}, "restitution": {e:?}"#
        );
        let hertz = format!(r#"contact: "hertz-mindlin", parameters: (contact: {{{soft}}})"#);
        let more = format!(r#""stiffness": 1e6, "ratio": 0.8, "restitution": {e:?}"#);
        let linear = format!(
            r#"contact: "linear-contact", parameters: (contact: {{{more}, "mu": {MU:?}}})"#
        );
        let stiff = linear.replace("1e6", "1e8");
        for (law, found) in [
            (&hertz, thrown::<Dim3>(&hertz, 0.4)),
            (&hertz, thrown::<Dim2>(&hertz, 0.5)),
            (&linear, thrown::<Dim3>(&linear, 0.4)),
            (&stiff, thrown::<Dim2>(&stiff, 0.5)),
        ] {
            let (slowed, turned) = found;
            // With large damping it sticks for a moment, until its spring has reached the friction
            // bound.
            let allowed = if e < 0.3 { 0.03 } else { 0.01 };
            assert!((slowed - 1.0).abs() < allowed, "{e} {law}: {slowed}");
            assert!((turned - 1.0).abs() < allowed, "{e} {law}: {turned}");
        }
    }
}

/// No compliant law creates energy by friction on a rough path through contact, slip and
/// separation: linear springs dissipate in every step. The profile of `hertz-mindlin`, which stores
/// few corners, returns little of the energy that it has dissipated.
#[test]
fn friction_of_springs_takes_energy() {
    fn rough(t: f64) -> [f64; 3] {
        let (a, b, c) = (
            (13.0 * TAU * t).sin(),
            (29.0 * TAU * t).sin(),
            (7.0 * TAU * t).cos(),
        );
        [
            1e-6 * (1.0 + 0.8 * a + 0.6 * b),
            6e-7 * (c - 1.0 + 0.4 * a),
            4e-7 * b,
        ]
    }
    let spring = r#""stiffness": 1e7, "ratio": 0.8"#;
    let laws = [
        hertz("\"mu\": 0.4"),
        hertz("\"mu\": 4.0, \"restitution\": 0.3"),
        format!(r#"contact: "linear-contact", parameters: (contact: {{{spring}, "mu": 0.4}})"#),
    ];
    for law in laws {
        let mut s = led(&law, rough, 4000);
        steps(&mut s, 4000);
        let e = s.state.energy;
        let allowed = if law.contains("mindlin") { 0.04 } else { 1e-9 };
        assert!(
            e.friction > 0.0 && e.given_by_friction <= allowed * e.friction,
            "{law}: {e:?}"
        );
    }
}
