//! Friction without bounds, wedges, rods that jam, walls, faces that fit, and a tolerance that none can meet.

use crate::bench::{FLOOR, G, Group, Row, Sketch, carried, go, overlap, refused, watch};
use fretwork::geometry::space::Plane;
use std::f64::consts::PI;

pub const FRICTION: Group = Group {
    name: "friction",
    criterion: "a block on 30 degrees has v = max(0, sin - mu cos) g t to 1e-9 of g t",
    run: friction,
    quick: true,
};

pub const WEDGE: Group = Group {
    name: "wedge",
    criterion: "without friction each side bears m g/(2 sin a) to 1e-6; with it the sides together m g",
    run: wedge,
    quick: true,
};

pub const ROD: Group = Group {
    name: "Painleve's rod",
    criterion: "kinetic and potential energy never above that of the start, the ledger closes to 1e-9",
    run: rod,
    quick: true,
};

pub const WALL: Group = Group {
    name: "hyperstatic wall",
    criterion: "the floor bears the weight to 1e-6, and no block moves faster than 1e-6 m/s",
    run: wall,
    quick: true,
};

pub const FACES: Group = Group {
    name: "aligned faces",
    criterion: "the floor bears the weight to 1e-6, overlap below 1e-9 of the block, no block turns",
    run: faces,
    quick: true,
};

pub const TOLERANCE: Group = Group {
    name: "tolerance 0",
    criterion: "ends, with max_iterations or an error below rounding, and the floor bears the weight to 1e-12",
    run: tolerance,
    quick: true,
};

fn friction() -> Vec<Row> {
    let block = |mu: f64| {
        let angle = PI / 6.0;
        let sketch = Sketch {
            mu,
            bodies: r#"(name: "floor", material: "m0", shapes: [HalfSpace(normal: [0.0, 1.0])]),
                (name: "block", material: "m0", shapes: [Balls([([0.0, 0.0], 0.1)])], position: [0.0, 0.1],
                 dofs: (x: Free, y: Free, rz: Fixed)),"#
                .to_owned(),
            ..Sketch::default()
        };
        let value = format!("mu = {mu:e}");
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        s.gravity = [G * angle.sin(), -G * angle.cos()].into();
        let ran = go(&mut s, 100);
        let expected = (angle.sin() - mu * angle.cos()).max(0.0) * G * s.time;
        let block = s.bodies.driven[1].body as usize;
        let off = (s.bodies.velocity[block].x - expected) / (G * s.time);
        Row {
            value,
            found: format!("v {off:.1e} off, overlap {:.1e}", overlap(&s)),
            verdict: ran.verdict(&s, off.abs() < 1e-9),
        }
    };
    [0.0, 1e-9, 1.0, 10.0, 1e6].map(block).into()
}

fn wedge() -> Vec<Row> {
    let groove = |(degrees, mu): (f64, f64)| {
        // Half of the angle between the sides.
        let a = degrees.to_radians();
        let side = |name: &str, sign: f64| {
            format!(
                "(name: \"{name}\", material: \"m0\", shapes: [HalfSpace(normal: [{:?}, {:?}])]),",
                sign * a.cos(),
                a.sin()
            )
        };
        let sketch = Sketch {
            mu,
            bodies: side("left", 1.0) + &side("right", -1.0),
            grains: format!(
                "List(material: \"m0\", grains: [(at: [0.0, {:?}], radius: 0.1)])",
                0.1 / a.sin()
            ),
            ..Sketch::default()
        };
        let value = format!("half angle {degrees} degrees, mu = {mu}");
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let ran = go(&mut s, 50);
        let weight = 1e3 * PI * 0.01 * G;
        let both = (carried(&s, "left") + carried(&s, "right")) / weight - 1.0;
        let left = s.received[0].0.norm() / s.scheme.h;
        let side = left * 2.0 * a.sin() / weight - 1.0;
        let met = both.abs() < 1e-6 && (mu > 0.0 || side.abs() < 1e-6);
        Row {
            value,
            found: format!("together {both:.1e}, one side {side:.1e}"),
            verdict: ran.verdict(&s, met),
        }
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
            bodies: FLOOR.to_owned(),
            grains: format!(
                "Polygons(material: \"m0\", grains: [(at: [0.0, 0.0], points: [(0.0, 0.0), (1.0, 0.0), (1.0, 0.002), \
                 (0.0, 0.002)], angle: 1.1071487177940904, velocity: [{speed:?}, 0.0])])"
            ),
            ..Sketch::default()
        };
        let value = format!("mu = {mu}, v = {speed} m/s");
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let start = s.energy.kinetic;
        let mut most = 0.0f64;
        let ran = watch(&mut s, 1000, |s| {
            most = most.max(s.energy.kinetic + s.energy.potential);
        });
        let gained = most / start - 1.0;
        let residual = s.energy.relative_residual();
        Row {
            value,
            found: format!(
                "energy {gained:.1e} above the start, residual {residual:.1e}, {} steps not converged",
                ran.unconverged.0
            ),
            verdict: ran.verdict(&s, gained < 1e-9 && residual < 1e-9),
        }
    };
    [(2.0, -1.0), (2.0, 1.0), (100.0, -1.0), (0.5, -100.0)]
        .map(thrown)
        .into()
}

