//! Flash temperatures: the half-space of a surface point that passes below a contact against closed
//! forms.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_math::diffusion::{Conductor, Graph, Grid, HalfSpace, Node, Store, step};

const STEEL: Conductor = Conductor {
    conductivity: 50.0,
    capacity: 7850.0 * 450.0,
};

/// Returns temperatures of a surface point (K) after each of a number of steps (s) with a flux as a
/// function of time (W/m^2).
fn warmed(flux: impl Fn(f64) -> f64, h: f64, steps: u32) -> Vec<f64> {
    let reach = (STEEL.diffusivity() * h).sqrt();
    let depth = 8.0 * reach * f64::from(steps).sqrt();
    let grid = Grid::graded(STEEL.conductivity, STEEL.capacity, 0.1 * reach, 1.05, depth).unwrap();
    let space = HalfSpace::new(grid, 1.0, 0.0);
    let mut nodes = [Node::new(0.0, Store::HalfSpace(Box::new(space)))];
    let graph = Graph::new(1, Vec::new());
    let mut out = Vec::new();
    for k in 0..steps {
        let middle = h * (f64::from(k) + 0.5);
        step(&mut nodes, &graph, &[flux(middle)], h, 1.0).unwrap();
        out.push(nodes[0].temperature);
    }
    out
}

/// The trailing edge of a fast band is the hottest (Jaeger 1942).
#[test]
fn a_fast_band_warms_what_passes() {
    let (q, b, v) = (1e8, 5e-3, 30.0);
    let exact = STEEL.band(q, b, v);
    let found = warmed(|_| q, 2.0 * b / v / 400.0, 400);
    let error = found[399] / exact - 1.0;
    assert!(error.abs() < 0.02, "{error}");
}

/// For a wheel on a rail with half of the frictional heat into each the rise is 150.3 K at x/a =
/// 0.65 (M. Ertz, K. Knothe, Wear 253 (2002) 498-508, with a = 5.88 mm, b = 10.54 mm, 100 kN, 30
/// m/s, 1 m/s of sliding, friction 0.3).
#[test]
fn a_rail_is_as_warm_as_ertz_and_knothe_say() {
    let (a, b, load, v, sliding, mu) = (5.88e-3, 10.54e-3, 100e3, 30.0, 1.0, 0.3);
    let pressure = 1.5 * load / (std::f64::consts::PI * a * b);
    let flux = |t: f64| {
        let x = t * v / a - 1.0;
        0.5 * mu * pressure * sliding * (1.0 - x * x).max(0.0).sqrt()
    };
    let steps = 1000;
    let found = warmed(flux, 2.0 * a / v / f64::from(steps), steps);
    let (place, most) = found
        .iter()
        .enumerate()
        .max_by(|p, q| p.1.total_cmp(q.1))
        .unwrap();
    let x = 2.0 * (place + 1) as f64 / f64::from(steps) - 1.0;
    assert!((most / 150.3 - 1.0).abs() < 0.02, "{most} K");
    assert!((x - 0.65).abs() < 0.02, "at x/a = {x}");
}

/// At rest the rise in the middle of a circle of uniform flux is q a/k (Carslaw and Jaeger, 10.5);
/// a fast circle is as warm as a band.
#[test]
fn a_circle_has_both_limits() {
    let (q, a) = (1e7, 1e-4);
    let rest = STEEL.circle(q, a, 0.0) / (q * a / STEEL.conductivity);
    assert!((rest - 1.0).abs() < 1e-3, "{rest}");
    let fast = STEEL.circle(q, a, 1e5) / STEEL.band(q, a, 1e5);
    assert!((fast - 1.0).abs() < 1e-3, "{fast}");
}

#[test]
fn shares_add_up() {
    let sand = Conductor {
        conductivity: 1.0,
        capacity: 2e6,
    };
    let share = STEEL.share(&sand);
    assert!(share > 0.85 && (share + sand.share(&STEEL) - 1.0).abs() < 1e-15);
    assert_eq!(STEEL.share(&STEEL), 0.5);
}
