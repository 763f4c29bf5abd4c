//! Bodies that move farther in a step than their thickness: they meet what is in their way, or the
//! run reports which bodies may have passed, and when.

use super::bench::{G, Sketch, ball, floor, grains, place};
use crate::stepping::steps;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;

fn still() -> Sketch {
    Sketch {
        gravity: 0.0,
        detection: [5e-4, 3e-3],
        ..Sketch::default()
    }
}

fn built<S: Space>(sketch: &Sketch) -> Simulation<S> {
    sketch.build::<S>().unwrap_or_else(|e| panic!("{e}"))
}

fn momentum<S: Space>(s: &Simulation<S>) -> S::Vector {
    let bodies = s.state.bodies.grains();
    bodies.fold(S::Vector::zero(), |p, b| {
        p + s.state.bodies.velocity[b] * s.state.bodies.mass[b]
    })
}

/// The only body that moves at the start.
fn moving<S: Space>(s: &Simulation<S>) -> usize {
    let moves = |b: &usize| s.state.bodies.energy_of(*b) > 0.0;
    s.state.bodies.grains().find(moves).expect("one that moves")
}

/// Checks that there is no warning: nothing was passed through, nothing was detected late.
fn silent<S: Space>(s: &Simulation<S>) {
    assert_eq!(s.state.network.step_size.warning(), None);
}

/// A blade of half the grains' thickness is driven along a row of grains by ten times its thickness
/// per step.
#[test]
fn a_driven_blade_takes_along_what_it_meets() {
    let row: Vec<String> = (0..10)
        .map(|k| ball(&format!("[{}, 0.0]", 0.05 + 0.1 * f64::from(k)), 0.01))
        .collect();
    let mut s = built::<Dim2>(&Sketch {
        bodies: "(name: \"blade\", material: \"m0\", shapes: [Polygon(points: [(-0.005,-0.1),(0.005,-0.1),(0.005,0.1),(-0.005,0.1)])], \
                 position: [-0.1, 0.0], dofs: (x: Velocity(Constant(100.0)))),"
            .to_owned(),
        grains: grains("m0", &row),
        ..still()
    });
    let blade = s.state.bodies.driven[0].body as usize;
    for _ in 0..20 {
        steps(&mut s, 1);
        let side = s.state.bodies.position[blade].x + 0.005;
        for b in s.state.bodies.grains() {
            let near = s.state.bodies.position[b].x - 0.01;
            assert!(near > side - 1e-3, "{near} {side}");
        }
    }
    silent(&s);
}

/// A capsule of 5 mm moves across its thickness by 200 mm per step, onto a row of grains at rest.
#[test]
fn a_thin_capsule_does_not_fall_through_a_row_of_grains() {
    let row: Vec<String> = (0..9)
        .map(|k| ball(&format!("[{}, 0.0]", -0.4 + 0.1 * f64::from(k)), 0.01))
        .collect();
    let mut s = built::<Dim2>(&Sketch {
        grains: format!(
            "Clusters(material: \"m0\", grains: [(at: [0.0, 0.53], shapes: [Capsule(from: (-0.5, 0.0), to: (0.5, 0.0), \
             radius: 0.005)], velocity: [0.0, -200.0])]), {}",
            grains("m0", &row)
        ),
        ..still()
    });
    let before = momentum(&s);
    let thrown = moving(&s);
    for _ in 0..20 {
        steps(&mut s, 1);
        let plate = s.state.bodies.position[thrown].y;
        for b in (0..10).filter(|b| *b != thrown) {
            let up = s.state.bodies.position[b].y;
            assert!(up + 0.015 < plate + 2e-3, "{up} {plate}");
        }
    }
    let after = momentum(&s);
    assert!((after - before).norm() < 1e-9 * before.norm());
    silent(&s);
}