/// Blocks on a floor for some steps: what it bears over the weight, less one; and the greatest speed.
fn standing(value: String, grains: String, area: f64, mu: f64) -> Row {
    let sketch = Sketch {
        mu,
        bodies: FLOOR.to_owned(),
        grains,
        ..Sketch::default()
    };
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return refused(value, &e),
    };
    let ran = go(&mut s, 50);
    let bears = carried(&s, "floor") / (1e3 * area * G) - 1.0;
    let fast = s
        .bodies
        .velocity
        .iter()
        .map(|v| v.norm())
        .fold(0.0, f64::max);
    let turns = s
        .bodies
        .rotation
        .iter()
        .map(|a| a.abs())
        .fold(0.0, f64::max);
    let deep = s
        .network
        .contacts
        .iter()
        .map(|c| -c.gap)
        .fold(0.0, f64::max)
        / 0.1;
    let met = bears.abs() < 1e-6 && fast < 1e-6 && deep < 1e-9 && turns < 1e-9;
    Row {
        value,
        found: format!(
            "floor {bears:.1e}, speed {fast:.1e} m/s, turned {turns:.1e}, overlap {deep:.1e}, {} sweeps at most",
            ran.iterations
        ),
        verdict: ran.verdict(&s, met),
    }
}

fn wall() -> Vec<Row> {
    let of = |mu: f64| {
        let mut blocks = Vec::new();
        for course in 0..10 {
            let shift = if course % 2 == 0 { 0.0 } else { 0.1 };
            for k in 0..6 {
                blocks.push(square(0.2 * k as f64 + shift, 0.1 * course as f64, 0.2));
            }
        }
        standing(
            format!("60 blocks, mu = {mu}"),
            polygons(&blocks),
            60.0 * 0.02,
            mu,
        )
    };
    [0.0, 0.6, 10.0].map(of).into()
}

fn faces() -> Vec<Row> {
    let of = |n: usize| {
        let blocks: Vec<String> = (0..n).map(|k| square(0.0, 0.1 * k as f64, 0.1)).collect();
        standing(
            format!("{n} equal blocks, flush"),
            polygons(&blocks),
            0.01 * n as f64,
            0.5,
        )
    };
    [1, 2, 20].map(of).into()
}

fn square(x: f64, y: f64, width: f64) -> String {
    format!(
        "(at: [{x:?}, {y:?}], points: [(0.0, 0.0), ({width:?}, 0.0), ({width:?}, 0.1), (0.0, 0.1)])"
    )
}

fn polygons(all: &[String]) -> String {
    format!("Polygons(material: \"m0\", grains: [{}])", all.join(", "))
}

fn tolerance() -> Vec<Row> {
    let sketch = Sketch {
        solver: "tolerance: 0.0, max_iterations: 200,".to_owned(),
        mu: 0.5,
        bodies: FLOOR.to_owned(),
        grains: format!(
            "List(material: \"m0\", grains: [(at: [0.0, 0.1], radius: 0.1), (at: [0.2, 0.1], radius: 0.1), \
             (at: [0.1, {:?}], radius: 0.1)])",
            0.1 + 0.03f64.sqrt()
        ),
        ..Sketch::default()
    };
    let value = "two disks with a third on them".to_owned();
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return vec![refused(value, &e)],
    };
    let ran = go(&mut s, 100);
    let bears = carried(&s, "floor") / (3.0 * 1e3 * PI * 0.01 * G) - 1.0;
    vec![Row {
        value,
        found: format!(
            "floor {bears:.1e}; {} of {} steps not converged, error at most {:.1e}",
            ran.unconverged.0, ran.steps, ran.unconverged.1
        ),
        verdict: ran.verdict(&s, ran.steps == 100 && bears.abs() < 1e-12),
    }]
}
