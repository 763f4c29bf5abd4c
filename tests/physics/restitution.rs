//! Newton's restitution together with other terms that change the velocity required at a contact.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

/// A ball moves towards a plane that it overlaps by 0.1 mm.
fn ball<S: Space>(speed: f64, correction: f64) -> Simulation<S> {
    let (up, at, velocity) = match S::D {
        2 => ("0.0, 1.0", "0.0, 9.9e-3", format!("0.0, {:e}", -speed)),
        _ => (
            "0.0, 0.0, 1.0",
            "0.0, 0.0, 9.9e-3",
            format!("0.0, 0.0, {:e}", -speed),
        ),
    };
    let text = format!(
        r#"(
    name: "rebound", dimension: {}, time: (step: 1e-4, end: 1.0), solver: (correction: {correction:?}),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "newton-restitution", parameters: (contact: {{"mu": 0.0, "e_n": 0.5}}))],
    bodies: [(name: "plane", material: "grain", shapes: [HalfSpace(normal: [{up}])])],
    grains: [List(material: "grain", grains: [(at: [{at}], radius: 1e-2, velocity: [{velocity}])])],
    output: (frames: 0, views: 0, figures: false),
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

fn rebounds<S: Space>() {
    // The correction alone would require 0.3 m/s.
    for speed in [0.1, 0.35, 2.0] {
        for correction in [0.0, 0.3] {
            let mut s = ball::<S>(speed, correction);
            s.step().unwrap_or_else(|e| panic!("{e}"));
            let left = s.state.bodies.velocity[0][S::D - 1];
            assert!(
                (left / (0.5 * speed) - 1.0).abs() < 1e-9,
                "{}D, {speed} m/s, correction {correction}: {left} m/s",
                S::D
            );
            assert_eq!(s.state.energy.correction, 0.0);
        }
    }
}

/// A bounce leaves with e times the approach velocity, whatever correction its overlap would
/// otherwise receive.
#[test]
fn a_bounce_takes_the_place_of_the_correction() {
    rebounds::<Dim2>();
    rebounds::<Dim3>();
}
