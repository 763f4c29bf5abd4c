//! Centres in one place, and lengths from nanometres to megametres.

use crate::bench::{FLOOR, Group, Row, Sketch, go, overlap, refused};
use fretwork::geometry::space::Plane;
use fretwork::step::Simulation;

pub const COINCIDENT: Group = Group {
    name: "coincident centres",
    criterion: "refused at the start; where motion brings them there, told, all finite, no kinetic energy gained, and taken apart by solver.projection",
    run: coincident,
    quick: true,
};

pub const LENGTH: Group = Group {
    name: "length",
    criterion: "a heap of disks scaled in length by L, a power of 4, and in time by its root: the same sweeps in each step, the same places over L to the last bit",
    run: lengths,
    quick: true,
};

fn coincident() -> Vec<Row> {
    let at_once = |(words, apart, projection): (&str, f64, f64)| {
        let sketch = Sketch {
            gravity: 0.0,
            solver: format!("tolerance: 1e-10, max_iterations: 100000, projection: {projection:?},"),
            grains: r#"List(material: "m0", grains: [(at: [0.0, 0.1], radius: 0.1), (at: [@, 0.1], radius: 0.1, velocity: [#, 0.0])])"#.replace('@', &apart.to_string()).replace('#', &(-apart / 1.5e-3).to_string()),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), &e),
        };
        let start = s.energy.kinetic;
        let ran = go(&mut s, 100);
        let deep = overlap(&s);
        Row {
            value: words.to_owned(),
            found: format!(
                "overlap {deep:.1e}, kinetic energy at most {:.1e} J/m",
                ran.liveliest
            ),
            verdict: ran.verdict(
                &s,
                ran.liveliest <= start * (1.0 + 1e-12) && projection > 0.0 && deep < 1e-3,
            ),
        }
    };
    [
        ("from the start", 0.0, 0.0),
        ("by motion, within a step", 3.0, 0.0),
        ("the same, with projection", 3.0, 1e-4),
    ]
    .map(at_once)
    .into()
}

/// Sweeps of each step, places over the scale, and the scene.
type Heap = (Vec<u32>, Vec<[f64; 2]>, Simulation<Plane>);

fn lengths() -> Vec<Row> {
    let heap = |scale: f64| -> Result<Heap, String> {
        let mut grains = Vec::new();
        for row in 0..4 {
            for k in 0..4 {
                let x = 0.21 * k as f64 + 0.07 * row as f64;
                grains.push(format!(
                    "(at: [{:?}, {:?}], radius: {:?})",
                    scale * x,
                    scale * (0.1 + 0.19 * row as f64),
                    scale * 0.1
                ));
            }
        }
        let sketch = Sketch {
            step: 1e-3 * scale.sqrt(),
            detection: [1e-2 * scale, 2e-2 * scale],
            bodies: FLOOR.to_owned(),
            grains: format!("List(material: \"m0\", grains: [{}])", grains.join(", ")),
            ..Sketch::default()
        };
        let mut s = sketch.build::<Plane>()?;
        let mut sweeps = Vec::new();
        for _ in 0..200 {
            let report = s.step().map_err(|e| e.to_string())?;
            sweeps.push(report.solver.iterations);
        }
        let places = s.bodies.position.iter().map(|x| [x.x / scale, x.y / scale]);
        Ok((sweeps, places.collect(), s))
    };
    let one = heap(1.0);
    let row = |scale: f64| {
        let value = format!("disks of {:.1e} m", 0.1 * scale);
        let (a, mut b) = match (&one, heap(scale)) {
            (Ok(a), Ok(b)) => (a, b),
            (Err(e), _) => return refused(value, e),
            (_, Err(e)) => return refused(value, &e),
        };
        let same = a.0 == b.0;
        let apart =
            a.1.iter()
                .zip(&b.1)
                .flat_map(|(x, y)| [x[0] - y[0], x[1] - y[1]]);
        let apart = apart.map(f64::abs).fold(0.0, f64::max);
        let ran = go(&mut b.2, 1);
        Row {
            value,
            found: format!("the same sweeps: {same}; places {apart:.1e} apart"),
            verdict: ran.verdict(&b.2, same && apart == 0.0),
        }
    };
    [-13, -5, 12].map(|k| row(4f64.powi(k))).into()
}
