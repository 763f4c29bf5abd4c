//! Friction from zero to rigid, wedges, Painleve's rod, and an unattainable tolerance.

use super::super::bench::Cause::Unconverged;
use super::super::bench::{
    G, Group, HELD, Row, Sketch, ball, carried, floor, go, grains, held_though, overlap, place,
    plane, refused, volume, watch,
};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use std::f64::consts::PI;

pub const FRICTION: Group = Group {
    name: "friction",
    criterion: "a block on a slope of 30 degrees has v = max(0, sin - mu cos) g t down the slope and no transverse velocity, to 1e-9 of g t",
    runs: &[(2, friction::<Dim2>), (3, friction::<Dim3>)],
    quick: true,
};

pub const WEDGE: Group = Group {
    name: "wedge",
    criterion: "without friction the force on each side is m g/(2 sin a) to 1e-6; with friction the vertical forces of both sides sum to m g",
    runs: &[(2, wedge::<Dim2>), (3, wedge::<Dim3>)],
    quick: true,
};

pub const ROD: Group = Group {
    name: "Painleve's rod",
    criterion: "kinetic plus potential energy never exceeds its initial value, the ledger closes to 1e-9",
    runs: &[(2, rod)],
    quick: true,
};

pub const TOLERANCE: Group = Group {
    name: "tolerance 0",
    criterion: "the solver stops at max_iterations or at an error below round-off, and the force on the floor is the weight to 1e-12",
    runs: &[(2, tolerance::<Dim2>), (3, tolerance::<Dim3>)],
    quick: true,
};

fn friction<S: Space>() -> Vec<Row> {
    let block = |mu: f64| {
        let angle = PI / 6.0;
        let dofs = match S::D {
            2 => "x: Free, y: Free, rz: Fixed",
            _ => "x: Free, y: Free, z: Free, rx: Fixed, ry: Fixed, rz: Fixed",
        };
        let sketch = Sketch {
            mu,
            bodies: format!(
                r#"{} (name: "block", material: "m0", shapes: [Balls([({}, 0.1)])], position: {}, dofs: ({dofs})),"#,
                floor::<S>(),
                place::<S>(0.0, 0.0, 0.0),
                place::<S>(0.0, 0.0, 0.1)
            ),
            ..Sketch::default()
        };
        let value = format!("mu = {mu:e}");
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, HELD, &e),
        };
        // In 3D the slope goes down between the axes.
        let mut slope = S::Vector::zero();
        slope[0] = if S::D == 2 { 1.0 } else { 0.8 };
        if S::D == 3 {
            slope[1] = 0.6;
        }
        s.state.gravity = slope * (G * angle.sin());
        s.state.gravity[S::D - 1] = -G * angle.cos();
        let ran = go(&mut s, 100);
        let expected = (angle.sin() - mu * angle.cos()).max(0.0) * G * s.state.time;
        let block = s.state.bodies.driven[1].body as usize;
        let mut off = s.state.bodies.velocity[block] - slope * expected;
        off[S::D - 1] = 0.0;
        let off = off.norm() / (G * s.state.time);
        let found = format!("v {off:.1e} off, overlap {:.1e}", overlap(&s));
        ran.row(&s, (value, found), off < 1e-9, HELD)
    };
    [0.0, 1e-9, 1.0, 10.0, 1e6].map(block).into()
}

fn wedge<S: Space>() -> Vec<Row> {
    let groove = |(degrees, mu): (f64, f64)| {
        // Half of the angle between the sides.
        let a = degrees.to_radians();
        let side = |name: &str, sign: f64| plane::<S>(name, sign * a.cos(), 0.0, a.sin());
        let sketch = Sketch {
            mu,
            bodies: side("left", 1.0) + &side("right", -1.0),
            grains: grains("m0", &[ball(&place::<S>(0.0, 0.0, 0.1 / a.sin()), 0.1)]),
            ..Sketch::default()
        };
        let value = format!("half angle {degrees} degrees, mu = {mu}");
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, HELD, &e),
        };
        let ran = go(&mut s, 50);
        let weight = 1e3 * volume::<S>(0.1) * G;
        let both = (carried(&s, "left") + carried(&s, "right")) / weight - 1.0;
        let left = s.state.received[0].0.norm() / s.options.scheme.h;
        let side = left * 2.0 * a.sin() / weight - 1.0;
        let met = both.abs() < 1e-6 && (mu > 0.0 || side.abs() < 1e-6);
        let found = format!("together {both:.1e}, one side {side:.1e}");
        ran.row(&s, (value, found), met, HELD)
    };
    [
        (45.0, 0.0),
        (1.0, 0.0),
        (0.01, 0.0),
        (45.0, 0.5),
        (1.0, 0.5),
        (0.01, 0.5),
        (10.0, 10.0),
    ]
    .map(groove)
    .into()
}

