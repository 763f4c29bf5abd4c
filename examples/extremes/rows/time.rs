//! Steps from tiny to senseless, functions of time that jump, and a million steps.

use crate::bench::{FLOOR, Group, Row, Sketch, go, overlap, refused, watch};
use fretwork::geometry::space::Plane;

pub const STEP: Group = Group {
    name: "step",
    criterion: "20 falling disks, 200 steps: energy never above the start, the ledger closes to 1e-9, overlap below 1e-3 of the radius",
    run: steps,
    quick: true,
};

pub const JUMP: Group = Group {
    name: "jump in time",
    criterion: "the ledger closes to 1e-9 where the motion or force of a lid jumps, and the lid has gone its way to 1e-9 (velocities: half of the step that jumps)",
    run: jumps,
    quick: true,
};

pub const MANY: Group = Group {
    name: "a million steps",
    criterion: "two disks with a third on them, mu = 0.3 (they stand from 0.268 on): none moves by 1e-6 of its radius, the ledger closes to 1e-9",
    run: many,
    quick: false,
};

fn steps() -> Vec<Row> {
    let falling = |h: f64| {
        let mut grains = Vec::new();
        for k in 0..20 {
            let (row, column) = (k / 5, k % 5);
            let x = 0.15 + 0.25 * column as f64 + 0.02 * (row % 2) as f64;
            grains.push(format!(
                "(at: [{x:?}, {:?}], radius: 0.1)",
                0.1 + 0.22 * row as f64
            ));
        }
        let sketch = Sketch {
            step: h,
            bodies: format!(
                "{FLOOR} (name: \"left\", material: \"m0\", shapes: [HalfSpace(normal: [1.0, 0.0])]),
                 (name: \"right\", material: \"m0\", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [1.3, 0.0]),"
            ),
            grains: format!("List(material: \"m0\", grains: [{}])", grains.join(", ")),
            ..Sketch::default()
        };
        let value = format!("{h:.0e} s");
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let (mut most, mut deepest) = (f64::NEG_INFINITY, 0.0f64);
        let ran = watch(&mut s, 200, |s| {
            most = most.max(s.energy.kinetic + s.energy.potential);
            deepest = deepest.max(overlap(s));
        });
        let residual = s.energy.relative_residual();
        let gained = most / s.energy.scale.max(f64::MIN_POSITIVE);
        Row {
            value,
            found: format!(
                "energy at most {gained:.1e}, residual {residual:.1e}, overlap {deepest:.1e}"
            ),
            verdict: ran.verdict(&s, gained < 1e-9 && residual < 1e-9 && deepest < 1e-3),
        }
    };
    [1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0]
        .map(falling)
        .into()
}

fn jumps() -> Vec<Row> {
    let lid = |(words, way, dofs): (&str, f64, &str)| {
        let sketch = Sketch {
            bodies: format!(
                "{FLOOR} (name: \"lid\", material: \"m0\", mass: 10.0, position: [0.0, 0.2], shapes: [HalfSpace(normal: [0.0, -1.0])], \
                 dofs: ({dofs})),"
            ),
            grains: r#"List(material: "m0", grains: [(at: [0.0, 0.1], radius: 0.1), (at: [0.3, 0.1], radius: 0.1)])"#.to_owned(),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), &e),
        };
        let ran = go(&mut s, 100);
        let residual = s.energy.relative_residual();
        let lid = s.bodies.position[s.bodies.driven[1].body as usize].x;
        let floor = s.bodies.position[s.bodies.driven[0].body as usize].norm();
        Row {
            value: words.to_owned(),
            found: format!(
                "residual {residual:.1e}, lid moved by {:.1e} of its way less one",
                lid / way - 1.0
            ),
            verdict: ran.verdict(
                &s,
                residual < 1e-9 && floor == 0.0 && (lid / way - 1.0).abs() < 1e-9,
            ),
        }
    };
    [
        (
            "velocity from 0 to 10 m/s at once", 0.0,
            "x: Velocity(Table([(0.0, 0.0), (0.05, 0.0), (0.05, 10.0), (1.0, 10.0)])), y: Force(Constant(-1e3))",
        ),
        (
            "velocity from 0 to 10 m/s within a step", 0.495,
            "x: Velocity(Table([(0.0, 0.0), (0.05, 0.0), (0.0500001, 10.0), (1.0, 10.0)])), y: Force(Constant(-1e3))",
        ),
        (
            "load from 1e3 to 1e9 N/m within a step", 0.00995,
            "x: Velocity(Constant(0.1)), y: Force(Table([(0.0, -1e3), (0.05, -1e3), (0.0500001, -1e9), (1.0, -1e9)]))",
        ),
        (
            "place jumps by 10 radii within a step", 1.0,
            "x: Displacement(Table([(0.0, 0.0), (0.05, 0.0), (0.0500001, 1.0), (1.0, 1.0)])), y: Force(Constant(-1e3))",
        ),
    ]
    .map(lid)
    .into()
}

fn many() -> Vec<Row> {
    let r = 0.1f64;
    let high = 3f64.sqrt() * r;
    let mut grains = Vec::new();
    for row in 0..2 {
        for k in 0..2 - row {
            grains.push(format!(
                "(at: [{:?}, {:?}], radius: 0.1)",
                r * (2 * k + row) as f64,
                r + high * row as f64
            ));
        }
    }
    let sketch = Sketch {
        // It stands from 2 - sqrt 3 = 0.268 on.
        mu: 0.3,
        bodies: FLOOR.to_owned(),
        grains: format!("List(material: \"m0\", grains: [{}])", grains.join(", ")),
        ..Sketch::default()
    };
    let value = "1,000,000 steps of 1 ms".to_owned();
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, &e)],
    };
    let start = s.bodies.position.clone();
    let ran = go(&mut s, 1_000_000);
    let moved = start
        .iter()
        .zip(&s.bodies.position)
        .map(|(a, b)| (a - b).norm());
    let moved = moved.fold(0.0, f64::max) / r;
    let residual = s.energy.relative_residual();
    vec![Row {
        value,
        found: format!("moved {moved:.1e} of the radius, residual {residual:.1e}"),
        verdict: ran.verdict(&s, moved < 1e-6 && residual < 1e-9),
    }]
}
