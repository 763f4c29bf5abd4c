//! Deformable grains on all other kinds of contactors.

use super::*;

/// A body at rest on a soft one: the force between them is the weight above.
fn carries(what: &str, case: &Soft, above: usize, at_least: f64) {
    let mut s = case.build::<Dim2>();
    for _ in 0..800 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    // Systems come after rigid bodies; the upper one is a rigid body.
    let bodies = &s.state.bodies;
    let mut order: Vec<usize> = (0..bodies.len())
        .filter(|b| bodies.mass[*b] > 0.0 && bodies.driven.iter().all(|d| d.body as usize != *b))
        .collect();
    order.sort_by(|a, b| bodies.position[*b].y.total_cmp(&bodies.position[*a].y));
    let top = order[above];
    let weight = bodies.mass[top] * G;
    let force = force_on_others(&s, top, 1).abs();
    println!(
        "{what}: force {} of the weight, at {} R, deepest {:e} R, v {:e}",
        force / weight,
        bodies.position[top].y / R,
        deepest(&s) / R,
        bodies.velocity[top].norm()
    );
    assert!(
        bodies.position[top].y > at_least,
        "{what} fell to {:?}",
        bodies.position[top]
    );
    near(weight, force, 1e-2);
    assert!(deepest(&s) < 0.02 * R, "{what}");
    closes(&s, 1e-9);
}

#[test]
fn soft_grains_carry_all_other_shapes() {
    let case = |bodies: &str, grains: &str| Soft {
        step: 2e-4,
        theta: 1.0,
        damping: 1e-3,
        gravity: down(2),
        tolerance: 1e-8,
        bodies: bodies.to_owned(),
        grains: grains.to_owned(),
        ..Soft::default()
    };
    let floor = wall("floor", &[0.0, 1.0], &[0.0, 0.0], "");
    let block = square("soft", [0.0, 0.02], 0.04, 0.0, "");
    let disk = |m: &str, y: f64| disks(m, &[ball_at(&[0.0, y], &[])]);
    carries(
        "rigid disk on a soft block",
        &case(&floor, &(block.clone() + &disk("stone", 0.0501))),
        0,
        0.049,
    );
    carries(
        "soft disk on a soft block",
        &case(&floor, &(block.clone() + &disk("soft", 0.0501))),
        0,
        0.049,
    );
    let slab = |m: &str, y: f64| {
        format!(
            "Polygons(material: \"{m}\", grains: [(at: [0.0, {y:?}], points: [(-0.03, 0.0), (0.03, 0.0), (0.03, 0.005), (-0.03, 0.005)])]),"
        )
    };
    let two = disks(
        "soft",
        &[ball_at(&[-0.015, R], &[]), ball_at(&[0.015, R], &[])],
    );
    carries(
        "rigid slab on two soft disks",
        &case(&floor, &(two.clone() + &slab("stone", 0.02005))),
        0,
        0.021,
    );
    carries(
        "soft slab on two soft disks",
        &case(&floor, &(two + &slab("soft", 0.02005))),
        0,
        0.021,
    );
    carries(
        "rigid block on a soft block",
        &case(
            &floor,
            &(block.clone() + &square("stone", [0.0, 0.0501], 0.02, 0.0, "")),
        ),
        0,
        0.049,
    );
    // A corner between two others touches the middle of an edge, and the middle of an edge touches
    // a corner.
    let guides = wall("left", &[1.0, 0.0], &[-0.02, 0.0], "")
        + &wall("right", &[-1.0, 0.0], &[0.02, 0.0], "");
    let frictionless = |bodies: &str, grains: &str| Soft {
        mu: 0.0,
        ..case(bodies, grains)
    };
    let arrow = |at: f64, up: f64| {
        let mut points = [
            (0.0, 0.0),
            (0.02, 0.02),
            (0.02, 0.03),
            (-0.02, 0.03),
            (-0.02, 0.02),
        ]
        .map(|(x, y)| (x, up * y));
        if up < 0.0 {
            points.reverse();
        }
        format!(
            "Polygons(material: \"soft\", grains: [(at: [0.0, {at:?}], points: {:?})]),",
            points.to_vec()
        )
    };
    let (floor, above) = (
        floor.clone() + &guides,
        square("soft", [0.0, 0.05 + 1e-5], 0.04, 0.0, ""),
    );
    carries(
        "soft corner on a soft edge",
        &frictionless(&floor, &(block + &arrow(0.04 + 1e-5, 1.0))),
        0,
        0.055,
    );
    carries(
        "soft edge on a soft corner",
        &frictionless(&floor, &(arrow(0.03, -1.0) + &above)),
        0,
        0.048,
    );
}

/// A soft disk on bodies of finite elements, by their surface and by their points, and on a
/// half-space.
#[test]
fn soft_grains_lie_on_deformable_bodies() {
    let far = wall("far", &[0.0, 1.0], &[0.0, -1.0], "");
    for touches in ["Surface(\"top\")", "Points(\"top\")"] {
        let elastic = format!(
            "elastic: [(name: \"block\", material: \"rigid\", mesh: Block(x: (from: -0.03, to: 0.03, size: 0.0025), \
             y: (from: -0.02, to: 0.0, size: 0.005)), supports: [(part: \"bottom\", x: Fixed, y: Fixed)], touches: {touches})],"
        );
        on_a_body(touches, &far, &elastic);
    }
    let half_space = "half_spaces: [(name: \"ground\", material: \"rigid\", x: (from: -0.03, to: 0.03, size: 0.002), depth: 0.2, \
         dofs: (x: Fixed, y: Fixed), touches: Surface)],";
    on_a_body("half-space", &far, half_space);
}

fn on_a_body(what: &str, far: &str, more: &str) {
    for grain in [
        disks("soft", &[ball_at(&[0.001, R + 1e-5], &[])]),
        square("soft", [0.001, R + 1e-5], 2.0 * R, 0.0, ""),
    ] {
        let mut s = Soft {
            step: 2e-4,
            theta: 1.0,
            damping: 1e-3,
            gravity: down(2),
            tolerance: 1e-8,
            bodies: far.to_owned(),
            more: more.to_owned(),
            grains: grain,
            ..Soft::default()
        }
        .build::<Dim2>();
        for _ in 0..800 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let count = s.state.systems.len();
        let grain = (0..count)
            .find(|k| s.state.systems.get(*k).unwrap().is_grain())
            .unwrap();
        let body = s.state.systems.bodies(grain)[0] as usize;
        let weight = s.state.systems.get(grain).unwrap().mass() * G;
        let force = force_on_others(&s, body, 1).abs();
        println!(
            "{what}: force {} of the weight, at {:?}, deepest {:e} R",
            force / weight,
            place_of(&s, grain),
            deepest(&s) / R
        );
        assert!(place_of(&s, grain).y > 0.97 * R, "{what}");
        near(weight, force, 2e-2);
        closes(&s, 1e-9);
    }
}
