//! Solids in 3D: polyhedra, capsules, clusters and meshes, and moments of inertia that differ by
//! axis.

use crate::scene;
use crate::stepping::until;
use fretwork::geometry::space::{Dim3, MatrixLike};
use fretwork::step::Simulation;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Acceleration of gravity (m/s^2).
const G: f64 = 9.81;

fn scene(case: &str, sets: &[String]) -> Simulation<Dim3> {
    scene::simulation(&scene::loaded(case, sets))
}

/// The greatest speed of a grain (m/s).
fn fastest(s: &Simulation<Dim3>) -> f64 {
    let speeds = s.state.bodies.velocity.iter().map(|v| v.norm());
    speeds.fold(0.0, f64::max)
}

/// Tilts the table about y (slide and topple along x) or about x.
fn tilted(degrees: f64, axis: usize) -> String {
    let a = degrees.to_radians();
    let mut g = [0.0, 0.0, -G * a.cos()];
    g[axis] = G * a.sin();
    format!("gravity={g:?}")
}

#[test]
fn a_block_at_rest_keeps_its_four_points() {
    let mut s = scene("verification/tilted_block_3d", &[tilted(10.0, 0)]);
    until(&mut s, 1.0);
    assert_eq!(s.state.network.contacts.len(), 4);
    assert!(s.state.network.contacts.iter().all(|c| c.formed_at < 1e-3));
    let turned = s.state.bodies.rotation[0].angle();
    assert!(fastest(&s) < 1e-9 && turned < 1e-9, "{turned:e}");
}

#[test]
fn a_block_slides_at_atan_mu_or_topples_at_atan_of_its_shape() {
    for (axis, b) in [(0, 0.2), (1, 0.3)] {
        for mu in [0.3, 0.9f64] {
            let set = format!("interfaces.joints.parameters.contact.mu={mu}");
            let run = |degrees: f64| {
                let mut s = scene(
                    "verification/tilted_block_3d",
                    &[tilted(degrees, axis), set.clone()],
                );
                until(&mut s, 0.4);
                s
            };
            let (slides, topples) = (mu.atan().to_degrees(), f64::atan(b / 0.4).to_degrees());
            let critical = slides.min(topples);
            let s = run(critical - 0.1);
            assert!(fastest(&s) < 1e-9, "{axis} {mu}: {:e}", fastest(&s));
            let s = run(critical + 0.5);
            let (spin, v) = (
                s.state.bodies.spin[0].norm(),
                s.state.bodies.velocity[0][axis],
            );
            if slides < topples {
                // The velocity is g (sin a - mu cos a) t.
                let a = (critical + 0.5).to_radians();
                let known = G * (a.sin() - mu * a.cos()) * 0.4;
                assert!(
                    (v - known).abs() < 1e-9 && spin < 1e-9,
                    "{v} {known} {spin:e}"
                );
            } else {
                assert!(spin > 0.01 && v > 0.0, "{spin} {v}");
                // The block rotates about its lower edge, across the tilt alone.
                assert!(
                    s.state.bodies.spin[0][axis].abs() + s.state.bodies.spin[0][2].abs() < 1e-9
                );
            }
        }
    }
}

#[test]
fn a_rod_that_falls_on_its_end_gets_the_impulse_of_its_lever() {
    let mut s = scene("verification/rod_falls_on_its_end", &[]);
    let (m, v) = (s.state.bodies.mass[0], 2.0);
    let inverse = s.state.bodies.inverse_tensor(0).entry(1, 1);
    assert!((inverse * m * (1.0 + 0.05f64.powi(2)) / 12.0 - 1.0).abs() < 1e-12);
    until(&mut s, 0.1);
    // Rotated about y by 0.4 the end at +x is low; the contact is at the one of its two lower
    // corners that lies on the lower face.
    let (sin, cos) = 0.4f64.sin_cos();
    let lever = 0.5 * cos - 0.025 * sin;
    let impulse = v / (1.0 / m + lever * lever * inverse);
    let spin = -lever * impulse * inverse;
    let (now, turning) = (s.state.bodies.velocity[0], s.state.bodies.spin[0]);
    assert!((now.z + v - impulse / m).abs() < 1e-9 * v, "{now:?}");
    assert!(
        (turning - V::new(0.0, spin, 0.0)).norm() < 1e-9 * spin.abs(),
        "{turning:?} {spin}"
    );
    // The impact dissipates half of m_eff v^2.
    let lost = 0.5 * impulse * v;
    assert!((s.state.energy.residual / lost).abs() < 1e-12);
    assert!((s.state.bodies.kinetic_energy() - (0.5 * m * v * v - lost)).abs() < 1e-9 * lost);
}

