//! Calls of a system in a step: A and the contacts do not change while a step is solved.

use super::spring::Spring;
use super::{R, at, built, go, sketch};
use crate::extremes::bench::{Sketch, ball, floor, grains, place, volume};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use std::sync::Arc;

/// Both balls slide on the floor: the nodes of their two contacts are queried once, and A^-1 is
/// applied to each axis of each node, for the free velocity and for the impulses.
fn once_a_step<S: Space>() {
    let mut s = built::<S>(&Sketch {
        bodies: floor::<S>(),
        ..sketch()
    });
    let spring = Spring::<S>::new([2.0, 3.0], 5e4, R, [at::<S>(0.0, R), at::<S>(0.5, R)]);
    let calls = Arc::clone(&spring.calls);
    s.add_system(Box::new(spring.moving(1.0, 1.0)));
    for _ in 0..50 {
        go(&mut s, 1);
        assert_eq!(s.state.network.contacts.len(), 2);
        assert_eq!(calls.take(), [1, 2 * S::D + 2, 2]);
    }
}

#[test]
fn a_step_asks_once_for_nodes_and_compliance() {
    once_a_step::<Dim2>();
    once_a_step::<Dim3>();
}

/// A bond to a grain softens as it opens, and the step is solved until damage and opening agree:
/// the compliance is kept.
fn iterates<S: Space>() {
    let (m, v, omega) = (1000.0 * volume::<S>(R), 0.01, 40.0f64);
    let opens = v / omega;
    let stiffness = m * omega * omega / R;
    let strength = 0.3 * stiffness * opens;
    let velocity = place::<S>(v, 0.0, 0.0);
    let mut s = built::<S>(&Sketch {
        gravity: 0.0,
        bodies: floor::<S>(),
        grains: grains(
            "m0",
            &[ball(&place::<S>(2.0 * R, 0.0, 1.0), R)
                .replace(')', &format!(", velocity: {velocity})"))],
        ),
        interface: "cohesion: \"elastic-bond\", damage: \"linear-softening\", bonds: Start,",
        parameters: format!(
            ", cohesion: {{\"k_n\": {stiffness:?}, \"k_t\": {stiffness:?}}}, damage: {{\"strength\": {strength:?}, \
             \"energy\": {:?}}}",
            2.0 * strength * opens
        ),
        more: "coupling: Implicit(tolerance: 1e-10, max_iterations: 50),".to_owned(),
        ..sketch()
    });
    let k = m * omega * omega;
    let spring = Spring::<S>::new([m, m], k, R, [at::<S>(-1.0, 1.0), at::<S>(0.0, 1.0)]);
    let calls = Arc::clone(&spring.calls);
    s.add_system(Box::new(spring.moving(-v, 0.0)));
    let mut most = 0;
    for _ in 0..30 {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        let solves = report.coupling.iterations as usize;
        most = most.max(solves);
        assert_eq!(s.state.network.contacts.len(), 1);
        assert_eq!(calls.take(), [1, 1 + S::D + solves, 1]);
    }
    assert!(most >= 3, "{most}");
    assert!(s.state.network.mean_damage() > 0.0);
}

#[test]
fn a_step_that_is_solved_again_keeps_the_compliance() {
    iterates::<Dim2>();
    iterates::<Dim3>();
}