/// A rod that rotates by 0.3 rad per step, so that its ends move by fifteen of its thicknesses;
/// driven, and free.
#[test]
fn a_spinning_rod_hits_the_grain_in_its_way() {
    let far = 0.4;
    let angle = 0.45f64;
    let target = ball(
        &format!("[{}, {}]", far * angle.cos(), far * angle.sin()),
        0.01,
    );
    let rod = "Capsule(from: (-0.5, 0.0), to: (0.5, 0.0), radius: 0.01)";
    let paddle = Sketch {
        bodies: format!(
            "(name: \"paddle\", material: \"m0\", shapes: [{rod}], dofs: (rz: Velocity(Constant(300.0)))),"
        ),
        grains: grains("m0", std::slice::from_ref(&target)),
        ..still()
    };
    let mut s = built::<Dim2>(&paddle);
    steps(&mut s, 3);
    let v = s.state.bodies.velocity[0];
    // The grain is pushed in the direction of the rotation, no faster than the point that touched
    // it.
    let along = -v.x * angle.sin() + v.y * angle.cos();
    assert!(along > 1.0 && along < 1.5 * 300.0 * 0.5, "{v:?}");
    silent(&s);

    let mut s = built::<Dim2>(&Sketch {
        bodies: String::new(),
        grains: format!(
            "Clusters(material: \"m0\", grains: [(at: [0.0, 0.0], shapes: [{rod}], spin: [300.0])]), {}",
            grains("m0", &[target])
        ),
        ..still()
    });
    let before = momentum(&s);
    let rod = moving(&s);
    let grain = 1 - rod;
    steps(&mut s, 3);
    assert!(s.state.bodies.velocity[grain].norm() > 1.0);
    assert!(s.state.bodies.spin[rod][0] < 299.0);
    let scale = s.state.bodies.mass[grain] * s.state.bodies.velocity[grain].norm();
    assert!((momentum(&s) - before).norm() < 1e-9 * scale);
}

/// Balls collide head on at ten radii per step: without restitution they stay together; with e,
/// v1 = (1 - e) v/2 and v2 = (1 + e) v/2.
fn head_on<S: Space>() {
    for (contact, e) in [("coulomb", 0.0), ("newton-restitution", 0.8)] {
        let expected = [50.0 * (1.0 - e), 50.0 * (1.0 + e)];
        let moving = format!(
            "(at: {}, radius: 0.01, velocity: {})",
            place::<S>(0.0, 0.0, 0.0),
            place::<S>(100.0, 0.0, 0.0)
        );
        let mut s = built::<S>(&Sketch {
            contact,
            mu: 0.0,
            grains: grains("m0", &[moving, ball(&place::<S>(0.55, 0.0, 0.0), 0.01)]),
            ..still()
        });
        let before = momentum(&s);
        steps(&mut s, 20);
        assert!((momentum(&s) - before).norm() < 1e-12 * before.norm());
        for (b, v) in expected.into_iter().enumerate() {
            assert!(
                (s.state.bodies.velocity[b][0] - v).abs() < 1e-6,
                "e = {e}: {:?}",
                s.state.bodies.velocity
            );
        }
        assert!(s.state.bodies.position[1][0] - s.state.bodies.position[0][0] > 0.0199);
        silent(&s);
    }
}

#[test]
fn fast_balls_meet_head_on() {
    head_on::<Dim2>();
    head_on::<Dim3>();
}

/// Two balls that pass beside each other keep their velocities to the last bit, even if the line of
/// their centres is nearly along the motion at the start.
#[test]
fn fast_balls_that_miss_each_other_do_not_meet() {
    for (x, aside) in [(0.1, 0.0201), (0.05, 0.03), (0.4, 0.021), (0.021, 0.0205)] {
        let moving = "(at: [0.0, 0.0, 0.0], radius: 0.01, velocity: [200.0, 0.0, 0.0])".to_owned();
        let mut s = built::<Dim3>(&Sketch {
            grains: grains("m0", &[moving, ball(&format!("[{x}, {aside}, 0.0]"), 0.01)]),
            ..still()
        });
        steps(&mut s, 5);
        assert_eq!(s.state.bodies.velocity[0].x, 200.0, "{x} {aside}");
        assert_eq!(s.state.bodies.velocity[1], nalgebra::Vector3::zeros());
        silent(&s);
    }
}

/// A sphere is thrown at ten radii per step at a plane, a height field and a wall thinner than the
/// sphere.
#[test]
fn a_fast_sphere_stays_in_front_of_a_wall() {
    let flat = "HeightField(points: (3, 3), spacing: (1.0, 1.0), heights: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])";
    let plate = "Box(size: (2.0, 2.0, 0.01))";
    let thrown = "(at: [0.9, 0.9, 0.73], radius: 0.01, velocity: [13.0, 7.0, -100.0])".to_owned();
    for (shape, at, top) in [
        ("HalfSpace(normal: [0.0, 0.0, 1.0])", "[0.0, 0.0, 0.0]", 0.0),
        (flat, "[0.0, 0.0, 0.0]", 0.0),
        (plate, "[1.0, 1.0, 0.0]", 0.005),
    ] {
        let sketch = Sketch {
            bodies: format!(
                "(name: \"wall\", material: \"m0\", shapes: [{shape}], position: {at}),"
            ),
            grains: grains("m0", std::slice::from_ref(&thrown)),
            ..still()
        };
        let mut s = match sketch.build::<Dim3>() {
            Ok(s) => s,
            Err(e) => panic!("{e}"),
        };
        steps(&mut s, 20);
        let z = s.state.bodies.position[0].z;
        assert!((z - top - 0.01).abs() < 1e-6, "{shape}: {z}");
        silent(&s);
    }
}

