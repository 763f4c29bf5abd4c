//! A nonlinear system: two masses on a spring that stiffens, whose tangent is formed in each step.

use super::spring::Spring;
use super::{R, at, built, closes, contactors, go, near, sketch};
use crate::extremes::bench::{Sketch, floor};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use std::f64::consts::PI;
use std::sync::Arc;

const MASS: [f64; 2] = [2.0, 3.0];
/// Stiffness (N/m), stretch at the start (m), and stiffening (1/m^2): at that stretch the force is
/// twice that of the linear spring.
const SPRING: [f64; 3] = [4e3, 0.01, 1e4];

/// The period of x'' + a x + b x^3 = 0 at an amplitude A: 4 K(m)/sqrt(a + b A^2), m = b A^2/(2 (a +
/// b A^2)), the complete elliptic integral by the arithmetic-geometric mean.
fn period(a: f64, b: f64, amplitude: f64) -> f64 {
    let square = a + b * amplitude * amplitude;
    let m = b * amplitude * amplitude / (2.0 * square);
    let (mut x, mut y) = (1.0, (1.0 - m).sqrt());
    for _ in 0..20 {
        (x, y) = (0.5 * (x + y), f64::sqrt(x * y));
    }
    4.0 * 0.5 * PI / (x * square.sqrt())
}

/// Position of the zero of the cubic through two values and slopes, as a fraction of the step.
fn crossing(h: f64, [x, v]: [f64; 2], [y, w]: [f64; 2]) -> f64 {
    let cubic = |t: f64| {
        let s = 1.0 - t;
        s * s * ((1.0 + 2.0 * t) * x + t * h * v) + t * t * ((1.0 + 2.0 * s) * y - s * h * w)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cubic(middle) * cubic(low) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Mean of ten periods, and the largest relative change of the energy.
fn vibration<S: Space>(h: f64) -> (f64, f64) {
    let [k, stretch, stiffening] = SPRING;
    let mut s = built::<S>(&Sketch {
        step: h,
        gravity: 0.0,
        bodies: floor::<S>(),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(MASS, k, R, [at::<S>(0.0, 2.0), at::<S>(1.0, 2.0)]);
    (spring.stiffening, spring.displacement[S::D]) = (stiffening, stretch);
    let calls = Arc::clone(&spring.calls);
    s.add_system(Box::new(spring));
    let energy = k * (0.5 * stretch.powi(2) + 0.25 * stiffening * stretch.powi(4));
    near(energy, s.state.energy.elastic, 1e-14);
    let state = |s: &fretwork::step::Simulation<S>| {
        let (place, v) = (contactors(s), s.state.systems.get(0).unwrap().velocity());
        [place[1][0] - place[0][0] - 1.0, v[S::D] - v[0]]
    };
    let (mut before, mut downwards, mut changed) = (state(&s), Vec::new(), 0.0f64);
    while downwards.len() < 11 {
        let time = s.state.time;
        go(&mut s, 1);
        assert_eq!(calls.take(), [1, 1, 0], "a tangent and a solve a step");
        let after = state(&s);
        if before[0] > 0.0 && after[0] <= 0.0 {
            downwards.push(time + h * crossing(h, before, after));
        }
        before = after;
        let now = s.state.energy.kinetic + s.state.energy.elastic;
        changed = changed.max((now / energy - 1.0).abs());
        near(now, energy - s.state.energy.scheme, 1e-12);
    }
    closes(&s, 1e-12);
    ((downwards[10] - downwards[0]) / 10.0, changed)
}

/// The period converges to that of Duffing's oscillator with the square of the step, and so does
/// the energy.
fn follows_the_exact_period<S: Space>() {
    let [k, stretch, stiffening] = SPRING;
    let reduced = MASS[0] * MASS[1] / (MASS[0] + MASS[1]);
    let exact = period(k / reduced, k * stiffening / reduced, stretch);
    // The linear spring's is longer by a quarter.
    assert!(exact < 0.8 * 2.0 * PI * (reduced / k).sqrt());
    let runs = [1e-3, 5e-4, 2.5e-4].map(vibration::<S>);
    let off = runs.map(|(period, _)| period - exact);
    for pair in off.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}: {off:?} of {exact}");
    }
    let limit = (4.0 * runs[2].0 - runs[1].0) / 3.0;
    near(exact, limit, 1e-6);
    for pair in runs.windows(2) {
        assert!(pair[0].1 > 3.5 * pair[1].1, "{runs:?}");
    }
}

#[test]
fn a_stiffening_spring_has_the_period_of_duffings_oscillator() {
    follows_the_exact_period::<Dim2>();
    follows_the_exact_period::<Dim3>();
}

#[test]
fn the_period_of_a_linear_and_of_a_cubic_spring() {
    near(2.0 * PI / 3.0, period(9.0, 0.0, 0.7), 1e-14);
    // For x'' + x^3 = 0 at the amplitude 1 the period is sqrt(pi) Gamma(1/4)/Gamma(3/4) times sqrt
    // 2 = 7.416298709...
    near(7.416_298_709_205_488, period(0.0, 1.0, 1.0), 1e-12);
}
