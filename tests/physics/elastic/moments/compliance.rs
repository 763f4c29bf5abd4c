//! Compliance of elements under a couple. A continuum rotates without bound under a couple at a
//! point, by M/(E L^2) in 2D and M/(E L^3) in 3D if the couple is spread over a length L (K. L.
//! Johnson, "Contact Mechanics" (1985), sections 2.2 and 3.2: displacements of a point force vary
//! with log r and 1/r, those of a couple with their derivative, and the rotation with the second
//! derivative). The rotation of a facet by a moment therefore depends on its size.

use super::*;
use fretwork::bodies::SystemStep;
use fretwork::geometry::space::Dim3;

const YOUNG: f64 = 1e9;

/// Rotation by a unit moment of a facet in the middle of the upper side of a held block of `n`
/// elements along its length, about an axis, in a static step (rad/(N m); rad/N in 2D).
fn gives_way<S: Space>(n: usize, axis: usize) -> f64 {
    let mut s = Ground::Block(Strain::Small, n, Touching::Surface("top")).under::<S>(
        &Rolling {
            grains: grain(&vec![0.5; S::D], &vec![0.0; S::D], &vec![0.0; S::Spin::N]),
            ..Rolling::default()
        },
        YOUNG,
    );
    let mut system = s.state.systems.get(0).unwrap().clone_box();
    let h = 1e3;
    system.begin_step(&SystemStep {
        time: 0.0,
        h,
        theta: 1.0,
        gravity: S::Vector::zero(),
    });
    let contactor = &system.contactors()[0];
    let middle = system.contactor_motion(contactor).position;
    // The point is inside a facet: at an edge the two adjacent facets rotate.
    let mut place = S::Vector::from_slice(&[2e-4, 1e-4, 0.0][..S::D]);
    place[S::D - 1] = 0.0;
    let (node, length) = system.turning_node(contactor, &(place - middle)).unwrap();
    let block = system.compliance(&[node])[0];
    // The ratio is that of velocities to impulses, with spins times lengths and moments over
    // lengths.
    go(&mut s, 1);
    h * h * fretwork::geometry::space::MatrixLike::entry(&block, axis, axis) / (length * length)
}

#[test]
fn a_facet_turns_the_more_the_smaller_it_is() {
    let sizes = [16, 32, 64].map(|n| (n, 0.04 / n as f64));
    let plane = sizes.map(|(n, size)| gives_way::<Dim2>(n, 0) * YOUNG * size * size);
    println!("2D: theta E L^2/M = {plane:?}");
    let sizes = [8, 16].map(|n| (n, 0.04 / n as f64));
    let space = |axis| sizes.map(|(n, size)| gives_way::<Dim3>(n, axis) * YOUNG * size.powi(3));
    let (tilt, twist) = (space(1), space(2));
    println!("3D: theta E L^3/M = {tilt:?} about an axis along it, {twist:?} about its normal");
    for pair in [&plane[..2], &plane[1..], &tilt, &twist] {
        near(pair[1], pair[0], 0.1);
    }
}

/// Change of the deceleration of a disk on soft ground, and of the bending of a bond, with the size
/// of the elements.
#[test]
fn what_the_size_of_elements_does_to_the_shipped_laws() {
    let (length, speed, young) = (0.05 * R, 0.02, 1e7);
    for n in [16, 32, 64] {
        let mut s = Ground::Block(Strain::Small, n, Touching::Surface("top")).under::<Dim2>(
            &Rolling {
                of_contact: lengths(length, 0.0),
                grains: grain(&[-5e-3, R], &[speed, 0.0], &[-speed / R]),
                ..Rolling::default()
            },
            young,
        );
        go(&mut s, 500);
        let expected = G * length / R / 1.5 * s.state.time;
        let found = speed - velocity(&s)[0];
        println!(
            "{n} elements: slowed down by {} of that on rigid ground, force {:e} N/m",
            found / expected,
            s.state.bodies.mass[ball(&s)] * G
        );
        near(expected, found, 0.05);
        closes(&s, 1e-9);
    }
}
