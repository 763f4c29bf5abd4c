//! Ratios of mass and of size, and tall columns: what stands bears its weight.

use crate::bench::{FLOOR, G, Group, Row, Sketch, carried, go, overlap, refused};
use fretwork::geometry::space::Plane;
use std::f64::consts::PI;

pub const MASS: Group = Group {
    name: "mass ratio",
    criterion: "the floor bears (m1 + m2) g and the joint m2 g to 1e-6; overlap below 1e-6 of the radius",
    run: masses,
    quick: true,
};

pub const SIZE: Group = Group {
    name: "size ratio",
    criterion: "the floor bears (m1 + m2) g and the joint m2 g to 1e-6; overlap below 1e-6 of the radius",
    run: sizes,
    quick: true,
};

pub const COLUMN: Group = Group {
    name: "column",
    criterion: "the floor bears n m g to 1e-6 and the root of n roundings of the height over g h^2 (gaps are differences of places)",
    run: columns,
    quick: false,
};

/// Two disks, one above the other.
fn pair(value: String, radii: [f64; 2], densities: [f64; 2]) -> Row {
    let [a, b] = radii;
    let sketch = Sketch {
        densities: densities.to_vec(),
        detection: [0.1 * a.min(b), 0.1 * a.min(b)],
        bodies: FLOOR.to_owned(),
        grains: format!(
            "List(material: \"m0\", grains: [(at: [0.0, {a:?}], radius: {a:?})]),
             List(material: \"m1\", grains: [(at: [0.0, {:?}], radius: {b:?})]),",
            2.0 * a + b
        ),
        ..Sketch::default()
    };
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return refused(value, &e),
    };
    let ran = go(&mut s, 100);
    let weight = |k: usize| densities[k] * PI * radii[k].powi(2) * G;
    let all = carried(&s, "floor") / (weight(0) + weight(1)) - 1.0;
    let joint = s
        .network
        .contacts
        .iter()
        .find(|c| c.bodies[1] < 2 && c.bodies[0] < 2);
    let joint = joint.map_or(f64::NAN, |c| {
        c.impulse.norm() / s.scheme.h / weight(1) - 1.0
    });
    let deep = overlap(&s);
    Row {
        value,
        found: format!(
            "floor {all:.1e}, joint {joint:.1e}, overlap {deep:.1e}, {} sweeps at most",
            ran.iterations
        ),
        verdict: ran.verdict(&s, all.abs() < 1e-6 && joint.abs() < 1e-6 && deep < 1e-6),
    }
}

fn masses() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1.0, 1e3, 1e6, 1e9, 1e12] {
        let row = |words: &str, d| pair(format!("{ratio:.0e}, {words}"), [0.1; 2], d);
        rows.push(row("heavy on light", [1.0, ratio]));
        rows.push(row("light on heavy", [ratio, 1.0]));
    }
    rows
}

fn sizes() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1e2, 1e3, 1e4] {
        let row = |words: &str, radii| pair(format!("{ratio:.0e}, {words}"), radii, [1e3; 2]);
        rows.push(row("large on small", [1.0 / ratio, 1.0]));
        rows.push(row("small on large", [1.0, 1.0 / ratio]));
    }
    rows
}

fn columns() -> Vec<Row> {
    let column = |(n, method): (usize, &str)| {
        let grains: Vec<String> = (0..n)
            .map(|k| format!("(at: [0.0, {:?}], radius: 0.1)", 0.1 + 0.2 * k as f64))
            .collect();
        let sketch = Sketch {
            solver: format!("tolerance: 1e-12, max_iterations: 100000, method: {method},"),
            bodies: FLOOR.to_owned(),
            grains: format!("List(material: \"m0\", grains: [{}])", grains.join(", ")),
            ..Sketch::default()
        };
        let value = format!("{n} disks, {method}");
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let ran = go(&mut s, 2);
        let all = carried(&s, "floor") / (n as f64 * 1e3 * PI * 0.01 * G) - 1.0;
        let places = (n as f64).sqrt() * f64::EPSILON * 0.2 * n as f64 / (G * s.scheme.h.powi(2));
        Row {
            value,
            found: format!("floor {all:.1e}, {} sweeps at most", ran.iterations),
            verdict: ran.verdict(&s, all.abs() < 1e-6 + places),
        }
    };
    [
        (10, "Auto"),
        (100, "Auto"),
        (1000, "Auto"),
        (10_000, "Auto"),
        (10_000, "Interior"),
    ]
    .map(column)
    .into()
}