/// A bond is made only within the alert distance, and nothing pulls at a distance, however fast two
/// grains approach.
#[test]
fn speed_makes_no_bonds() {
    let moving = "(at: [0.0, 0.0], radius: 0.01, velocity: [30.0, 0.0])".to_owned();
    let mut s = built::<Dim2>(&Sketch {
        interface: "cohesion: \"elastic-bond\",",
        parameters: ", cohesion: {\"k_n\": 1e9, \"k_t\": 1e9}".to_owned(),
        grains: grains("m0", &[moving, ball("[0.045, 0.0]", 0.01)]),
        ..still()
    });
    let before = momentum(&s);
    steps(&mut s, 3);
    assert!(s.state.network.step_size.foreseen > 0);
    assert_eq!(s.state.network.bonds_made(), 0);
    assert!((s.state.bodies.velocity[1].x - 15.0).abs() < 1e-6);
    assert!((momentum(&s) - before).norm() < 1e-12 * before.norm());
}

/// Without fast motion no contact is made in advance, and no step is solved twice.
#[test]
fn slow_scenes_do_without() {
    let stack: Vec<String> = (0..5)
        .map(|k| {
            ball(
                &place::<Dim2>(0.0, 0.0, 0.0101 + 0.0201 * f64::from(k)),
                0.01,
            )
        })
        .collect();
    let mut s = built::<Dim2>(&Sketch {
        gravity: G,
        step: 1e-4,
        bodies: floor::<Dim2>(),
        grains: grains("m0", &stack),
        ..still()
    });
    steps(&mut s, 500);
    let step_size = &s.state.network.step_size;
    assert_eq!((step_size.foreseen, step_size.repeated_solves), (0, 0));
    silent(&s);
}

/// A plane that starts to turn under a ball that moves by 0.4 of the alert distance a step.
#[test]
fn a_surface_that_starts_to_turn_holds_a_slow_ball() {
    let thrown = "(at: [0.0, 0.02], radius: 0.01, velocity: [0.0, -0.2])".to_owned();
    let mut s = built::<Dim2>(&Sketch {
        bodies: "(name: \"floor\", material: \"m0\", shapes: [HalfSpace(normal: [0.0, 1.0])], \
                 dofs: (rz: Velocity(Ramp(from: 0.0, to: 0.5, start: 0.01, end: 0.09)))),"
            .to_owned(),
        grains: grains("m0", &[thrown]),
        ..still()
    });
    let floor = s.state.bodies.driven[0].body as usize;
    for _ in 0..150 {
        steps(&mut s, 1);
        let normal = Dim2::rotate(&s.state.bodies.rotation[floor], &nalgebra::Vector2::y());
        let height = normal.dot(&s.state.bodies.position[0]);
        assert!(height > 0.01 - 5e-4, "{height}");
    }
    silent(&s);
}

/// A line that is at rest and suddenly rotates by 0.4 rad per step meets the ball above its end.
#[test]
fn a_flap_that_starts_to_turn_hits_what_is_in_its_way() {
    let mut s = built::<Dim2>(&Sketch {
        bodies: "(name: \"flap\", material: \"m0\", shapes: [Profile(points: [(-0.5, 0.0), (0.5, 0.0)], side: Below)], \
                 dofs: (rz: Velocity(Ramp(from: 0.0, to: 400.0, start: 0.01, end: 0.011)))),"
            .to_owned(),
        grains: grains("m0", &[ball("[0.38, 0.1]", 0.01)]),
        ..still()
    });
    steps(&mut s, 14);
    assert!(
        s.state.bodies.velocity[0].norm() > 1.0,
        "{:?}",
        s.state.bodies.velocity[0]
    );
}

fn passed<S: Space>(s: &Simulation<S>) {
    let reported = s.state.network.step_size.warning().unwrap_or_default();
    assert!(
        reported.contains("penetrated or passed through"),
        "{reported}"
    );
}

