//! Face contacts of blocks: walls with more unknowns than degrees of freedom, and flush faces.

use super::super::bench::{G, Group, HELD, Row, Sketch, carried, floor, go, refused};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};

pub const WALL: Group = Group {
    name: "hyperstatic wall",
    criterion: "the force on the floor is the weight to 1e-6, no block moves faster than 1e-6 m/s or rotates",
    runs: &[(2, wall::<Dim2>), (3, wall::<Dim3>)],
    quick: true,
};

pub const FACES: Group = Group {
    name: "aligned faces",
    criterion: "the force on the floor is the weight to 1e-6, the overlap is below 1e-9 of the block size, no block rotates",
    runs: &[(2, faces::<Dim2>), (3, faces::<Dim3>)],
    quick: true,
};

/// A block 0.1 m high and, in 3D, 0.1 m deep.
fn block<S: Space>(x: f64, up: f64, width: f64) -> String {
    match S::D {
        2 => format!(
            "(at: [{x:?}, {up:?}], points: [(0.0, 0.0), ({width:?}, 0.0), ({width:?}, 0.1), (0.0, 0.1)])"
        ),
        _ => format!(
            "(at: [{:?}, 0.0, {:?}], size: ({width:?}, 0.1, 0.1))",
            x + 0.5 * width,
            up + 0.05
        ),
    }
}

/// Blocks on a floor for some steps.
fn standing<S: Space>(value: String, blocks: &[String], width: f64, mu: f64) -> Row {
    let kind = if S::D == 2 { "Polygons" } else { "Polyhedra" };
    let sketch = Sketch {
        mu,
        bodies: floor::<S>(),
        grains: format!("{kind}(material: \"m0\", grains: [{}])", blocks.join(", ")),
        ..Sketch::default()
    };
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return refused(value, HELD, &e),
    };
    let upright: Vec<S::Rotation> = s.state.bodies.rotation.clone();
    let ran = go(&mut s, 50);
    let each = width * 0.1f64.powi(S::D as i32 - 1);
    let bears = carried(&s, "floor") / (1e3 * each * blocks.len() as f64 * G) - 1.0;
    let fast = s.state.bodies.velocity.iter().map(VectorLike::norm);
    let fast = fast.fold(0.0, f64::max);
    // Displacement of the ends of the axes by the rotation.
    let turned = |(a, b): (&S::Rotation, &S::Rotation)| {
        let ends = (0..S::D).map(|k| {
            let mut axis = S::Vector::zero();
            axis[k] = 1.0;
            (S::rotate(a, &axis) - S::rotate(b, &axis)).norm()
        });
        ends.fold(0.0, f64::max)
    };
    let turns = upright.iter().zip(&s.state.bodies.rotation).map(turned);
    let turns = turns.fold(0.0, f64::max);
    let deep = s.state.network.contacts.iter().map(|c| -c.gap);
    let deep = deep.fold(0.0, f64::max) / 0.1;
    let met = bears.abs() < 1e-6 && fast < 1e-6 && deep < 1e-9 && turns < 1e-9;
    let found = format!(
        "floor {bears:.1e}, speed {fast:.1e} m/s, turned {turns:.1e}, overlap {deep:.1e}, {} sweeps at most",
        ran.iterations
    );
    ran.row(&s, (value, found), met, HELD)
}

/// Courses in running bond; in 3D a block has four contact points per joint.
fn wall<S: Space>() -> Vec<Row> {
    let of = |mu: f64| {
        let mut blocks = Vec::new();
        for course in 0..10 {
            let shift = if course % 2 == 0 { 0.0 } else { 0.1 };
            for k in 0..6 {
                let x = 0.2 * f64::from(k) + shift;
                blocks.push(block::<S>(x, 0.1 * f64::from(course), 0.2));
            }
        }
        standing::<S>(format!("60 blocks, mu = {mu}"), &blocks, 0.2, mu)
    };
    [0.0, 0.6, 10.0].map(of).into()
}

fn faces<S: Space>() -> Vec<Row> {
    let of = |n: u32| {
        let blocks: Vec<String> = (0..n)
            .map(|k| block::<S>(0.0, 0.1 * f64::from(k), 0.1))
            .collect();
        standing::<S>(format!("{n} equal blocks, flush"), &blocks, 0.1, 0.5)
    };
    [1, 2, 20].map(of).into()
}
