//! Attraction that depends on the gap: pull-off force and work of separation are compared with
//! closed forms at several steps.
//!
//! JKR: 3 pi w R/2 under a force (K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324
//! (1971) 301-313); DMT: 2 pi w R, and z_0 times that as work of the law's force over the gap; van
//! der Waals: A R/(6 z_0^2) and A R/(6 z_0), of parallel cylinders A sqrt(R)/(8 sqrt(2) z_0^(5/2))
//! and A sqrt(R)/(12 sqrt(2) z_0^(3/2)) (J. N. Israelachvili, Intermolecular and Surface Forces,
//! chapter 13); linear adhesion: f, and f^2/(2 k); a liquid bridge: 2 pi gamma (2 R), and 2 pi
//! gamma (2 R) lambda (1 - exp(-d/lambda)) up to the rupture at d = V^(1/3) (V. Richefeu et al.,
//! Phys. Rev. E 73 (2006) 051304).

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::{Simulation, StepReport};
use std::f64::consts::PI;

/// Radius of balls and disks (m).
const RADIUS: f64 = 3.7e-5;
const COULOMB: &str = r#"contact: "coulomb", parameters: (contact: {"mu": 0.3}"#;
/// Springs as stiff as E* = 100 GPa makes them.
const HERTZ: &str = r#"contact: "hertz-mindlin", parameters: (contact: {"young_1": 1.82e11, "young_2": 1.82e11, "poisson_1": 0.3, "poisson_2": 0.3, "restitution": 0.5, "mu": 0.3}"#;

/// An attraction with its pull-off force (N; N/m in 2D), work of separation (J) from contact on,
/// and range (m).
struct Attraction {
    law: &'static str,
    parameters: &'static str,
    force: f64,
    work: f64,
    range: f64,
}

/// Attractions between balls, or a ball and a plane, of the reduced radius `r`.
fn in_space(r: f64) -> Vec<Attraction> {
    let lambda = 0.9 / 2f64.sqrt() * (1e-18 / (2.0 * r)).sqrt();
    let bridge = 2.0 * PI * 0.072 * 2.0 * r;
    // The neck has 4 P_c (x^(3/2) - x^3) over the approach (a_0^2/R)(x^2 - 2/3 x^(1/2)), from x =
    // (1/6)^(2/3) to (2/3)^(2/3), integrated in closed form.
    let (w, modulus) = (0.23, 2e9);
    let pull_off = 1.5 * PI * w * r;
    let length = (4.5 * PI * w / modulus / r).cbrt().powi(2) * r;
    let integral = |x: f64| {
        // This is the integral of 4 (x^(3/2) - x^3)(2 x - x^(-1/2)/3).
        4.0 * (2.0 / 3.5 * x.powf(3.5) - x.powi(2) / 6.0 - 0.4 * x.powi(5) + x.powf(3.5) / 10.5)
    };
    let [torn, closed] = [1.0 / 6.0, 2.0 / 3.0f64].map(|x: f64| x.powf(2.0 / 3.0));
    let reach = length * (2.0 / 3.0 * torn.sqrt() - torn * torn);
    vec![
        Attraction {
            law: "jkr",
            parameters: r#""w": 0.23, "modulus": 2e9"#,
            force: pull_off,
            work: pull_off * length * (integral(closed) - integral(torn)),
            range: reach,
        },
        Attraction {
            law: "dmt",
            parameters: r#""w": 0.1, "z_0": 4e-10, "range": 1e-6"#,
            force: 2.0 * PI * 0.1 * r,
            work: 2.0 * PI * 0.1 * r * 4e-10,
            range: 4e-10,
        },
        Attraction {
            law: "van-der-waals",
            parameters: r#""hamaker": 1e-19, "z_0": 4e-10, "range": 1e-6"#,
            force: 1e-19 * r / (6.0 * 4e-10 * 4e-10),
            work: 1e-19 * r / (6.0 * 4e-10),
            range: 4e-10,
        },
        Attraction {
            law: "linear-adhesion",
            parameters: r#""f_max": 2e-5, "k_c": 40.0"#,
            force: 2e-5,
            work: 2e-5 * 2e-5 / 80.0,
            range: 5e-7,
        },
        Attraction {
            law: "capillary-bridge",
            parameters: r#""gamma": 0.072, "angle": 0.0, "volume": 1e-18"#,
            force: bridge,
            work: bridge * lambda * (1.0 - (-1e-6 / lambda).exp()),
            range: 1e-6,
        },
    ]
}

