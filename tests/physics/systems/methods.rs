//! Methods that form W, or apply it to all impulses together, support systems as sweeps do.

use super::spring::Spring;
use super::{R, at, built, closes, go, sketch};
use crate::extremes::bench::{Sketch, ball, floor, grains, place};
use fretwork::contact::Contact;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::solve::local::solver::Method;

/// The system slides on the floor and pushes a spinning grain: all methods give the motion that
/// sweeps give.
fn solved_by<S: Space>(method: Method) -> Vec<S::Vector> {
    let row = [ball(&place::<S>(0.75, 0.0, R), R)];
    let mut s = built::<S>(&Sketch {
        bodies: floor::<S>(),
        grains: grains("m0", &row),
        solver: "tolerance: 1e-10, norm: Velocity, max_iterations: 100000, test_every: 1,"
            .to_owned(),
        ..sketch()
    });
    let spring = Spring::<S>::new([20.0, 30.0], 5e4, R, [at::<S>(0.0, R), at::<S>(0.5, R)]);
    s.add_system(Box::new(spring.moving(2.0, 2.0)));
    s.options.solver.method = method;
    let mut pushed = 0;
    for _ in 0..60 {
        go(&mut s, 1);
        let of_grain =
            |c: &&Contact<S>| c.bodies.iter().all(|b| *b != 0) && c.impulse != S::Vector::zero();
        pushed += s.state.network.contacts.iter().filter(of_grain).count();
    }
    assert!(pushed > 0);
    closes(&s, 1e-9);
    let bodies = 0..s.state.bodies.len();
    bodies
        .flat_map(|b| [s.state.bodies.position[b], s.state.bodies.velocity[b]])
        .collect()
}

fn agree<S: Space>() {
    let swept = solved_by::<S>(Method::Nlgs);
    for method in Method::ALL.iter().copied() {
        for (x, y) in solved_by::<S>(method).iter().zip(&swept) {
            assert!((*x - *y).norm() < 1e-8, "{}: {x:?} {y:?}", method.name());
        }
    }
}

#[test]
fn all_methods_give_the_motion_that_sweeps_give() {
    agree::<Dim2>();
    agree::<Dim3>();
}
