//! Bonds from soft to nearly rigid, and bonds that all break at once.

use super::super::bench::{
    Expected, Group, HELD, Row, Sketch, ball, grains, place, plane, refused, volume, watch,
};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

pub const STIFFNESS: Group = Group {
    name: "bond stiffness",
    criterion: "a ball hangs on a bond: the ledger closes to 1e-9, the elongation is below 2 m g/K (theta = 1/2), and m g/K to 1e-6 at the end (theta = 1)",
    runs: &[(2, stiffness::<Dim2>), (3, stiffness::<Dim3>)],
    quick: true,
};

pub const TORN: Group = Group {
    name: "all bonds break",
    criterion: "all break in one step; the ledger closes to 1e-9; the separated bodies keep moving",
    runs: &[(2, torn::<Dim2>), (3, torn::<Dim3>)],
    quick: true,
};

fn stiffness<S: Space>() -> Vec<Row> {
    let mut rows = Vec::new();
    for k in [1.0, 1e4, 1e8, 1e12, 1e16, 1e20] {
        for theta in [0.5, 1.0] {
            rows.push(hanging::<S>(k, theta, HELD));
        }
    }
    rows
}

fn hanging<S: Space>(k: f64, theta: f64, expected: Expected) -> Row {
    let value = format!("{k:.0e} Pa/m, theta = {theta}");
    let mass = 1e3 * volume::<S>(0.1);
    // The bond's area determines the time step: a tenth of the period, and at least 1 ms if
    // oscillations are damped.
    let area = 0.1f64.powi(S::D as i32 - 1);
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
        bodies: plane::<S>("ceiling", 0.0, 0.0, -1.0),
        grains: grains("m0", &[ball(&place::<S>(0.0, 0.0, -0.1), 0.1)]),
        ..Sketch::default()
    };
    let mut s = match sketch.build::<S>() {
        Ok(s) => s,
        Err(e) => return refused(value, expected, &e),
    };
    let gravity = s.state.gravity[S::D - 1].abs();
    let mut longest = 0.0f64;
    let ran = watch(&mut s, 1000, |s| longest = longest.max(opening(s)));
    let bond = s.state.network.memory[0].bonds.first();
    let rest = mass * gravity / (k * bond.map_or(f64::NAN, |b| b.area));
    let rounding = f64::EPSILON * gravity * step * step / rest;
    let last = opening(&s) / rest - 1.0;
    let residual = s.state.energy.relative_residual();
    let met = residual < 1e-9
        && if theta < 1.0 {
            longest / rest < 2.0 + 2e-6 + 4000.0 * rounding
        } else {
            last.abs() < 1e-6 + 4.0 * rounding
        };
    let found = format!(
        "longest {:.6} m g/K, last {last:.1e} off, residual {residual:.1e}",
        longest / rest
    );
    ran.row(&s, (value, found), met, expected)
}

/// Opening of the first bond (m).
fn opening<S: Space>(s: &Simulation<S>) -> f64 {
    s.state.network.memory[0]
        .bonds
        .first()
        .map_or(f64::NAN, |b| b.opening_n)
}

/// A grid in which every grain is pulled from its neighbours.
fn torn<S: Space>() -> Vec<Row> {
    let (side, layers, bonds) = if S::D == 2 { (10, 1, 180) } else { (5, 5, 300) };
    let pulled = |speed: f64| {
        let value = format!("pulled at {speed:.0e} m/s");
        let mut all = Vec::new();
        for row in 0..side {
            for layer in 0..layers {
                for k in 0..side {
                    let [x, y, z] = [k, layer, row].map(f64::from);
                    let at = place::<S>(0.1 + 0.2 * x, 0.1 + 0.2 * y, 0.1 + 0.2 * z);
                    let velocity = place::<S>(speed * x, speed * y, speed * z);
                    all.push(format!("(at: {at}, radius: 0.1, velocity: {velocity})"));
                }
            }
        }
        let sketch = Sketch {
            step: 1e-6,
            gravity: 0.0,
            interface: r#"cohesion: "elastic-bond", damage: "linear-softening","#,
            parameters: r#", cohesion: {"k_n": 1e12, "k_t": 1e12}, damage: {"strength": 1e6, "energy": 10.0}"#.to_owned(),
            detection: [1e-3, 2e-2],
            grains: grains("m0", &all),
            ..Sketch::default()
        };
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, HELD, &e),
        };
        let mut at_once = 0;
        let ran = watch(&mut s, 200, |s| {
            at_once = at_once.max(s.state.network.bond_breaks.len() as u64);
        });
        let (made, broken) = (s.state.network.bonds_made(), s.state.network.bonds_broken());
        let residual = s.state.energy.relative_residual();
        let found =
            format!("{broken} of {made} broke, {at_once} in one step; residual {residual:.1e}");
        let met = made == bonds && at_once == made && residual < 1e-9;
        ran.row(&s, (value, found), met, HELD)
    };
    [1e2, 1e3].map(pulled).into()
}
