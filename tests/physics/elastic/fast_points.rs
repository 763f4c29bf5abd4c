//! Points of a mesh that approach a surface in one step by more than the alert distance.

use super::*;
use crate::scene;

/// A block is lowered by 1 um per step with its points on a flat or wavy surface of another, to an
/// unloaded overlap of 5 um. Returns the force of its holder (N/m).
fn pressed(profile: &str, theta: f64, alert: f64) -> f64 {
    let text = format!(
        r#"(name: "blocks", dimension: 2, time: (step: 1e-3, end: 0.03, theta: {theta:?}),
        materials: {{"steel": "contact_steel"}},
        detection: (alert: {alert:e}, skin: 1e-4),
        interfaces: [(name: "contact", between: ("steel", "steel"), contact: "coulomb", parameters: (contact: {{"mu": 0.0}}))],
        solver: (method: Newton, tolerance: 1e-10, norm: Velocity),
        elastic: [
            (name: "low", material: "steel",
             mesh: Block(x: (from: -1e-3, to: 1e-3, size: 5e-5), y: (from: -5e-4, to: 0.0, size: 5e-5){profile}),
             supports: [(part: "bottom", x: Fixed, y: Fixed)], touches: Surface("top")),
            (name: "up", material: "steel",
             mesh: Block(x: (from: -0.9e-3, to: 0.9e-3, size: 1e-4), y: (from: 2e-5, to: 5e-4, size: 1e-4)),
             supports: [(part: "top", x: Fixed, y: Displacement(Ramp(from: 0.0, to: -2.5e-5, start: 0.0, end: 0.024)))],
             touches: Points("bottom")),
        ])"#
    );
    let mut s = scene::text::<Dim2>(&text);
    while s.state.time < 0.03 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let holders = s
        .state
        .systems
        .get(1)
        .map(|b| b.holders())
        .unwrap_or_default();
    holders
        .iter()
        .find(|h| h.axis == 1)
        .map_or(0.0, |h| h.force)
}

/// No point passes for any alert distance, and the force is unchanged.
#[test]
fn points_do_not_pass_a_surface_in_a_step() {
    for profile in [
        "",
        r#", profile: (side: "top", shape: Wave(amplitude: 1e-6, x: 2e-4))"#,
    ] {
        let expected = pressed(profile, 1.0, 1e-5);
        assert!(expected < -1e6, "{expected}");
        for alert in [2e-6, 1e-6, 1e-7] {
            let found = pressed(profile, 1.0, alert);
            println!("{profile} alert {alert}: {found} of {expected}");
            near(expected, found, 1e-4);
        }
    }
}
