//! Quantities to which a scene is compared include its systems: conditions of rest do, and
//! unsupported settings are rejected.

use super::spring::Spring;
use super::{R, at, built, go, sketch};
use crate::extremes::bench::{G, Sketch, floor};
use fretwork::geometry::space::{Dim2, Dim3, Space};

/// One system is dropped upright, beside an imposed one that never rests. The phase ends when the
/// kinetic energy of the first has been below m g d for long enough, d the length over both balls.
fn phase_of_rest<S: Space>() {
    let (mass, share, held) = ([2.0, 3.0], 1e-4, 0.05);
    let mut s = built::<S>(&Sketch {
        bodies: floor::<S>(),
        more: format!(
            "phases: [(name: \"settle\", until: AtRest(share: {share:?}, held: {held:?})), (name: \"after\", until: After(0.01))],"
        ),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(mass, 5e4, R, [at::<S>(0.0, 0.11), at::<S>(0.0, 0.6)]);
    spring.damping = 200.0;
    s.add_system(Box::new(spring));
    let mut spring = Spring::<S>::new(mass, 0.0, R, [at::<S>(2.0, 90.0), at::<S>(3.0, 90.0)]);
    spring.driven = true;
    s.add_system(Box::new(spring.moving(1.0, 1.0)));
    let (mut still, mut moved) = (None, false);
    while s
        .state
        .control
        .begun()
        .first()
        .is_none_or(|b| b.end.is_none())
    {
        assert!(s.state.time < 2.0, "it does not come to rest");
        go(&mut s, 1);
        let system = s.state.systems.get(0).unwrap();
        let up = S::D - 1;
        let height = system.node_position(1)[up] - system.node_position(0)[up] + 2.0 * R;
        if system.kinetic_energy() < share * 5.0 * G * height {
            still.get_or_insert(s.state.time);
        } else {
            (still, moved) = (None, true);
        }
    }
    let ended = &s.state.control.begun()[0];
    assert_eq!(ended.ended_by, Some("rest"));
    let off = ended.end.unwrap() - still.unwrap() - held;
    assert!(moved && off.abs() < 1e-9, "{off}");
    assert!(s.state.time > 0.1);
}

#[test]
fn a_phase_of_rest_weighs_systems_by_their_mass_and_length() {
    phase_of_rest::<Dim2>();
    phase_of_rest::<Dim3>();
}

#[test]
fn projection_is_refused_where_there_are_systems() {
    let mut s = built::<Dim2>(&Sketch {
        bodies: floor::<Dim2>(),
        solver: "projection: 0.01,".to_owned(),
        ..sketch()
    });
    let spring = Spring::<Dim2>::new([2.0, 3.0], 5e4, R, [at::<Dim2>(0.0, R), at::<Dim2>(1.0, R)]);
    s.add_system(Box::new(spring));
    let error = s.step().unwrap_err().to_string();
    assert!(
        error.contains("two masses on a spring") && error.contains("set solver.projection to 0"),
        "{error}"
    );
}
