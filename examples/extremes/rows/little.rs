//! Next to nothing: no gravity, no grains, one grain, one contact.

use crate::bench::{FLOOR, Group, Row, Sketch, go, refused};
use fretwork::geometry::space::Plane;

pub const WEIGHTLESS: Group = Group {
    name: "no gravity",
    criterion: "disks at rest that touch stay at rest to the last bit; a disk that moves keeps its velocity to the last bit",
    run: weightless,
    quick: true,
};

pub const FEW: Group = Group {
    name: "few bodies",
    criterion: "steps, all finite; a free disk falls by g t^2/2 to 1e-12; a contact bears m g to 1e-9",
    run: few,
    quick: true,
};

fn weightless() -> Vec<Row> {
    let sketch = Sketch {
        gravity: 0.0,
        grains: r#"List(material: "m0", grains: [(at: [0.0, 0.1], radius: 0.1), (at: [0.2, 0.1], radius: 0.1),
            (at: [5.0, 0.0], radius: 0.1, velocity: [0.3, 0.7])])"#
            .to_owned(),
        ..Sketch::default()
    };
    let value = "three disks".to_owned();
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, &e)],
    };
    let places = s.bodies.position.clone();
    let ran = go(&mut s, 1000);
    let rest = s.bodies.position[..2] == places[..2];
    let moves = s.bodies.velocity[2].x == 0.3 && s.bodies.velocity[2].y == 0.7;
    vec![Row {
        value,
        found: format!("at rest: {rest}, velocity kept: {moves}"),
        verdict: ran.verdict(&s, rest && moves),
    }]
}

fn few() -> Vec<Row> {
    let scene = |words: &str,
                 bodies: &str,
                 grains: &str,
                 met: fn(&fretwork::step::Simulation<Plane>) -> (String, bool)| {
        let sketch = Sketch {
            bodies: bodies.to_owned(),
            grains: grains.to_owned(),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), &e),
        };
        let ran = go(&mut s, 100);
        let (found, met) = met(&s);
        Row {
            value: words.to_owned(),
            found,
            verdict: ran.verdict(&s, met),
        }
    };
    let one = r#"List(material: "m0", grains: [(at: [0.0, 0.1], radius: 0.1)])"#;
    vec![
        scene("nothing at all", "", "", |s| {
            (format!("{} steps", s.steps), s.steps == 100)
        }),
        scene("a floor, no grains", FLOOR, "", |s| {
            (format!("{} steps", s.steps), s.steps == 100)
        }),
        scene("one disk, nothing else", "", one, |s| {
            // From rest at theta = 1/2 the fall is exact.
            let off = (0.1 - s.bodies.position[0].y) / (0.5 * 9.81 * s.time * s.time) - 1.0;
            (format!("fall {off:.1e} off"), off.abs() < 1e-12)
        }),
        scene("one disk on a floor", FLOOR, one, |s| {
            let weight = s.bodies.mass[0] * 9.81 * s.scheme.h;
            let off = s.network.contacts[0].impulse.y / weight - 1.0;
            (format!("contact {off:.1e} off"), off.abs() < 1e-9)
        }),
    ]
}
