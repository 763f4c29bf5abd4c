//! Blocks and disks on half-spaces, at rest and pressed.

use super::*;
use crate::scene;

/// A block on 20 cells of a half-space (in 3D on some 10 x 10), pressed by a force, or a disk whose
/// contact is 4 cells wide.
fn punch<S: Space>(contact: &str, round: bool) -> Simulation<S> {
    let [cells, shape, up, load] = match S::D {
        2 => [
            "x: (from: -1e-3, to: 1e-3, size: 5e-5), depth: 5e-3",
            "Polygon(points: [(-4.751e-4, 0.0), (4.751e-4, 0.0), (4.751e-4, 1e-3), (-4.751e-4, 1e-3)])",
            "y",
            "-1e5",
        ],
        _ => [
            "x: (from: -8e-4, to: 8e-4, size: 1e-4), y: (from: -8e-4, to: 8e-4, size: 1e-4)",
            "Polyhedron(points: [(-4.7e-4, -4.8e-4, 0.0), (4.9e-4, -4.8e-4, 0.0), (4.9e-4, 5.1e-4, 0.0), (-4.7e-4, 5.1e-4, 0.0), \
             (-4.7e-4, -4.8e-4, 1e-3), (4.9e-4, -4.8e-4, 1e-3), (4.9e-4, 5.1e-4, 1e-3), (-4.7e-4, 5.1e-4, 1e-3)])",
            "z",
            "-1e2",
        ],
    };
    let shape = if round {
        "Balls([([1e-5, 1e-2], 1e-2)])"
    } else {
        shape
    };
    let text = format!(
        r#"(
    name: "punch",
    dimension: {},
    time: (step: 1e-5, end: 1.0, theta: 1.0),
    detection: (alert: 1e-6, skin: 1e-5),
    solver: (tolerance: 1e-11, norm: Velocity, max_iterations: 100000),
    materials: {{"steel": "rail_steel_r260", "oxide": "magnetite"}},
    interfaces: [(name: "flat", between: ("oxide", "steel"), contact: {contact})],
    half_spaces: [(name: "ground", material: "steel", {cells}, touches: Surface)],
    bodies: [(name: "punch", material: "oxide", shapes: [{shape}], mass: 1.0, dofs: ({up}: Force(Constant({load}))))],
    output: (frames: 0, views: 0),
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

/// A flat side presses on all cells below it, not on the highest in turn: K. L. Johnson, section
/// 2.8, gives p = P/(pi sqrt(a^2 - x^2)), of which the middle half carries a third.
#[test]
fn a_flat_punch_has_a_third_of_its_load_in_the_middle() {
    let mut s = punch::<Dim2>(r#""coulomb", parameters: (contact: {"mu": 0.0})"#, false);
    go(&mut s, 200);
    let [mut all, mut middle] = [0.0; 2];
    for contact in &s.state.network.contacts {
        let force = contact.normal.dot(&contact.impulse) / s.options.scheme.h;
        all += force;
        if contact.arms[0].x.abs() < 2.5e-4 {
            middle += force;
        }
    }
    println!("load {all}, share of the middle {}", middle / all);
    near(1e5, all, 1e-6);
    near(1.0 / 3.0, middle / all, 0.03);
}

/// Bodies at rest dissipate nothing: springs with dashpots under a flat side, and under a disk.
/// With contacts on the highest cells alone, contacts changed from step to step, and damping and
/// time integration grew without bound and cancelled.
fn rests<S: Space>(round: bool) {
    let law = r#""hertz-mindlin", parameters: (contact: {"mu": 0.3, "restitution": 0.1})"#;
    let mut s = punch::<S>(law, round);
    go(&mut s, 1000);
    let before = s.state.energy;
    go(&mut s, 100);
    let after = s.state.energy;
    closes(&s, 1e-12);
    let [damping, scheme] = [after.viscous - before.viscous, after.scheme - before.scheme];
    println!(
        "damping {damping:e}, time integration {scheme:e}, stored {:e}",
        after.elastic
    );
    assert!(damping.abs() + scheme.abs() < 1e-6 * after.elastic);
}

#[test]
fn springs_at_rest_on_a_half_space_dissipate_nothing() {
    rests::<Dim2>(false);
    rests::<Dim2>(true);
    rests::<Dim3>(false);
}
