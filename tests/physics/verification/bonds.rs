//! One bond pulled: Monerie-Acary-Cangemi with C = 1e12 Pa/m, w = 0.1 J/m^2.

use super::{Table, plane};
use fretwork::geometry::space::Dim2;
use fretwork::step::Simulation;

const C: f64 = 1e12;
const W: f64 = 0.1;
/// Area r1 r2/(r1 + r2) of two grains of 1 m, times unit depth (m^2).
const AREA: f64 = 0.5;

pub fn all(table: &mut Table) {
    modes(table);
    viscosity(table);
    unload(table);
}

/// Traction on the grip along its motion (Pa).
fn traction(s: &Simulation<Dim2>) -> f64 {
    let grip = s
        .state
        .bodies
        .driven
        .iter()
        .position(|d| d.name == "grip")
        .unwrap();
    let v = s.state.bodies.velocity[s.state.bodies.driven[grip].body as usize];
    -s.state.received[grip].0.dot(&v) / v.norm() / s.options.scheme.h / AREA
}

/// Pulls to an opening; returns peak traction (Pa) and work (J/m^2).
fn pull(case: &str, sets: &[&str], reach: f64) -> (f64, f64) {
    let mut s = plane(case, sets);
    let (mut peak, mut work, mut opening) = (0.0f64, 0.0, 0.0);
    while opening < reach {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let du = 0.045 * s.options.scheme.h;
        opening += du;
        let t = traction(&s);
        peak = peak.max(t);
        work += t * du;
    }
    (peak, work)
}

fn modes(table: &mut Table) {
    let u0 = (W / C).sqrt();
    // Area from 0 to u0 is w/2, from u0 to 10 u0 w (1 - 1/100)/2.
    let area = 0.5 * W + 0.5 * W * (1.0 - 0.01);
    for case in ["bond_mode_1", "bond_mode_2", "bond_mixed"] {
        let (peak, work) = pull(case, &["time.step=2e-9"], 10.0 * u0);
        table.compare(case, "peak sqrt(w C) (Pa)", (W * C).sqrt(), peak, 1e-3);
        table.compare(case, "area to 10 u0 (J/m^2)", area, work, 1e-3);
    }
}

/// Returns peak and area of the continuum limit b dbeta/dt = w - beta C u^2 for u = 0.045 t to 100
/// um, by Heun's rule with steps far below those of the case.
fn ode(b: f64) -> (f64, f64) {
    let (rate, n) = (0.045, 4_000_000);
    let h = 100e-6 / rate / f64::from(n);
    let (mut beta, mut peak, mut area, mut last) = (1.0f64, 0.0f64, 0.0, 0.0);
    for k in 0..n {
        let slope = |beta: f64, t: f64| ((W - beta * C * (rate * t).powi(2)) / b).min(0.0);
        let t = f64::from(k) * h;
        let first = slope(beta, t);
        let second = slope((beta + h * first).max(0.0), t + h);
        beta = (beta + 0.5 * h * (first + second)).max(0.0);
        let u = rate * (t + h);
        let sigma = beta * beta * C * u;
        area += 0.5 * (sigma + last) * rate * h;
        last = sigma;
        peak = peak.max(sigma);
    }
    (peak, area)
}

fn viscosity(table: &mut Table) {
    for b in [1e-6, 1e-5, 1e-4] {
        let (expected_peak, expected_area) = ode(b);
        let set = format!("interfaces.grain.parameters.damage.b={b:?}");
        let (peak, work) = pull("bond_mode_1", &[&set], 100e-6);
        table.compare(
            "bond_mode_1",
            &format!("peak, b {b:e} J s/m^2 (Pa)"),
            expected_peak,
            peak,
            1e-2,
        );
        table.compare(
            "bond_mode_1",
            &format!("area to 100 um, b {b:e} (J/m^2)"),
            expected_area,
            work,
            1e-2,
        );
    }
}

fn unload(table: &mut Table) {
    let u0 = (W / C).sqrt();
    let mut s = plane("bond_unload", &[]);
    let bond = |s: &Simulation<Dim2>| {
        // There is no bond before the first step.
        s.state.network.memory[0]
            .bonds
            .first()
            .map_or((0.0, 0.0), |b| (b.opening_n, b.damage))
    };
    let (mut most, mut at_turn, mut worst, mut gained) = (0.0f64, f64::NAN, 0.0f64, 0.0f64);
    while s.state.time < 7e-5 - 0.5 * s.options.scheme.h {
        let (before, damage) = bond(&s);
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let (after, now) = bond(&s);
        let below = after < most * (1.0 - 1e-9);
        if below {
            at_turn = damage;
            gained = gained.max(now - damage);
            // The traction of the step is the secant at its theta-point.
            let grip = s
                .state
                .bodies
                .driven
                .iter()
                .position(|d| d.name == "grip")
                .unwrap();
            let got = -s.state.received[grip].0.y / s.options.scheme.h / AREA;
            let expected = (1.0 - damage).powi(2) * C * 0.5 * (before + after);
            worst = worst.max((got / expected - 1.0).abs());
        }
        most = most.max(after);
    }
    let case = "bond_unload";
    table.compare(case, "secant while unloaded, worst error", 0.0, worst, 1e-9);
    table.compare(
        case,
        "damage gained below the largest opening",
        0.0,
        gained,
        1e-12,
    );
    // The law gives beta = w/(C u^2) at 2 u0.
    table.compare(
        case,
        "damage at 2 u0",
        1.0 - W / (C * (2.0 * u0).powi(2)),
        at_turn.min(1.0),
        1e-2,
    );
    let (end, damage) = bond(&s);
    table.compare(
        case,
        "damage at the end",
        1.0 - W / (C * end * end),
        damage,
        1e-6,
    );
}
