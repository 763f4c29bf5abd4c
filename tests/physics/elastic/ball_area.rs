//! A ball in contact with a deformable grain: its area counts once, however many points it touches,
//! and its mass is that of the case.

use super::*;
use crate::scene;

/// A rigid disk of 5 mm is pulled off a square of 20 mm, which is rigid if it has no elements.
fn pulled(elements: usize) -> Simulation<Dim2> {
    let deforms = match elements {
        0 => String::new(),
        n => format!("elastic_grains: [(material: \"square\", elements: {n})],"),
    };
    let text = format!(
        r#"(
    name: "pulled off", dimension: 2, time: (step: 1e-6, end: 2e-5),
    materials: {{"square": "contact_steel", "disk": "contact_polymer"}},
    detection: (alert: 1e-3, skin: 5e-4),
    solver: (tolerance: 1e-8, norm: Velocity, max_iterations: 20000),
    interfaces: [(name: "glue", between: ("square", "disk"), contact: "mohr-coulomb",
        parameters: (contact: {{"mu": 0.0, "cohesion": 1e4, "tension": 1e4, "range": 1e-3}}))],
    grains: [
        Polygons(material: "square", grains: [(at: [0.0, 0.0], points: [(-0.01, -0.01), (0.01, -0.01), (0.01, 0.01), (-0.01, 0.01)])]),
        List(material: "disk", grains: [(at: [0.0003, 0.01501], radius: 0.005, velocity: [0.0, 1.0])]),
    ],
    {deforms}
)"#
    );
    let mut s = scene::text::<Dim2>(&text);
    go(&mut s, 20);
    s
}

#[test]
fn attraction_acts_on_the_area_of_a_ball_once() {
    let rigid = pulled(0).state.energy.adhesion;
    for elements in [2, 4, 8] {
        let s = pulled(elements);
        let found = s.state.energy.adhesion;
        println!("{elements} elements: work {found:e} J/m, rigid {rigid:e}");
        near(rigid, found, 0.02);
    }
}

/// The density is equal for any mesh.
#[test]
fn a_ball_that_deforms_has_its_mass() {
    for elements in [1, 4] {
        let s = pulled(elements);
        let square = s.state.systems.get(0).unwrap().mass();
        near(7800.0 * 0.02 * 0.02, square, 1e-12);
    }
    let text = r#"(
    name: "disks", dimension: 2, time: (step: 1e-6, end: 2e-6), materials: {"disk": "contact_polymer"},
    interfaces: [(name: "touch", between: ("disk", "disk"), contact: "frictionless")],
    grains: [List(material: "disk", grains: [(at: [0.0, 0.0], radius: 0.005)])],
    elastic_grains: [(material: "disk", elements: 2)],
)"#;
    let s = scene::text::<Dim2>(text);
    let disk = std::f64::consts::PI * 0.005 * 0.005;
    near(1200.0 * disk, s.state.systems.get(0).unwrap().mass(), 1e-12);
    near(
        1200.0 * disk,
        s.state.bodies.mass[s.state.bodies.grains().next().unwrap()],
        1e-12,
    );
}
