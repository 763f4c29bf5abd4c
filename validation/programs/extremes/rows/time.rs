//! Time steps from tiny to unreasonably large, functions of time that jump, and a million steps.

use super::super::bench::Cause::{Refused, Unconverged};
use super::super::bench::{
    Expected, Group, HELD, Row, Sketch, ball, floor, go, grains, held_though, overlap, place,
    refused, reported, up, watch,
};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};

pub const STEP: Group = Group {
    name: "step",
    criterion: "20 falling disks, 40 falling spheres, 200 steps: energy never above its initial value, the ledger closes to 1e-9, overlap below 1e-3 of the radius",
    runs: &[(2, steps_in_the_plane), (3, short_steps_in_space)],
    quick: true,
};

pub const LONG_STEP: Group = Group {
    runs: &[(3, long_steps_in_space)],
    quick: false,
    ..STEP
};

pub const FEW_LONG_STEPS: Group = Group {
    criterion: "the same after 20 steps",
    runs: &[(3, few_long_steps_in_space)],
    ..STEP
};

pub const JUMP: Group = Group {
    name: "jump in time",
    criterion: "the motion or force of a lid jumps: the ledger closes to 1e-9, and the displacement of the lid is exact to 1e-9",
    runs: &[(2, jumps::<Dim2>), (3, jumps::<Dim3>)],
    quick: true,
};

pub const MANY: Group = Group {
    name: "a million steps",
    criterion: "two disks with a third on top, mu = 0.3 (stable from 0.268): none moves by 1e-6 of its radius, the ledger closes to 1e-9",
    runs: &[(2, many)],
    quick: false,
};

/// Steps that resolve the fall (s).
const SHORT: [(f64, Expected); 5] = [
    (1e-12, HELD),
    (1e-9, HELD),
    (1e-6, HELD),
    (1e-4, HELD),
    (1e-3, HELD),
];

fn steps_in_the_plane() -> Vec<Row> {
    let long = [(1e-2, HELD), (0.1, HELD), (1.0, HELD)];
    falling::<Dim2>(&[&SHORT[..], &long].concat(), 200)
}

fn short_steps_in_space() -> Vec<Row> {
    falling::<Dim3>(&SHORT, 200)
}

/// Spheres become wedged, with more unknowns than degrees of freedom, and in the longest step some
/// overlap remains.
fn long_steps_in_space() -> Vec<Row> {
    let coarse = held_though(&[Unconverged]);
    let long = [
        (1e-2, coarse),
        (0.1, coarse),
        (1.0, reported(&[Unconverged])),
    ];
    falling::<Dim3>(&long, 200)
}

fn few_long_steps_in_space() -> Vec<Row> {
    let coarse = held_though(&[Unconverged]);
    falling::<Dim3>(&[(1e-2, HELD), (0.1, coarse)], 20)
}

fn falling<S: Space>(steps: &[(f64, Expected)], count: u64) -> Vec<Row> {
    let falling = |(h, expected)| {
        let mut all = Vec::new();
        let layers = if S::D == 2 { 1 } else { 2 };
        for k in 0..20 {
            let (row, column) = (k / 5, k % 5);
            let shift = 0.02 * (row % 2) as f64;
            for layer in 0..layers {
                let [x, y] = [column, layer].map(|k| 0.15 + 0.25 * k as f64 + shift);
                all.push(ball(&place::<S>(x, y, 0.1 + 0.22 * row as f64), 0.1));
            }
        }
        let wall = |name: &str, normal: [f64; 2], at: [f64; 2]| {
            format!(
                "(name: \"{name}\", material: \"m0\", shapes: [HalfSpace(normal: {})], position: {}),",
                place::<S>(normal[0], normal[1], 0.0),
                place::<S>(at[0], at[1], 0.0)
            )
        };
        let mut bodies = floor::<S>();
        bodies += &wall("left", [1.0, 0.0], [0.0, 0.0]);
        bodies += &wall("right", [-1.0, 0.0], [1.3, 0.0]);
        if S::D == 3 {
            bodies += &wall("front", [0.0, 1.0], [0.0, 0.0]);
            bodies += &wall("back", [0.0, -1.0], [0.0, 0.55]);
        }
        let sketch = Sketch {
            step: h,
            bodies,
            grains: grains("m0", &all),
            ..Sketch::default()
        };
        let value = format!("{h:.0e} s");
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, expected, &e),
        };
        let (mut most, mut deepest) = (f64::NEG_INFINITY, 0.0f64);
        let ran = watch(&mut s, count, |s| {
            most = most.max(s.state.energy.kinetic + s.state.energy.potential);
            deepest = deepest.max(overlap(s));
        });
        let residual = s.state.energy.relative_residual();
        let gained = most / s.state.energy.scale.max(f64::MIN_POSITIVE);
        let found =
            format!("energy at most {gained:.1e}, residual {residual:.1e}, overlap {deepest:.1e}");
        let met = gained < 1e-9 && residual < 1e-9 && deepest < 1e-3;
        ran.row(&s, (value, found), met, expected)
    };
    steps.iter().copied().map(falling).collect()
}

