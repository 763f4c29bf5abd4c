//! Reported error of the heat of partial slip from the number of elements across the slipping
//! strips, compared with Cattaneo and Mindlin, and Carter.

use super::rolling::rolling;
use super::*;
use fretwork_observe::resolution::Resolution;

const LOAD: f64 = 178.9e3;
const A: f64 = 1e-3;

/// Heat of a cycle of the force +-Q of a line contact relative to the closed form, and the error
/// that the run reports.
///
/// Relative displacements of distant points under a force that rises from zero are d(Q) = K int
/// -ln(c/a) dQ plus a part linear in Q, with K = 2/(pi E*) for two bodies and c/a = sqrt(1 - Q/(mu
/// P)) (Johnson, sections 2.4 and 7.2). By Mindlin and Deresiewicz a loop has d_max - 2 d((Q_max -
/// Q)/2) on its way back; its area is the heat.
fn loop_of_a_line(n: usize, share: f64, mu: f64) -> (f64, Resolution) {
    let size = A / n as f64;
    let half = (1.4 * n as f64).round() * size;
    let cells = grid([size, 1.0], [half, 0.5]);
    let mut s = empty::<Dim2>(mu, "[0.0, 1.0]");
    put(&mut s, half_space(RAIL, cells, &[Dof::Fixed, Dof::Fixed]));
    let period = 100.0 * STEP;
    let axes = [
        Dof::Force(TimeFunction::Sine {
            amplitude: share * mu * LOAD,
            frequency: 1.0 / period,
            phase: 0.0,
            offset: 0.0,
            start: 20.0 * STEP,
        }),
        Dof::Force(ramp(-LOAD, 0, 10)),
    ];
    let cylinder = HalfSpaceSpec {
        name: "upper",
        fills: FilledSide::Above,
        profile: Profile::Paraboloid([0.5, f64::INFINITY]),
        mass: 10.0,
        touching: Cells::Points,
        ..half_space(RAIL, cells, &axes)
    };
    put(&mut s, cylinder);
    go(&mut s, 120);
    let mut seen = Resolution::new("lower");
    let before = s.state.energy.friction;
    for _ in 0..100 {
        go(&mut s, 1);
        seen.add(&s, 0, &[false; 2], s.state.energy.friction - before);
    }
    let heat = s.state.energy.friction - before;
    let per_force = 2.0 / (PI * 0.5 * RAIL.plane_strain());
    let limit = mu * LOAD;
    // This is int_0^x -ln(1 - y)/2 dy.
    let displacement = |q: f64| {
        let left = 1.0 - q / limit;
        0.5 * per_force * limit * (left * left.max(1e-300).ln() + q / limit)
    };
    let most = share * limit;
    let count = 4000;
    let area = (0..count).map(|k| {
        let q = most * (2.0 * (f64::from(k) + 0.5) / f64::from(count) - 1.0);
        let half = |q: f64| displacement(0.5 * q);
        2.0 * (displacement(most) - half(most - q) - half(most + q)) * 2.0 * most / f64::from(count)
    });
    (heat / area.sum::<f64>(), seen)
}

#[test]
fn the_heat_of_a_cycle_is_within_what_is_said() {
    for (n, share) in [
        (4, 0.5),
        (5, 0.3),
        (5, 0.5),
        (8, 0.3),
        (8, 0.7),
        (16, 0.5),
        (16, 0.9),
    ] {
        let (ratio, seen) = loop_of_a_line(n, share, 0.6);
        println!(
            "{n} over a, Q/(mu P) {share}: heat {ratio:.4} of the closed form; {}",
            seen.line()
        );
        let bound = seen.heat_error + 0.01;
        assert!((ratio - 1.0).abs() < bound, "{ratio} {bound}");
    }
}

#[test]
fn the_heat_of_rolling_is_short_by_what_is_said() {
    let (mu, radius) = (0.3, 0.5);
    for (n, s) in [(5, 0.1), (5, 0.4), (10, 0.2), (10, 0.7), (20, 0.2)] {
        let size = A / n as f64;
        let creepage = s * mu * A / radius;
        let cells = grid([size, 1.0], [1.4 * A, 0.5]);
        let mut run = rolling::<Dim2>(cells, [radius, f64::INFINITY], LOAD, mu, creepage, size);
        go(&mut run, 16 * n as usize);
        let before = run.state.energy.friction;
        let mut seen = Resolution::new("lower");
        for _ in 0..10 {
            go(&mut run, 1);
            seen.add(&run, 0, &[true; 2], run.state.energy.friction - before);
        }
        let q = mean(&tractions(&run, size), 0, |_| 1.0) * LOAD;
        let ratio = (run.state.energy.friction - before) / (10.0 * size * q * creepage);
        println!(
            "{n} over a, s {s}: heat {ratio:.4} of Q xi V; {}",
            seen.line()
        );
        let reported = 1.0 - seen.heat_error;
        assert!((ratio - reported).abs() < 0.08, "{ratio} {reported}");
    }
}
