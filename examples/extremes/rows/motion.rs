//! Speeds up to 100 km/s.

use crate::bench::{Group, Row, Sketch, go, refused};
use fretwork::geometry::space::Plane;

pub const SPEED: Group = Group {
    name: "speed",
    criterion: "a disk thrown at a post stays in front of it, and energy is not created",
    run: speeds,
    quick: true,
};

fn speeds() -> Vec<Row> {
    let thrown = |v: f64| {
        let sketch = Sketch {
            gravity: 0.0,
            bodies: r#"(name: "post", material: "m0", position: [1.0, 0.0], shapes: [Balls([([0.0, 0.0], 0.1)])]),"#.to_owned(),
            grains: format!(
                r#"List(material: "m0", grains: [(at: [0.0, 0.0], radius: 0.1, velocity: [{v:?}, 0.0])])"#
            ),
            ..Sketch::default()
        };
        let value = format!("{v:.0e} m/s, {:.0e} radii a step", v * sketch.step / 0.1);
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let start = s.energy.kinetic;
        let steps = (2.0 / (v * s.scheme.h)).ceil().max(10.0) as u64;
        let ran = go(&mut s, steps);
        let grain =
            (0..s.bodies.len()).find(|b| s.bodies.driven.iter().all(|d| d.body as usize != *b));
        let x = grain.map_or(f64::NAN, |b| s.bodies.position[b].x);
        let gained = s.energy.kinetic / start - 1.0;
        Row {
            value,
            found: format!("at x = {x:.3} m, the post's side at 0.8; energy {gained:.1e}"),
            verdict: ran.verdict(&s, x < 0.8 + 1e-6 && gained <= 1e-12),
        }
    };
    [1.0, 1e2, 1e3, 1e4, 1e5].map(thrown).into()
}
