//! A shear cell of spheres that is periodic along x and y: conserved quantities, and equivalence of
//! an image and a grain.

use crate::scene;
use fretwork::geometry::space::Dim3;
use fretwork::step::Simulation;
use nalgebra::Vector3;

const CELL: [f64; 2] = [0.05, 0.042];
const STEPS: usize = 500;

/// 120 spheres at random positions between two walls with friction; the upper wall presses and
/// moves obliquely.
fn cell() -> Simulation<Dim3> {
    let text = r#"(
    name: "cell",
    dimension: 3,
    seed: 4,
    time: (step: 2e-4, end: 1.0),
    periodic: (x: 0.05, y: 0.042),
    solver: (tolerance: 1e-9, max_iterations: 100000),
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.4}))],
    bodies: [
        (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])]),
        (name: "lid", material: "glass", shapes: [HalfSpace(normal: [0.0, 0.0, -1.0])], position: [0.0, 0.0, 0.05], mass: 0.05,
         dofs: (x: Velocity(Constant(0.5)), y: Velocity(Constant(-0.3)), z: Pressure(value: Constant(-2000.0)))),
    ],
    grains: [Deposit(material: "glass", count: 120, sizes: Uniform(radius: (0.0035, 0.0045)),
        low: [0.0, 0.0, 0.0], high: [0.05, 0.042, 0.05])],
)"#;
    scene::text::<Dim3>(text)
}

fn momentum(s: &Simulation<Dim3>) -> Vector3<f64> {
    s.state
        .bodies
        .grains()
        .map(|b| s.state.bodies.velocity[b] * s.state.bodies.mass[b])
        .sum()
}

/// Contacts between grains that carry an impulse across the boundary of an axis.
fn across(s: &Simulation<Dim3>, axis: usize) -> usize {
    let place = |b: u32| s.state.bodies.position[b as usize][axis].rem_euclid(CELL[axis]);
    let far = |c: &&fretwork::contact::Contact<Dim3>| {
        (place(c.bodies[0]) - place(c.bodies[1])).abs() > 0.5 * CELL[axis]
    };
    let grain = s.state.bodies.grain_flags();
    let between = s
        .state
        .network
        .contacts
        .iter()
        .filter(|c| c.bodies.iter().all(|b| grain[*b as usize]));
    between
        .filter(|c| c.impulse.norm() > 0.0)
        .filter(far)
        .count()
}

/// The momentum that the grains gain is supplied by the walls, step by step: contacts across either
/// boundary supply nothing, since each acts on both of its grains. No mass is lost.
#[test]
fn a_cell_keeps_mass_and_momentum() {
    let mut s = cell();
    let mass: f64 = s
        .state
        .bodies
        .grains()
        .map(|b| s.state.bodies.mass[b])
        .sum();
    let mut crossing = [0, 0];
    let mut given = Vector3::zeros();
    for _ in 0..STEPS {
        let before = momentum(&s);
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.solver.converged);
        let walls: Vector3<f64> = s.state.received.iter().map(|r| r.0).sum();
        let (gain, scale) = (
            momentum(&s) - before,
            s.state.received.iter().map(|r| r.0.norm()).sum::<f64>(),
        );
        assert!(
            (gain + walls).norm() < 1e-10 * scale.max(1e-6),
            "{gain} and {walls} in step {}",
            s.state.steps
        );
        given -= walls;
        for (axis, count) in crossing.iter_mut().enumerate() {
            *count += across(&s, axis);
        }
    }
    // The lid drags the grains along in its oblique direction; the layer is loaded across both
    // boundaries.
    assert!(given.x > 0.0 && given.y < 0.0, "{given}");
    assert!(crossing.iter().all(|n| *n > 1000), "{crossing:?}");
    let after: f64 = s
        .state
        .bodies
        .grains()
        .map(|b| s.state.bodies.mass[b])
        .sum();
    assert_eq!(mass, after);
    let held = s
        .state
        .bodies
        .grains()
        .filter(|b| (0.0..0.05).contains(&s.state.bodies.position[*b].z))
        .count();
    assert_eq!(held, 120);
    assert!(s.state.energy.relative_residual() < 1e-9);
}

/// Two thirds of the grains are replaced by their images, whole periods away, which changes nothing
/// else. Round-off grows by a factor of ten in some 20 steps of collisions, from 1e-17 m.
#[test]
fn an_image_is_as_good_as_its_grain() {
    let (mut one, mut twin) = (cell(), cell());
    let shift = |b: usize| match b % 3 {
        0 => Vector3::new(2.0 * CELL[0], -3.0 * CELL[1], 0.0),
        1 => Vector3::new(-CELL[0], 0.0, 0.0),
        _ => Vector3::zeros(),
    };
    let grains: Vec<usize> = one.state.bodies.grains().collect();
    for b in &grains {
        twin.state.bodies.position[*b] += shift(*b);
    }
    for _ in 0..200 {
        one.step().unwrap_or_else(|e| panic!("{e}"));
        twin.step().unwrap_or_else(|e| panic!("{e}"));
    }
    assert_eq!(
        one.state.network.contacts.len(),
        twin.state.network.contacts.len()
    );
    assert!(one.state.network.contacts.len() > 200);
    for b in grains {
        let apart = twin.state.bodies.position[b] - shift(b) - one.state.bodies.position[b];
        assert!(apart.norm() < 1e-6 * CELL[0], "grain {b}: {apart}");
    }
}
