//! Bonds from soft to nearly rigid, and bonds that all break at once.

use crate::bench::{Group, Row, Sketch, refused, watch};
use fretwork::geometry::space::Plane;
use fretwork::step::Simulation;

pub const STIFFNESS: Group = Group {
    name: "bond stiffness",
    criterion: "a disk hangs on it: the ledger closes to 1e-9, the elongation is below 2 m g/K (theta = 1/2), at last m g/K to 1e-6 \
                (theta = 1)",
    run: stiffness,
    quick: true,
};

pub const TORN: Group = Group {
    name: "all bonds break",
    criterion: "all break in one step; the ledger closes to 1e-9; what is left moves on",
    run: torn,
    quick: true,
};

fn stiffness() -> Vec<Row> {
    let mut rows = Vec::new();
    for k in [1.0, 1e4, 1e8, 1e12, 1e16, 1e20] {
        for theta in [0.5, 1.0] {
            rows.push(hanging(k, theta));
        }
    }
    rows
}

fn hanging(k: f64, theta: f64) -> Row {
    let value = format!("{k:.0e} Pa/m, theta = {theta}");
    // Soft springs swing slowly: steps of a fiftieth of the period, and not more than 1 ms.
    let mass = 1e3 * std::f64::consts::PI * 0.01;
    let area = 0.1;
    let period = std::f64::consts::TAU * (mass / (k * area)).sqrt();
    let step = if theta < 1.0 {
        1e-3
    } else {
        (period / 10.0).max(1e-3)
    };
    let sketch = Sketch {
        theta,
        step,
        interface: r#"cohesion: "elastic-bond","#,
        parameters: format!(r#", cohesion: {{"k_n": {k:?}, "k_t": {k:?}}}"#),
        bodies: r#"(name: "ceiling", material: "m0", shapes: [HalfSpace(normal: [0.0, -1.0])]),"#
            .to_owned(),
        grains: r#"List(material: "m0", grains: [(at: [0.0, -0.1], radius: 0.1)])"#.to_owned(),
        ..Sketch::default()
    };
    let mut s = match sketch.build::<Plane>() {
        Ok(s) => s,
        Err(e) => return refused(value, &e),
    };
    let weight = mass * s.gravity.y.abs();
    let mut longest = 0.0f64;
    let ran = watch(&mut s, 1000, |s| longest = longest.max(opening(s)));
    let area = s.network.memory[0]
        .bonds
        .first()
        .map_or(f64::NAN, |b| b.area);
    let rest = weight / (k * area);
    let rounding = f64::EPSILON * s.gravity.y.abs() * step * step / rest;
    let last = opening(&s) / rest - 1.0;
    let residual = s.energy.relative_residual();
    let met = residual < 1e-9
        && if theta < 1.0 {
            longest / rest < 2.0 + 2e-6 + 4000.0 * rounding
        } else {
            last.abs() < 1e-6 + 4.0 * rounding
        };
    Row {
        value,
        found: format!(
            "longest {:.6} m g/K, last {last:.1e} off, residual {residual:.1e}",
            longest / rest
        ),
        verdict: ran.verdict(&s, met),
    }
}

/// Of the first bond (m).
fn opening(s: &Simulation<Plane>) -> f64 {
    s.network.memory[0]
        .bonds
        .first()
        .map_or(f64::NAN, |b| b.opening_n)
}

fn torn() -> Vec<Row> {
    let pulled = |speed: f64| {
        let value = format!("pulled at {speed:.0e} m/s");
        let mut grains = Vec::new();
        for row in 0..10 {
            for k in 0..10 {
                grains.push(format!(
                    "(at: [{:?}, {:?}], radius: 0.1, velocity: [{:?}, {:?}])",
                    0.1 + 0.2 * k as f64,
                    0.1 + 0.2 * row as f64,
                    speed * k as f64,
                    speed * row as f64
                ));
            }
        }
        let sketch = Sketch {
            step: 1e-6,
            gravity: 0.0,
            interface: r#"cohesion: "elastic-bond", damage: "linear-softening","#,
            parameters: r#", cohesion: {"k_n": 1e12, "k_t": 1e12}, damage: {"strength": 1e6, "energy": 10.0}"#.to_owned(),
            detection: [1e-3, 2e-2],
            grains: format!("List(material: \"m0\", grains: [{}])", grains.join(", ")),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<Plane>() {
            Ok(s) => s,
            Err(e) => return refused(value, &e),
        };
        let mut at_once = 0;
        let ran = watch(&mut s, 200, |s| {
            at_once = at_once.max(s.network.breaks.len() as u64);
        });
        let (made, broken) = (s.network.bonds_made(), s.network.bonds_broken());
        let residual = s.energy.relative_residual();
        Row {
            value,
            found: format!(
                "{broken} of {made} broke, {at_once} in one step; residual {residual:.1e}"
            ),
            verdict: ran.verdict(&s, made == 180 && at_once == made && residual < 1e-9),
        }
    };
    [1e2, 1e3].map(pulled).into()
}