/// Bodies that pass through each other before the first detection, or by a jump of an imposed
/// velocity, are reported.
#[test]
fn what_is_passed_before_detection_is_reported() {
    let moving = "(at: [0.0, 0.0], radius: 0.01, velocity: [200.0, 0.0])".to_owned();
    let mut s = built::<Dim2>(&Sketch {
        grains: grains("m0", &[moving, ball("[0.05, 0.0]", 0.01)]),
        ..still()
    });
    steps(&mut s, 1);
    passed(&s);

    let kicked = |x: f64| {
        let mut s = built::<Dim2>(&Sketch {
            bodies: "(name: \"blade\", material: \"m0\", shapes: [Polygon(points: [(-0.005,-0.1),(0.005,-0.1),(0.005,0.1),(-0.005,0.1)])], \
                     dofs: (x: Velocity(Table([(0.01, 0.0), (0.010000001, 100.0)])))),"
                .to_owned(),
            grains: grains("m0", &[ball(&format!("[{x}, 0.0]"), 0.01)]),
            ..still()
        });
        steps(&mut s, 15);
        s
    };
    passed(&kicked(0.025));
    // A grain farther away than half a step is met.
    let s = kicked(0.08);
    silent(&s);
    assert!(
        s.state.bodies.velocity[0].x > 99.0,
        "{:?}",
        s.state.bodies.velocity[0]
    );
}

/// A ball at 200 m/s on to two at rest, with restitution.
fn row_of_three(e: f64, step: f64, places: [f64; 2], count: usize) -> Simulation<Dim2> {
    let moving = "(at: [0.0, 0.0], radius: 0.01, velocity: [200.0, 0.0])".to_owned();
    let at = |x: f64| ball(&format!("[{x}, 0.0]"), 0.01);
    let mut s = built::<Dim2>(&Sketch {
        mu: 0.0,
        restitution: Some(e),
        step,
        grains: grains("m0", &[moving, at(places[0]), at(places[1])]),
        ..still()
    });
    let before = momentum(&s);
    let energy = s.state.bodies.kinetic_energy();
    for _ in 0..count {
        steps(&mut s, 1);
        // No grain passes through another.
        for pair in [0, 1] {
            let apart = s.state.bodies.position[pair + 1].x - s.state.bodies.position[pair].x;
            assert!(apart > 0.015, "{apart}");
        }
    }
    assert!((momentum(&s) - before).norm() < 1e-12 * before.norm());
    assert!(s.state.bodies.kinetic_energy() < energy * (1.0 + 1e-12));
    s
}

/// Consecutive impacts: v1 = (1 - e) v/2, then v2 = (1 - e)(1 + e) v/4 and v3 = (1 + e)^2 v/4. If
/// both occur in one step the second waits for the next step, which the run reports.
#[test]
fn impacts_with_restitution_one_after_the_other() {
    for e in [1.0, 0.8] {
        let v = 200.0;
        for (places, wait) in [([0.15, 0.25], 50), ([0.19, 0.36], 50)] {
            let s = row_of_three(e, 1e-4, places, 30);
            let known = [
                0.5 * (1.0 - e) * v,
                0.25 * (1.0 - e * e) * v,
                0.25 * (1.0 + e).powi(2) * v,
            ];
            for (now, known) in s.state.bodies.velocity.iter().zip(known) {
                assert!((now.x - known).abs() < 1e-6 * v, "{e} {now:?} {known}");
            }
            silent(&s);
            let s = row_of_three(e, 1e-3, places, wait);
            let step_size = &s.state.network.step_size;
            assert!(
                step_size.held_back > 0 && step_size.passed == 0,
                "{step_size:?}"
            );
            assert!(step_size.warning().is_some());
        }
    }
}

/// Two balls are thrown at a wall one behind the other: the rear one does not rebound from the wall
/// through the front one.
#[test]
fn a_ball_does_not_bounce_through_another() {
    let thrown = |x: f64| format!("(at: [{x}, 0.0], radius: 0.01, velocity: [150.0, 0.0])");
    let mut s = built::<Dim2>(&Sketch {
        bodies: "(name: \"wall\", material: \"m0\", position: [1.0, 0.0], shapes: [HalfSpace(normal: [-1.0, 0.0])]),"
            .to_owned(),
        mu: 0.0,
        restitution: Some(0.5),
        grains: grains("m0", &[thrown(0.0), thrown(0.04)]),
        ..still()
    });
    for _ in 0..20 {
        steps(&mut s, 1);
        let [rear, front] = [0, 1].map(|b: usize| s.state.bodies.position[b].x);
        assert!(front - rear > 0.015 && front < 0.991, "{rear} {front}");
    }
    let step_size = &s.state.network.step_size;
    assert!(
        step_size.held_back > 0 && step_size.passed == 0,
        "{step_size:?}"
    );
}
