//! Minimal scenes: no gravity, no grains, one grain, one contact.

use super::super::bench::{G, Group, HELD, Row, Sketch, ball, floor, go, grains, place, refused};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

pub const WEIGHTLESS: Group = Group {
    name: "no gravity",
    criterion: "touching balls at rest stay at rest to the last bit; a moving ball keeps its velocity to the last bit",
    runs: &[(2, weightless::<Dim2>), (3, weightless::<Dim3>)],
    quick: true,
};

pub const FEW: Group = Group {
    name: "few bodies",
    criterion: "all numbers are finite; a free ball falls by g t^2/2 to 1e-12; a contact force is m g to 1e-9",
    runs: &[(2, few::<Dim2>), (3, few::<Dim3>)],
    quick: true,
};

fn weightless<S: Space>() -> Vec<Row> {
    let at = |x, up| ball(&place::<S>(x, 0.0, up), 0.1);
    let flies = format!(
        "(at: {}, radius: 0.1, velocity: {})",
        place::<S>(5.0, 0.0, 0.0),
        place::<S>(0.3, -0.2, 0.7)
    );
    let sketch = Sketch {
        gravity: 0.0,
        grains: grains("m0", &[at(0.0, 0.1), at(0.2, 0.1), flies]),
        ..Sketch::default()
    };
    let value = "three balls".to_owned();
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, HELD, &e)],
    };
    let (places, velocity) = (s.state.bodies.position.clone(), s.state.bodies.velocity[2]);
    let ran = go(&mut s, 1000);
    let rest = s.state.bodies.position[..2] == places[..2];
    let moves = s.state.bodies.velocity[2] == velocity;
    let found = format!("at rest: {rest}, velocity kept: {moves}");
    vec![ran.row(&s, (value, found), rest && moves, HELD)]
}

fn few<S: Space>() -> Vec<Row> {
    type Look<S> = fn(&Simulation<S>) -> (String, bool);
    let scene = |words: &str, bodies: &str, grains: &str, look: Look<S>| {
        let sketch = Sketch {
            bodies: bodies.to_owned(),
            grains: grains.to_owned(),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), HELD, &e),
        };
        let ran = go(&mut s, 100);
        let (found, met) = look(&s);
        ran.row(&s, (words.to_owned(), found), met, HELD)
    };
    let one = grains("m0", &[ball(&place::<S>(0.0, 0.0, 0.1), 0.1)]);
    let floor = floor::<S>();
    let steps: Look<S> = |s| (format!("{} steps", s.state.steps), s.state.steps == 100);
    vec![
        scene("nothing at all", "", "", steps),
        scene("a floor, no grains", &floor, "", steps),
        scene("one ball, nothing else", "", &one, |s| {
            // From rest at theta = 1/2 the fall is exact.
            let fallen = 0.1 - s.state.bodies.position[0][S::D - 1];
            let off = fallen / (0.5 * G * s.state.time * s.state.time) - 1.0;
            (format!("fall {off:.1e} off"), off.abs() < 1e-12)
        }),
        scene("one ball on a floor", &floor, &one, |s| {
            let weight = s.state.bodies.mass[0] * G * s.options.scheme.h;
            let off = s.state.network.contacts[0].impulse[S::D - 1] / weight - 1.0;
            (format!("contact {off:.1e} off"), off.abs() < 1e-9)
        }),
    ]
}