fn jumps<S: Space>() -> Vec<Row> {
    let lid = |(words, way, along, load, expected): (&str, f64, &str, &str, _)| {
        let at = |x| ball(&place::<S>(x, 0.0, 0.1), 0.1);
        let sketch = Sketch {
            bodies: format!(
                "{} (name: \"lid\", material: \"m0\", mass: 10.0, position: {}, shapes: [HalfSpace(normal: {})], \
                 dofs: (x: {along}, {}: Force({load}))),",
                floor::<S>(),
                place::<S>(0.0, 0.0, 0.2),
                place::<S>(0.0, 0.0, -1.0),
                up::<S>()
            ),
            grains: grains("m0", &[at(0.0), at(0.3)]),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), expected, &e),
        };
        let ran = go(&mut s, 100);
        let residual = s.state.energy.relative_residual();
        let lid = s.state.bodies.position[s.state.bodies.driven[1].body as usize][0];
        let floor = s.state.bodies.position[s.state.bodies.driven[0].body as usize].norm();
        let found = format!(
            "residual {residual:.1e}, relative error of the lid's displacement {:.1e}",
            lid / way - 1.0
        );
        let met = residual < 1e-9 && floor == 0.0 && (lid / way - 1.0).abs() < 1e-9;
        ran.row(&s, (words.to_owned(), found), met, expected)
    };
    let steady = "Constant(-1e3)";
    [
        (
            "velocity from 0 to 10 m/s at once",
            0.0,
            "Velocity(Table([(0.0, 0.0), (0.05, 0.0), (0.05, 10.0), (1.0, 10.0)]))",
            steady,
            reported(&[Refused(
                "the times of a table must rise; for a jump give two times that are close",
            )]),
        ),
        (
            "velocity from 0 to 10 m/s within a step",
            0.499_999_5,
            "Velocity(Table([(0.0, 0.0), (0.05, 0.0), (0.0500001, 10.0), (1.0, 10.0)]))",
            steady,
            HELD,
        ),
        (
            "load from 1e3 to 1e9 within a step",
            0.01,
            "Velocity(Constant(0.1))",
            "Table([(0.0, -1e3), (0.05, -1e3), (0.0500001, -1e9), (1.0, -1e9)])",
            HELD,
        ),
        (
            "place jumps by 10 radii within a step",
            1.0,
            "Displacement(Table([(0.0, 0.0), (0.05, 0.0), (0.0500001, 1.0), (1.0, 1.0)]))",
            steady,
            HELD,
        ),
    ]
    .map(lid)
    .into()
}

fn many() -> Vec<Row> {
    let r = 0.1f64;
    let high = 3f64.sqrt() * r;
    let at = |x: f64, up: f64| ball(&place::<Dim2>(x, 0.0, up), r);
    let sketch = Sketch {
        // The pile is stable for mu above 2 - sqrt 3 = 0.268.
        mu: 0.3,
        bodies: floor::<Dim2>(),
        grains: grains("m0", &[at(0.0, r), at(2.0 * r, r), at(r, r + high)]),
        ..Sketch::default()
    };
    let value = "1,000,000 steps of 1 ms".to_owned();
    let mut s = match sketch.build::<Dim2>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, HELD, &e)],
    };
    let start = s.state.bodies.position.clone();
    let ran = go(&mut s, 1_000_000);
    let moved = start
        .iter()
        .zip(&s.state.bodies.position)
        .map(|(a, b)| (a - b).norm());
    let moved = moved.fold(0.0, f64::max) / r;
    let residual = s.state.energy.relative_residual();
    let found = format!("moved {moved:.1e} of the radius, residual {residual:.1e}");
    let met = moved < 1e-6 && residual < 1e-9;
    vec![ran.row(&s, (value, found), met, HELD)]
}
