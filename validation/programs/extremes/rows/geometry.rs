//! Coincident centres, and lengths from nanometres to megametres.

use super::super::bench::Cause::Refused;
use super::super::bench::{
    Expected, Group, HELD, Row, Sketch, ball, floor, go, grains, overlap, place, refused, reported,
};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;

pub const COINCIDENT: Group = Group {
    name: "coincident centres",
    criterion: "refused at the start; if they would coincide by motion within a step, they collide before: no increase of kinetic energy, no overlap",
    runs: &[(2, coincident::<Dim2>), (3, coincident::<Dim3>)],
    quick: true,
};

pub const LENGTH: Group = Group {
    name: "length",
    criterion: "a heap of balls scaled in length by L, a power of 4, and in time by sqrt(L): the same number of sweeps in each step, the same positions over L to the last bit",
    runs: &[(2, lengths::<Dim2>), (3, lengths::<Dim3>)],
    quick: true,
};

fn coincident<S: Space>() -> Vec<Row> {
    let at_once = |(words, apart, projection, expected): (&str, f64, f64, Expected)| {
        let flies = format!(
            "(at: {}, radius: 0.1, velocity: {})",
            place::<S>(apart, 0.0, 0.1),
            place::<S>(-apart / 1.5e-3, 0.0, 0.0)
        );
        let sketch = Sketch {
            gravity: 0.0,
            solver: format!(
                "tolerance: 1e-10, max_iterations: 100000, projection: {projection:?},"
            ),
            grains: grains("m0", &[ball(&place::<S>(0.0, 0.0, 0.1), 0.1), flies]),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(words.to_owned(), expected, &e),
        };
        let start = s.state.energy.kinetic;
        let ran = go(&mut s, 100);
        let (deep, gained) = (overlap(&s), ran.liveliest / start - 1.0);
        let found = format!("overlap {deep:.1e}, kinetic energy {gained:.1e} above the start");
        let met = gained <= 1e-12 && deep < 1e-3;
        ran.row(&s, (words.to_owned(), found), met, expected)
    };
    [
        (
            "from the start",
            0.0,
            0.0,
            reported(&[Refused("move them apart or make them smaller")]),
        ),
        ("by motion, within a step", 3.0, 0.0, HELD),
        ("the same, with projection", 3.0, 1e-4, HELD),
    ]
    .map(at_once)
    .into()
}

/// Iterations of each step, scaled positions, and the scene.
type Heap<S> = (Vec<u32>, Vec<[f64; 3]>, Simulation<S>);

fn lengths<S: Space>() -> Vec<Row> {
    let heap = |scale: f64| -> Result<Heap<S>, String> {
        let mut all = Vec::new();
        let layers = if S::D == 2 { 1 } else { 4 };
        for row in 0..4 {
            for layer in 0..layers {
                for k in 0..4 {
                    let shift = |k: usize| scale * (0.21 * k as f64 + 0.07 * row as f64);
                    let at = place::<S>(shift(k), shift(layer), scale * (0.1 + 0.19 * row as f64));
                    all.push(ball(&at, scale * 0.1));
                }
            }
        }
        let sketch = Sketch {
            step: 1e-3 * scale.sqrt(),
            detection: [1e-2 * scale, 2e-2 * scale],
            bodies: floor::<S>(),
            grains: grains("m0", &all),
            ..Sketch::default()
        };
        let mut s = sketch.build::<S>()?;
        let mut sweeps = Vec::new();
        for _ in 0..200 {
            let report = s.step().map_err(|e| e.to_string())?;
            sweeps.push(report.solver.iterations);
        }
        let places = s.state.bodies.position.iter();
        let places = places.map(|x| x.padded().map(|x| x / scale)).collect();
        Ok((sweeps, places, s))
    };
    let one = heap(1.0);
    let row = |scale: f64| {
        let value = format!("balls of {:.1e} m", 0.1 * scale);
        let (a, mut b) = match (&one, heap(scale)) {
            (Ok(a), Ok(b)) => (a, b),
            (Err(e), _) => return refused(value, HELD, e),
            (_, Err(e)) => return refused(value, HELD, &e),
        };
        let same = a.0 == b.0;
        let pairs = a.1.as_flattened().iter().zip(b.1.as_flattened());
        let apart = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        let ran = go(&mut b.2, 1);
        let found = format!("the same sweeps: {same}; places {apart:.1e} apart");
        ran.row(&b.2, (value, found), same && apart == 0.0, HELD)
    };
    [-13, -5, 12].map(|k| row(4f64.powi(k))).into()
}