/// Attractions between a disk and a line.
fn in_the_plane() -> Vec<Attraction> {
    let root = RADIUS.sqrt();
    vec![
        Attraction {
            law: "van-der-waals",
            parameters: r#""hamaker": 1e-19, "z_0": 4e-10, "range": 1e-6"#,
            force: 1e-19 * root / (8.0 * 2f64.sqrt() * 4e-10f64.powf(2.5)),
            work: 1e-19 * root / (12.0 * 2f64.sqrt() * 4e-10f64.powf(1.5)),
            range: 4e-10,
        },
        Attraction {
            law: "linear-adhesion",
            parameters: r#""f_max": 2e-2, "k_c": 4e4"#,
            force: 2e-2,
            work: 2e-2 * 2e-2 / 8e4,
            range: 5e-7,
        },
    ]
}

/// A ball on a floor, or on another ball that is fixed, under an upward force.
fn scene<S: Space>(
    contact: &str,
    attraction: &Attraction,
    on_a_ball: bool,
    h: f64,
    force: &str,
) -> Simulation<S> {
    let (zeros, up, axis) = if S::D == 2 {
        ("", "0.0, 1.0", "y")
    } else {
        ("0.0, ", "0.0, 0.0, 1.0", "z")
    };
    let floor = if on_a_ball {
        format!(
            r#"shapes: [Balls([([0.0, {zeros}0.0], {RADIUS:e})])], position: [0.0, {zeros}{:e}]"#,
            -RADIUS
        )
    } else {
        format!("shapes: [HalfSpace(normal: [{up}])]")
    };
    let (name, parameters) = (attraction.law, attraction.parameters);
    let text = format!(
        r#"(
    name: "pull-off", dimension: {}, time: (step: {h:e}, end: 1.0),
    materials: {{"grain": "verification_grain"}},
    detection: (alert: 1e-5, skin: 2e-5),
    solver: (tolerance: 1e-10, norm: Velocity),
    interfaces: [(name: "g", between: ("grain", "grain"), cohesion: "{name}", {contact}, cohesion: {{{parameters}}}))],
    bodies: [
        (name: "floor", material: "grain", {floor}),
        (name: "ball", material: "grain", shapes: [Balls([([0.0, {zeros}0.0], {RADIUS:e})])], position: [0.0, {zeros}{RADIUS:e}], dofs: ({axis}: {force})),
    ],
    output: (frames: 0, views: 0),
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

fn step<S: Space>(s: &mut Simulation<S>) -> StepReport {
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.solver.converged, "step {}", s.state.steps);
    let closes = s.state.energy.relative_residual();
    assert!(
        closes < 1e-9,
        "step {}: the ledger is off by {closes:e}",
        s.state.steps
    );
    // A run reports LAWS NOT MET from 2 % on.
    let differs = report.agreement.attraction;
    assert!(
        differs < 0.02,
        "step {}: attraction is off by {differs:e} of the load",
        s.state.steps
    );
    report
}

/// Increase of the gap (m).
fn opened<S: Space>(s: &Simulation<S>) -> f64 {
    s.state.bodies.position[1][S::D - 1] - RADIUS
}

