//! Speeds up to 100 km/s.

use crate::bench::Cause::{Jumped, Late};
use crate::bench::{Group, HELD, Row, Sketch, go, place, refused, told};
use fretwork::geometry::space::{Plane, Solid};
use fretwork::scene::build::Dimensional;

pub const SPEED: Group = Group {
    name: "speed",
    criterion: "a ball thrown at a post stays in front of it, and energy is not created",
    runs: &[(2, speeds::<Plane>), (3, speeds::<Solid>)],
    quick: true,
};

fn speeds<S: Dimensional>() -> Vec<Row> {
    let thrown = |(v, expected)| {
        let v: f64 = v;
        let (start, post) = (place::<S>(0.0, 0.0, 0.0), place::<S>(1.0, 0.0, 0.0));
        let sketch = Sketch {
            gravity: 0.0,
            bodies: format!(
                r#"(name: "post", material: "m0", position: {post}, shapes: [Balls([({start}, 0.1)])]),"#
            ),
            grains: format!(
                r#"List(material: "m0", grains: [(at: {start}, radius: 0.1, velocity: {})])"#,
                place::<S>(v, 0.0, 0.0)
            ),
            ..Sketch::default()
        };
        let value = format!("{v:.0e} m/s, {:.0e} radii a step", v * sketch.step / 0.1);
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, expected, &e),
        };
        let start = s.energy.kinetic;
        let steps = (2.0 / (v * s.scheme.h)).ceil().max(10.0) as u64;
        let ran = go(&mut s, steps);
        let x = s
            .bodies
            .grains()
            .next()
            .map_or(f64::NAN, |b| s.bodies.position[b][0]);
        let gained = s.energy.kinetic / start - 1.0;
        let found = format!("at x = {x:.3} m, the post's side at 0.8; energy {gained:.1e}");
        let met = x < 0.8 + 1e-6 && gained <= 1e-12;
        ran.row(&s, (value, found), met, expected)
    };
    [
        (1.0, HELD),
        (1e2, told(&[Late])),
        (1e3, told(&[Jumped])),
        (1e4, told(&[Jumped])),
        (1e5, told(&[Jumped])),
    ]
    .map(thrown)
    .into()
}
