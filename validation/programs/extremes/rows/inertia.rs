//! Ratios of mass and of size, and tall columns.

use super::super::bench::Cause::Unconverged;
use super::super::bench::{
    Expected, G, Group, HELD, Row, Sketch, ball, carried, floor, go, grains, overlap, place,
    refused, reported, volume,
};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};

/// A tolerance bounds the square of the fraction of the work that is not transmitted:
/// docs/design.md. If a fraction of the weight is missing in each step, the small ball moves by
/// that fraction of g h^2 per step.
const BEARS: &str = "the force on the floor is (m1 + m2) g and that at the contact m2 g, to the square root of the tolerance (1e-10 if none is given); the overlap is below 1e-6 of the radius plus the displacement by that fraction of g";

pub const MASS: Group = Group {
    name: "mass ratio",
    criterion: BEARS,
    runs: &[(2, masses::<Dim2>), (3, masses::<Dim3>)],
    quick: true,
};

pub const SIZE: Group = Group {
    name: "size ratio",
    criterion: BEARS,
    runs: &[(2, sizes::<Dim2>), (3, sizes::<Dim3>)],
    quick: true,
};

pub const COLUMN: Group = Group {
    name: "column",
    criterion: "the force on the floor is n m g to 1e-6 plus sqrt(n) times the round-off of the height over g h^2 (gaps are differences of positions)",
    runs: &[(2, disks), (3, spheres)],
    quick: true,
};

pub const HIGH_COLUMN: Group = Group {
    runs: &[(2, many_disks), (3, many_spheres)],
    quick: false,
    ..COLUMN
};

/// Two balls, one above the other.
fn pair<S: Space>(
    value: String,
    radii: [f64; 2],
    densities: [f64; 2],
    tolerance: f64,
    expected: Expected,
) -> Row {
    let [a, b] = radii;
    let low = ball(&place::<S>(0.0, 0.0, a), a);
    let high = ball(&place::<S>(0.0, 0.0, 2.0 * a + b), b);
    let sketch = Sketch {
        densities: densities.to_vec(),
        detection: [0.1 * a.min(b), 0.1 * a.min(b)],
        solver: format!("tolerance: {tolerance:?}, max_iterations: 100000,"),
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
        .state
        .network
        .contacts
        .iter()
        .find(|c| c.bodies[1] < 2 && c.bodies[0] < 2);
    let joint = joint.map_or(f64::NAN, |c| {
        c.impulse.norm() / s.options.scheme.h / weight(1) - 1.0
    });
    let deep = overlap(&s);
    let found = format!(
        "floor {all:.1e}, joint {joint:.1e}, overlap {deep:.1e}, {} sweeps at most",
        ran.iterations
    );
    let share = tolerance.sqrt();
    let sinks = ran.steps as f64 * share * G * s.options.scheme.h.powi(2) / a.min(b);
    let met = all.abs() < share && joint.abs() < share && deep < 1e-6 + sinks;
    ran.row(&s, (value, found), met, expected)
}

/// From this ratio on, rounding of the light body's velocity leaves an error above 1e-10.
const FAR: f64 = 1e11;

/// Heavy on light, with the tolerance that the program proposes where rounding limits it.
fn heavy<S: Space>(words: &str, ratio: f64, radii: [f64; 2], densities: [f64; 2]) -> Vec<Row> {
    let row = |words: &str, tolerance, expected| {
        pair::<S>(words.to_owned(), radii, densities, tolerance, expected)
    };
    if ratio < FAR {
        return vec![row(words, 1e-10, HELD)];
    }
    vec![
        row(words, 1e-10, reported(&[Unconverged])),
        row(&format!("{words}, tolerance 1e-6"), 1e-6, HELD),
    ]
}

fn masses<S: Space>() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1.0, 1e3, 1e6, 1e9, 1e12] {
        let words = format!("{ratio:.0e}, heavy on light");
        rows.extend(heavy::<S>(&words, ratio, [0.1; 2], [1.0, ratio]));
        let words = format!("{ratio:.0e}, light on heavy");
        rows.push(pair::<S>(words, [0.1; 2], [ratio, 1.0], 1e-10, HELD));
    }
    rows
}

fn sizes<S: Space>() -> Vec<Row> {
    let mut rows = Vec::new();
    for ratio in [1e2, 1e3, 1e4] {
        let ratio: f64 = ratio;
        let words = format!("{ratio:.0e}, large on small");
        let masses = ratio.powi(S::D as i32);
        rows.extend(heavy::<S>(&words, masses, [1.0 / ratio, 1.0], [1e3; 2]));
        let words = format!("{ratio:.0e}, small on large");
        rows.push(pair::<S>(words, [1.0, 1.0 / ratio], [1e3; 2], 1e-10, HELD));
    }
    rows
}

fn column<S: Space>((n, method, expected): (usize, &str, Expected)) -> Row {
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
    let places =
        (n as f64).sqrt() * f64::EPSILON * 0.2 * n as f64 / (G * s.options.scheme.h.powi(2));
    let found = format!("floor {all:.1e}, {} sweeps at most", ran.iterations);
    ran.row(&s, (value, found), all.abs() < 1e-6 + places, expected)
}

fn disks() -> Vec<Row> {
    [
        (10, "Auto", HELD),
        (100, "Auto", HELD),
        (1000, "Auto", HELD),
        (1000, "Interior", HELD),
    ]
    .map(column::<Dim2>)
    .into()
}

fn many_disks() -> Vec<Row> {
    [(10_000, "Auto", HELD), (10_000, "Interior", HELD)]
        .map(column::<Dim2>)
        .into()
}

fn spheres() -> Vec<Row> {
    [
        (10, "Auto", HELD),
        (100, "Auto", HELD),
        (1000, "Auto", HELD),
    ]
    .map(column::<Dim3>)
    .into()
}

fn many_spheres() -> Vec<Row> {
    vec![column::<Dim3>((10_000, "Auto", HELD))]
}