/// Force at which the ball leaves. The force increases by half a per mille of the expected value
/// per step, from eight tenths of it on.
fn pull_off<S: Space>(contact: &str, attraction: &Attraction, on_a_ball: bool, h: f64) -> f64 {
    let (from, to) = (0.8 * attraction.force, 1.2 * attraction.force);
    let ramp = format!(
        "Force(Table([(0.0, 0.0), ({h:e}, 0.0), ({:e}, {from:e}), ({:e}, {to:e})]))",
        20.0 * h,
        820.0 * h
    );
    let mut s = scene::<S>(contact, attraction, on_a_ball, h, &ramp);
    for n in 0..820 {
        step(&mut s);
        // A neck opens before it breaks. Other attractions fail when they begin to open: the
        // inertia of the ball delays the opening after that, by 40 steps of 1 us for a tenth of the
        // range.
        let held = if attraction.law == "jkr" { 1.1 } else { 1e-3 };
        if opened(&s) > held * attraction.range {
            return from + (to - from) * f64::from((n - 19).max(0)) / 800.0;
        }
    }
    panic!("{} holds {to:e}", attraction.law);
}

fn compare<S: Space>(contact: &str, attractions: &[Attraction], on_a_ball: bool, steps: &[f64]) {
    for attraction in attractions {
        for h in steps {
            let force = pull_off::<S>(contact, attraction, on_a_ball, *h);
            let ratio = force / attraction.force;
            println!("{:<18} {h:.0e} {ratio:.4}", attraction.law);
            assert!(
                (ratio - 1.0).abs() < 0.01,
                "{} at {h:e}: {ratio}",
                attraction.law
            );
        }
    }
}

#[test]
fn rigid_balls_are_pulled_off_at_the_force_of_their_law() {
    for (on_a_ball, r) in [(false, RADIUS), (true, 0.5 * RADIUS)] {
        compare::<Dim3>(COULOMB, &in_space(r), on_a_ball, &[1e-4, 1e-5, 1e-6]);
    }
}

#[test]
fn rigid_disks_are_pulled_off_at_the_force_of_their_law() {
    compare::<Dim2>(COULOMB, &in_the_plane(), false, &[1e-4, 1e-5, 1e-6]);
}

#[test]
fn compliant_balls_are_pulled_off_at_the_force_of_their_law() {
    compare::<Dim3>(HERTZ, &in_space(RADIUS), false, &[1e-5, 1e-6]);
}

/// A ball that leaves at a speed has lost the work of separation when it is free, for steps of a
/// tenth of the range or ten times the range.
#[test]
fn a_ball_that_leaves_loses_the_work_of_separation() {
    fn check<S: Space>(attractions: &[Attraction]) {
        for attraction in attractions {
            for share in [0.05, 1.0, 10.0] {
                let probe = scene::<S>(COULOMB, attraction, false, 1e-6, "Free");
                let mass = probe.state.bodies.mass[1];
                // The kinetic energy is four times the work.
                let speed = (8.0 * attraction.work / mass).sqrt();
                let h = share * attraction.range / speed;
                let mut s = scene::<S>(COULOMB, attraction, false, h, "Free");
                // The ball is at rest in contact, and then thrown.
                s.step().unwrap_or_else(|e| panic!("{e}"));
                s.state.bodies.velocity[1][S::D - 1] = speed;
                while opened(&s) < 1.9e-6 {
                    s.step().unwrap_or_else(|e| panic!("{e}"));
                }
                let booked = s.state.energy.adhesion / attraction.work;
                let left = s.state.bodies.velocity[1][S::D - 1];
                let lost = 0.5 * mass * (speed * speed - left * left) / attraction.work;
                println!("{:<18} {share:>5} {lost:.4}", attraction.law);
                assert!(
                    (lost - 1.0).abs() < 0.03,
                    "{} {share}: {lost}",
                    attraction.law
                );
                assert!(
                    (booked - lost).abs() < 1e-6,
                    "{} {share}: {booked}",
                    attraction.law
                );
            }
        }
    }
    check::<Dim3>(&in_space(RADIUS));
    check::<Dim2>(&in_the_plane());
}
