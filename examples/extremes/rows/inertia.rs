//! Ratios of mass and of size, and tall columns: what stands bears its weight.

use crate::bench::Cause::Unconverged;
use crate::bench::{
    Expected, G, Group, HELD, Row, Sketch, ball, carried, floor, go, grains, overlap, place, refused,
    told, volume,
};
use fretwork::geometry::space::{Plane, Solid, VectorLike};
use fretwork::scene::build::Dimensional;

pub const MASS: Group = Group {
    name: "mass ratio",
    criterion: "the floor bears (m1 + m2) g and the joint m2 g to 1e-6; overlap below 1e-6 of the radius",
    runs: &[(2, masses::<Plane>), (3, masses::<Solid>)],
    quick: true,
};

pub const SIZE: Group = Group {
    name: "size ratio",
    criterion: "the floor bears (m1 + m2) g and the joint m2 g to 1e-6; overlap below 1e-6 of the radius",
    runs: &[(2, sizes::<Plane>), (3, sizes::<Solid>)],
    quick: true,
};

pub const COLUMN: Group = Group {
    name: "column",
    criterion: "the floor bears n m g to 1e-6 and the root of n roundings of the height over g h^2 (gaps are differences of places)",
    runs: &[(2, disks), (3, spheres)],
    quick: false,
};

/// Two balls, one above the other.
fn pair<S: Dimensional>(
    value: String,
    radii: [f64; 2],
    densities: [f64; 2],
    method: &str,
    expected: Expected,
) -> Row {
    let [a, b] = radii;
    let low = ball(&place::<S>(0.0, 0.0, a), a);
    let high = ball(&place::<S>(0.0, 0.0, 2.0 * a + b), b);
    let sketch = Sketch {
        densities: densities.to_vec(),
        detection: [0.1 * a.min(b), 0.1 * a.min(b)],
        solver: format!("tolerance: 1e-10, max_iterations: 100000, method: {method},"),
        bodies: floor::<S>(),
        grains: grains("m0", &[low]) + &grains("m1", &[high]),
        ..Sketch::default()
    };
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return refused(value, expected, &e),
    };
    let ran = go(&mut s, 100);
    let weight = |k: usize| densities[k] * volume::<S>(radii[k]) * G;
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
    let found = format!(
        "floor {all:.1e}, joint {joint:.1e}, overlap {deep:.1e}, {} sweeps at most",
        ran.iterations
    );
    let met = all.abs() < 1e-6 && joint.abs() < 1e-6 && deep < 1e-6;
    ran.row(&s, (value, found), met, expected)
}

fn masses<S: Dimensional>() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1.0, 1e3, 1e6, 1e9, 1e12] {
        let row = |words: &str, densities, method, expected| {
            let value = format!("{ratio:.0e}, {words}");
            pair::<S>(value, [0.1; 2], densities, method, expected)
        };
        let far = ratio > 1e11;
        let sweeps = if far { told(&[Unconverged]) } else { HELD };
        rows.push(row("heavy on light", [1.0, ratio], "Auto", sweeps));
        if far {
            rows.push(row("heavy on light, Newton", [1.0, ratio], "Newton", HELD));
            rows.push(row("heavy on light, Interior", [1.0, ratio], "Interior", HELD));
        }
        rows.push(row("light on heavy", [ratio, 1.0], "Auto", HELD));
    }
    rows
}

fn sizes<S: Dimensional>() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1e2, 1e3, 1e4] {
        let row = |words: &str, radii| {
            pair::<S>(format!("{ratio:.0e}, {words}"), radii, [1e3; 2], "Auto", HELD)
        };
        rows.push(row("large on small", [1.0 / ratio, 1.0]));
        rows.push(row("small on large", [1.0, 1.0 / ratio]));
    }
    rows
}

fn column<S: Dimensional>((n, method, expected): (usize, &str, Expected)) -> Row {
    let at = |k: usize| ball(&place::<S>(0.0, 0.0, 0.1 + 0.2 * k as f64), 0.1);
    let all: Vec<String> = (0..n).map(at).collect();
    let sketch = Sketch {
        solver: format!("tolerance: 1e-12, max_iterations: 100000, method: {method},"),
        bodies: floor::<S>(),
        grains: grains("m0", &all),
        ..Sketch::default()
    };
    let value = format!("{n} balls, {method}");
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return refused(value, expected, &e),
    };
    let ran = go(&mut s, 2);
    let all = carried(&s, "floor") / (n as f64 * 1e3 * volume::<S>(0.1) * G) - 1.0;
    let places = (n as f64).sqrt() * f64::EPSILON * 0.2 * n as f64 / (G * s.scheme.h.powi(2));
    let found = format!("floor {all:.1e}, {} sweeps at most", ran.iterations);
    ran.row(&s, (value, found), all.abs() < 1e-6 + places, expected)
}

fn disks() -> Vec<Row> {
    [
        (10, "Auto", HELD),
        (100, "Auto", HELD),
        (1000, "Auto", HELD),
        (10_000, "Auto", told(&[Unconverged])),
        (10_000, "Interior", HELD),
    ]
    .map(column::<Plane>)
    .into()
}

fn spheres() -> Vec<Row> {
    [(10, "Auto", HELD), (100, "Auto", HELD), (1000, "Auto", HELD)]
        .map(column::<Solid>)
        .into()
}