#[test]
fn a_plate_thrown_tumbles_and_keeps_energy_and_momentum() {
    let mut s = scene("verification/tumbling", &[]);
    let of = |s: &Simulation<Dim3>| {
        (
            s.state.bodies.kinetic_energy(),
            s.state.bodies.angular_momentum(0, &s.state.bodies.spin[0]),
        )
    };
    let (energy, momentum) = of(&s);
    let mut turned_over = false;
    while s.state.time < 20.0 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        turned_over |= (s.state.bodies.rotation[0] * V::y()).dot(&momentum) < 0.0;
    }
    let (e, l) = of(&s);
    assert!((e / energy - 1.0).abs() < 1e-10 && (l - momentum).norm() < 1e-10 * momentum.norm());
    // The middle axis is not stable.
    assert!(turned_over);
}

#[test]
fn solids_of_all_kinds_come_to_rest_on_a_mesh() {
    let mut s = scene("verification/solids", &[]);
    let (mut start, mut worst) = (0.0f64, 0.0f64);
    while s.state.time < 1.5 {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(
            report.solver.converged,
            "{}: {:?}",
            s.state.steps, report.solver
        );
        start = start.max(s.state.energy.kinetic);
        worst = worst.max(s.state.energy.residual.abs());
    }
    assert!(worst < 1e-9 * start, "{worst:e} of {start:e}");
    // The ball still rolls from one slope to the other.
    let rest: f64 = (1..6).map(|b| s.state.bodies.energy_of(b)).sum();
    assert!(rest < 1e-4 * start, "{:e}", s.state.bodies.kinetic_energy());
    // All bodies are above the two slopes.
    for x in &s.state.bodies.position[..6] {
        let floor = x.x.abs() * 0.36397023;
        assert!(x.z > floor && x.z < floor + 0.4, "{x:?}");
    }
    let deepest = s
        .state
        .network
        .contacts
        .iter()
        .map(|c| c.gap)
        .fold(0.0, f64::min);
    assert!(deepest > -2e-3, "{deepest:e}");
}

#[test]
fn a_free_body_turns_under_a_moment_by_its_own_axis() {
    // A moment of 0.02 N m about z acts on a free plate: I_zz = m (a^2 + b^2)/12.
    let mut s = scene("verification/turned_plate", &[]);
    let m = s.state.bodies.mass[0];
    let inertia = m * (0.3f64.powi(2) + 0.2f64.powi(2)) / 12.0;
    until(&mut s, 0.5);
    let spin = s.state.bodies.spin[0];
    let known = 0.02 * 0.5 / inertia;
    assert!(
        (spin - V::new(0.0, 0.0, known)).norm() < 1e-9 * known,
        "{spin:?} {known}"
    );
    assert!(s.state.energy.relative_residual() < 1e-12);
}

#[test]
fn a_fixed_axis_stays_fixed_on_a_slope() {
    let mut s = scene("verification/fixed_axis", &[]);
    let at = |s: &Simulation<Dim3>, name: &str| {
        let driven = s
            .state
            .bodies
            .driven
            .iter()
            .find(|d| d.name == name)
            .unwrap();
        driven.body as usize
    };
    let ball = at(&s, "s");
    until(&mut s, 0.1);
    assert!(
        s.state
            .network
            .contacts
            .iter()
            .any(|c| c.impulse.norm() > 0.0)
    );
    assert_eq!(
        (
            s.state.bodies.position[ball].y,
            s.state.bodies.velocity[ball].y
        ),
        (0.0, 0.0)
    );
}

#[test]
fn a_wall_that_was_turned_and_turns_again_strikes() {
    let mut s = scene("verification/turned_wall", &[]);
    until(&mut s, 1.0);
    // The rod lies in the plane x sin a + y cos a = 0 and reaches the ball after 0.41 s of its
    // rotation.
    let fast = s
        .state
        .bodies
        .velocity
        .iter()
        .map(|v| v.norm())
        .fold(0.0, f64::max);
    assert!(fast > 0.5, "{fast}");
}

#[test]
fn a_drive_that_gives_way_leaves_the_energy() {
    let mut s = scene("verification/driven_then_free", &[]);
    until(&mut s, 0.2);
    assert!(
        s.state.energy.kinetic > 0.1 && s.state.energy.relative_residual() < 1e-12,
        "{:?}",
        s.state.energy
    );
}
