//! Compliant contacts whose bodies move farther in a step than contact detection looks ahead.

use crate::compliant::{HERTZ, MODULUS, built_with_alert, moduli, steps};
use fretwork::geometry::space::{Dim2, Dim3};
use fretwork::step::Simulation;
use std::f64::consts::PI;

/// An impact of a dozen steps, in each of which the balls move farther than a hundredth of their
/// radius: each step is solved once, and the alert distance changes nothing.
#[test]
fn a_fast_impact_depends_on_no_alert_distance() {
    let impact = |alert: f64| {
        let mut s: Simulation<Dim3> = built_with_alert(
            alert,
            HERTZ,
            &moduli("restitution: 1.0, mu: 0.3"),
            4e-5,
            r#"grains: [List(material: "grain", grains: [
                (at: [-0.05, 0.0, 0.0], radius: 0.05, velocity: [10.0, 0.0, 0.0]),
                (at: [0.0495, 0.01, 0.0], radius: 0.05, velocity: [-10.0, 0.0, 0.0])])]"#,
        );
        let mut deepest = 0.0f64;
        for _ in 0..12 {
            steps(&mut s, 1);
            let gaps = s.state.network.contacts.iter().map(|c| -c.gap);
            deepest = gaps.fold(deepest, f64::max);
        }
        assert!(deepest > 1e-3, "{deepest:e}");
        assert_eq!(s.state.network.step_size.repeated_solves, 0);
        assert_eq!(s.state.network.step_size.passed, 0);
        (s.state.bodies.velocity[0], s.state.bodies.spin[0])
    };
    assert_eq!(impact(1e-4), impact(1e-2));
}

/// A ball that an impact throws onto a neighbour within the same step: their spring, which did not
/// close before, pushes in this step.
#[test]
fn a_spring_that_closes_by_an_impact_of_the_step_pushes_in_it() {
    let mut s: Simulation<Dim3> = built_with_alert(
        1e-4,
        HERTZ,
        &moduli("restitution: 1.0, mu: 0.0"),
        2e-4,
        r#"grains: [List(material: "grain", grains: [
            (at: [-0.1, 0.0, 0.0], radius: 0.05, velocity: [10.0, 0.0, 0.0]),
            (at: [0.0, 0.0, 0.0], radius: 0.05),
            (at: [0.10005, 0.0, 0.0], radius: 0.05)])]"#,
    );
    steps(&mut s, 1);
    let [one, other] = [1, 2].map(|b| s.state.bodies.velocity[b].x);
    assert!(one > 1.0 && other > 0.1, "{one} {other}");
    assert!(s.state.network.step_size.repeated_solves > 0);
    assert_eq!(s.state.network.step_size.passed, 0);
}

/// A disk that slides around a drum by 0.4 of its radius a step stays within it, although the
/// normal of its spring turns in each step. The spring of a line contact, k = pi/4 E* (N/m^2; E*
/// with the moduli of both bodies), overlaps by m v^2 / (R k) on the path with the radius R = 0.45
/// m. At the end of a step, which is straight, the disk is beyond the path by at most
/// (v h)^2/(2 R), which falls with the square of the step.
#[test]
fn a_spring_turns_with_the_wall_of_a_drum() {
    for (h, count) in [(1e-4, 200), (2.5e-5, 800)] {
        let mut s: Simulation<Dim2> = built_with_alert(
            1e-3,
            HERTZ,
            &moduli("restitution: 1.0, mu: 0.0"),
            h,
            r#"bodies: [(name: "drum", material: "grain", shapes: [Drum(radius: 0.5)])],
            grains: [List(material: "grain", grains: [
                (at: [0.0, -0.4499], radius: 0.05, velocity: [200.0, 0.0])])]"#,
        );
        let (mut deepest, mut sum, energy) = (0.0f64, 0.0, s.state.bodies.energy_of(0));
        for _ in 0..count {
            steps(&mut s, 1);
            let overlap = s.state.bodies.position[0].norm() - 0.45;
            deepest = deepest.max(overlap);
            sum += overlap;
        }
        assert_eq!(s.state.network.step_size.repeated_solves, 0);
        let stiffness = 0.25 * PI * MODULUS;
        let pressed = s.state.bodies.mass[0] * 200.0f64.powi(2) / (0.45 * stiffness);
        let mean = sum / f64::from(count);
        let beyond = (200.0 * h).powi(2) / (2.0 * 0.45);
        assert!(
            (pressed..pressed + beyond).contains(&mean),
            "{h:e}: {mean:e} {pressed:e}"
        );
        assert!(deepest < 0.25 * 0.05, "{deepest:e}");
        let kept = s.state.bodies.energy_of(0) / energy;
        // The rest is in the spring (0.2 %) and lost by time integration.
        assert!(kept > 0.99 && kept < 1.0, "{kept}");
    }
}
