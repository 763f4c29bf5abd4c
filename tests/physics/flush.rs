//! Convex shapes side by side are one surface, and what passes another body closer than it moves in a step passes it untouched.

use crate::extremes::bench::{G, Sketch};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::scene::build::Dimensional;
use fretwork::step::{Simulation, Steps};
use std::fmt::Write as _;

fn build<S: Dimensional>(sketch: &Sketch) -> Simulation<S> {
    sketch.build().unwrap_or_else(|e| panic!("{e}"))
}

fn go<S: Steps>(s: &mut Simulation<S>, steps: usize) {
    for _ in 0..steps {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
}

/// The velocity and spin of the only grain.
fn motion<S: Space>(s: &Simulation<S>) -> (S::Vector, S::Spin) {
    let grain = s.state.bodies.grains().next().expect("a grain");
    (s.state.bodies.velocity[grain], s.state.bodies.spin[grain])
}

/// A rectangle or a cuboid as a shape (m).
fn shape<S: Space>(from: [f64; 3], to: [f64; 3]) -> String {
    if S::D == 2 {
        let [[x, _, y], [u, _, v]] = [from, to];
        return format!(
            "Polygon(points: [({x:?}, {y:?}), ({u:?}, {y:?}), ({u:?}, {v:?}), ({x:?}, {v:?})])"
        );
    }
    let middle: Vec<f64> = (0..3).map(|k| 0.5 * (from[k] + to[k])).collect();
    let size: Vec<f64> = (0..3).map(|k| to[k] - from[k]).collect();
    format!(
        "Box(size: ({:?}, {:?}, {:?}), at: ({:?}, {:?}, {:?}))",
        size[0], size[1], size[2], middle[0], middle[1], middle[2]
    )
}

/// Ten blocks of half a metre with their tops at zero.
fn blocks<S: Space>() -> Vec<String> {
    let of = |k: u32| {
        let x = 0.5 * f64::from(k);
        shape::<S>([x, -0.7, -0.5], [x + 0.5, 0.8, 0.0])
    };
    (0..10).map(of).collect()
}

/// A grain 0.2 m high that slides on the level zero.
fn sliders<S: Space>(v: f64) -> [String; 2] {
    match S::D {
        2 => [
            format!(
                "Polygons(material: \"m0\", grains: [(at: [0.3, 0.1], points: [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)], \
                 velocity: [{v:?}, 0.0])]),"
            ),
            format!(
                "List(material: \"m0\", grains: [(at: [0.3, 0.1], radius: 0.1, velocity: [{v:?}, 0.0])]),"
            ),
        ],
        _ => [
            format!(
                "Polyhedra(material: \"m0\", grains: [(at: [0.3, 0.03, 0.1], size: (0.2, 0.2, 0.2), velocity: [{v:?}, 0.0, 0.0])]),"
            ),
            format!(
                "List(material: \"m0\", grains: [(at: [0.3, 0.03, 0.1], radius: 0.1, velocity: [{v:?}, 0.0, 0.0])]),"
            ),
        ],
    }
}

/// Over a floor for four metres: at the speed at which it started, without turning.
fn slides_on<S: Dimensional + Steps>(floor: &str, bodies: &str) {
    for v in [1.0, 0.05, 7.0] {
        for (grain, name) in sliders::<S>(v).into_iter().zip(["box", "ball"]) {
            let mut s = build::<S>(&Sketch {
                mu: 0.0,
                gravity: G,
                bodies: bodies.to_owned(),
                grains: grain,
                ..Sketch::default()
            });
            let step = s.options.scheme.h;
            // Slow ones over one joint.
            let way = if v < 0.5 { 0.3 } else { 4.0 };
            go(&mut s, (way / (v * step)) as usize);
            let (velocity, spin) = motion(&s);
            println!(
                "{}D, {name} on {floor} at {v} m/s: {velocity:?}, {spin:?}",
                S::D
            );
            assert!(
                // The solver's tolerance of 1e-10 in each of thousands of steps.
                (velocity[0] / v - 1.0).abs() < 1e-8,
                "{floor}, {name}, {v}: {velocity:?}"
            );
            assert!(
                velocity[S::D - 1].abs() < 1e-3 * v,
                "{floor}, {name}, {v}: {velocity:?}"
            );
            assert!(spin.norm() < 1e-6 * v, "{floor}, {name}, {v}: {spin:?}");
            assert_eq!(s.state.network.step_size.warning(), None);
        }
    }
}

/// All shapes as one body, or each as its own.
fn as_bodies(shapes: &[String], one: bool) -> String {
    let body = |name: usize, shapes: &str| {
        format!("(name: \"b{name}\", material: \"m0\", shapes: [{shapes}]),")
    };
    if one {
        return body(0, &shapes.join(", "));
    }
    let mut out = String::new();
    for (k, shape) in shapes.iter().enumerate() {
        let _ = write!(out, "{}", body(k, shape));
    }
    out
}

#[test]
fn a_grain_slides_over_flush_blocks_as_over_one() {
    for one in [true, false] {
        let name = if one { "a body of blocks" } else { "blocks" };
        slides_on::<Dim2>(name, &as_bodies(&blocks::<Dim2>(), one));
        slides_on::<Dim3>(name, &as_bodies(&blocks::<Dim3>(), one));
    }
}

/// What is thrown past the corner of a block, or over it, at a clearance that is less than its displacement in a step.
fn passes<S: Dimensional + Steps>(past: &str) {
    let (v, step) = (1.0, 1e-3);
    for share in [0.01, 0.1, 0.3, 0.7, 0.9] {
        for start in [0.0, 0.13, 0.5, 0.81] {
            for up in [0.0, 0.3] {
                let clear = share * v * step;
                for grain in sliders::<S>(v) {
                    // Rising, it passes the corner of the block at the clearance at least.
                    let corner = 0.5 - 0.3 - 0.1;
                    let drop = up * (corner - start * step) / v;
                    let places = ["at: [0.3, 0.1]", "at: [0.3, 0.03, 0.1]"];
                    let height = 0.1 + clear - drop;
                    let x = 0.3 + start * step;
                    let at = match S::D {
                        2 => format!("at: [{x:?}, {height:?}]"),
                        _ => format!("at: [{x:?}, 0.03, {height:?}]"),
                    };
                    let mut grain = grain.replace(places[S::D - 2], &at);
                    let level = ["velocity: [1.0, 0.0]", "velocity: [1.0, 0.0, 0.0]"][S::D - 2];
                    let climbs = level.replace("0.0]", &format!("{up:?}]"));
                    grain = grain.replace(level, &climbs);
                    let mut s = build::<S>(&Sketch {
                        step,
                        mu: 0.3,
                        gravity: 0.0,
                        bodies: past.to_owned(),
                        grains: grain.clone(),
                        ..Sketch::default()
                    });
                    let (before, _) = motion(&s);
                    go(&mut s, 800);
                    let (after, spin) = motion(&s);
                    assert!(
                        (after - before).norm() < 1e-12 && spin.norm() < 1e-12,
                        "{}D, clearance {share} v h, start {start}, {grain}: {after:?} {spin:?}",
                        S::D
                    );
                }
            }
        }
    }
}

#[test]
fn what_passes_a_corner_closer_than_it_moves_is_not_touched() {
    passes::<Dim2>(&as_bodies(
        &[shape::<Dim2>([0.5, 0.0, -0.5], [1.0, 0.0, 0.0])],
        true,
    ));
    passes::<Dim3>(&as_bodies(
        &[shape::<Dim3>([0.5, -0.5, -0.5], [1.0, 0.5, 0.0])],
        true,
    ));
}