fn rod() -> Vec<Row> {
    let thrown = |(mu, speed): (f64, f64)| {
        let sketch = Sketch {
            mu,
            step: 1e-4,
            bodies: floor::<Dim2>(),
            grains: format!(
                "Polygons(material: \"m0\", grains: [(at: [0.0, 0.0], points: [(0.0, 0.0), (1.0, 0.0), (1.0, 0.002), \
                 (0.0, 0.002)], angle: 1.1071487177940904, velocity: [{speed:?}, 0.0])])"
            ),
            ..Sketch::default()
        };
        let value = format!("mu = {mu}, v = {speed} m/s");
        let mut s = match sketch.build::<Dim2>() {
            Ok(s) => s,
            Err(e) => return refused(value, HELD, &e),
        };
        let start = s.state.energy.kinetic;
        let mut most = 0.0f64;
        let ran = watch(&mut s, 1000, |s| {
            most = most.max(s.state.energy.kinetic + s.state.energy.potential);
        });
        let gained = most / start - 1.0;
        let residual = s.state.energy.relative_residual();
        let found = format!(
            "energy {gained:.1e} above the start, residual {residual:.1e}, {} steps not converged",
            ran.missed.steps
        );
        let met = gained < 1e-9 && residual < 1e-9;
        ran.row(&s, (value, found), met, HELD)
    };
    [(2.0, -1.0), (2.0, 1.0), (100.0, -1.0), (0.5, -100.0)]
        .map(thrown)
        .into()
}

/// One ball on the ends of a row, or on a triangle, of balls that touch.
fn tolerance<S: Space>() -> Vec<Row> {
    let root = 3f64.sqrt();
    let (base, top) = match S::D {
        2 => (vec![[0.0, 0.0], [0.2, 0.0]], [0.1, 0.0, 0.1 + 0.1 * root]),
        _ => (
            vec![[0.0, 0.0], [0.2, 0.0], [0.1, 0.1 * root]],
            [0.1, 0.1 / root, 0.1 + 0.2 * (2.0f64 / 3.0).sqrt()],
        ),
    };
    let mut all: Vec<[f64; 3]> = base.iter().map(|[x, y]| [*x, *y, 0.1]).collect();
    all.push(top);
    let count = all.len();
    let all: Vec<String> = all
        .iter()
        .map(|[x, y, z]| ball(&place::<S>(*x, *y, *z), 0.1))
        .collect();
    let sketch = Sketch {
        solver: "tolerance: 0.0, max_iterations: 200,".to_owned(),
        mu: 0.5,
        bodies: floor::<S>(),
        grains: grains("m0", &all),
        ..Sketch::default()
    };
    let value = format!("{} balls with another on them", count - 1);
    // In 2D the error is exactly zero.
    let expected = match S::D {
        2 => HELD,
        _ => held_though(&[Unconverged]),
    };
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, expected, &e)],
    };
    let ran = go(&mut s, 100);
    let bears = carried(&s, "floor") / (count as f64 * 1e3 * volume::<S>(0.1) * G) - 1.0;
    let found = format!(
        "floor {bears:.1e}; {} of {} steps not converged, error at most {:.1e}",
        ran.missed.steps, ran.steps, ran.missed.error
    );
    let met = ran.steps == 100 && bears.abs() < 1e-12;
    vec![ran.row(&s, (value, found), met, expected)]
}
