//! Rigid dynamics: impacts, sliding, rolling, columns.

use super::{G, Table, plane, solid, until};
use fretwork::geometry::space::{Dim2, Space};
use fretwork::step::Simulation;

pub fn all(table: &mut Table) {
    bouncing_ball(table);
    incline(table);
    slide_to_stop(table);
    slide_to_roll(table);
    roll_down(table);
    cradle(table);
    column(table);
}

/// The body other than the floor: the last one added, or the first grain.
fn mover<S: Space>(s: &Simulation<S>) -> usize {
    (0..s.state.bodies.len())
        .find(|b| !s.state.bodies.immovable(*b))
        .unwrap()
}

fn bouncing_ball(table: &mut Table) {
    let (h0, e, r) = (1.0, 0.8, 0.1);
    let mut s = plane("bouncing_ball", &[]);
    let ball = mover(&s);
    let (mut apexes, mut rising, mut top, mut last_bounce) = (Vec::new(), false, 0.0f64, 0.0);
    until(&mut s, 4.3, |s| {
        let (y, v) = (
            s.state.bodies.position[ball].y - r,
            s.state.bodies.velocity[ball].y,
        );
        if v > 0.0 {
            if !rising {
                last_bounce = s.state.time;
            }
            rising = true;
            top = top.max(y);
        } else if rising {
            apexes.push(top);
            (rising, top) = (false, 0.0);
        }
    });
    let case = "bouncing_ball";
    table.compare(case, "first apex e^2 h0 (m)", e * e * h0, apexes[0], 1e-2);
    table.compare(
        case,
        "third apex e^6 h0 (m)",
        e.powi(6) * h0,
        apexes[2],
        1e-2,
    );
    let end = (2.0 * h0 / G).sqrt() * (1.0 + e) / (1.0 - e);
    table.compare(case, "end of the bounces (s)", end, last_bounce, 1e-2);
}

fn incline(table: &mut Table) {
    let angle = 30f64.to_radians();
    let run = |sets: &[&str]| {
        let mut s = plane("incline", sets);
        let block = mover(&s);
        until(&mut s, 0.5, |_| {});
        (
            s.state.bodies.velocity[block].x / s.state.time,
            s.state.bodies.position[block].x,
        )
    };
    let expected = G * (angle.sin() - 0.3 * angle.cos());
    table.compare(
        "incline",
        "acceleration, mu 0.3 (m/s^2)",
        expected,
        run(&[]).0,
        1e-4,
    );
    let stuck = run(&["interfaces.grain.parameters.contact.mu=0.6"]).1;
    table.compare("incline", "slide, mu 0.6 (m)", 0.0, stuck, 1e-9);
    let critical = 0.3f64.atan().to_degrees();
    for (degrees, slips) in [(critical - 0.1, false), (critical + 0.1, true)] {
        let a = degrees.to_radians();
        let set = format!("gravity=[{:?}, {:?}]", G * a.sin(), -G * a.cos());
        let (acceleration, x) = run(&[&set]);
        if slips {
            let expected = G * (a.sin() - 0.3 * a.cos());
            table.compare(
                "incline",
                "slips 0.1 degrees above atan mu",
                expected,
                acceleration,
                1e-3,
            );
        } else {
            table.compare("incline", "sticks 0.1 degrees below atan mu", 0.0, x, 1e-9);
        }
    }
}

fn slide_to_stop(table: &mut Table) {
    let (v, mu) = (1.0, 0.3);
    let mut s = plane("slide_to_stop", &[]);
    let block = mover(&s);
    // Cases give first bodies no initial velocity.
    s.state.bodies.velocity[block].x = v;
    let mut stopped = f64::NAN;
    until(&mut s, 0.4, |s| {
        if stopped.is_nan() && s.state.bodies.velocity[block].x.abs() < 1e-12 {
            stopped = s.state.time;
        }
    });
    table.compare(
        "slide_to_stop",
        "v^2/(2 mu g) (m)",
        v * v / (2.0 * mu * G),
        s.state.bodies.position[block].x,
        5e-3,
    );
    table.compare("slide_to_stop", "v/(mu g) (s)", v / (mu * G), stopped, 5e-3);
}

/// Velocity, time and position at which rolling begins.
fn rolling<S: Space>(s: &mut Simulation<S>, axis: usize) -> (f64, f64, f64) {
    let (ball, r) = (mover(s), 0.1);
    let mut at = None;
    until(s, 0.2, |s| {
        let (v, w) = (
            s.state.bodies.velocity[ball][0],
            s.state.bodies.spin[ball][axis].abs(),
        );
        if at.is_none() && (v - r * w).abs() < 1e-9 {
            at = Some((s.state.time, s.state.bodies.position[ball][0]));
        }
    });
    let (t, x) = at.expect("the ball rolls");
    (s.state.bodies.velocity[ball][0], t, x)
}

fn slide_to_roll(table: &mut Table) {
    let (v, mu) = (1.0, 0.3);
    for (case, k, got) in [
        (
            "slide_to_roll_disk",
            0.5,
            rolling(&mut plane("slide_to_roll_disk", &[]), 0),
        ),
        (
            "slide_to_roll_sphere",
            0.4,
            rolling(&mut solid("slide_to_roll_sphere", &[]), 1),
        ),
    ] {
        // With inertia k m r^2 slip ends when v - mu g t = mu g t/k.
        let t = v / (mu * G * (1.0 + 1.0 / k));
        table.compare(case, "rolling velocity (m/s)", v / (1.0 + k), got.0, 5e-3);
        table.compare(case, "time (s)", t, got.1, 5e-3);
        table.compare(
            case,
            "distance (m)",
            v * t - 0.5 * mu * G * t * t,
            got.2,
            5e-3,
        );
    }
}

fn roll_down(table: &mut Table) {
    let angle = 30f64.to_radians();
    let disk = |sets: &[&str]| {
        let mut s = plane("roll_down_disk", sets);
        let b = mover(&s);
        until(&mut s, 0.5, |_| {});
        (
            s.state.bodies.velocity[b].x / s.state.time,
            0.1 * s.state.bodies.spin[b].norm() / s.state.time,
        )
    };
    let sphere = |sets: &[&str]| {
        let mut s = solid("roll_down_sphere", sets);
        let b = mover(&s);
        until(&mut s, 0.5, |_| {});
        (
            s.state.bodies.velocity[b].x / s.state.time,
            0.1 * s.state.bodies.spin[b].norm() / s.state.time,
        )
    };
    for (case, k, run) in [
        (
            "roll_down_disk",
            0.5,
            &disk as &dyn Fn(&[&str]) -> (f64, f64),
        ),
        ("roll_down_sphere", 0.4, &sphere),
    ] {
        table.compare(
            case,
            "g sin/(1 + k) (m/s^2)",
            G * angle.sin() / (1.0 + k),
            run(&[]).0,
            1e-3,
        );
        // Rolling without slip needs mu >= k/(1 + k) tan.
        let limit = k / (1.0 + k) * angle.tan();
        let mu = 0.99 * limit;
        let set = format!("interfaces.grain.parameters.contact.mu={mu:?}");
        let (a, spin) = run(&[&set]);
        table.compare(
            case,
            "slips below k/(1+k) tan: a (m/s^2)",
            G * (angle.sin() - mu * angle.cos()),
            a,
            1e-3,
        );
        table.compare(
            case,
            "and its spin: mu g cos/k (m/s^2)",
            mu * G * angle.cos() / k,
            spin,
            1e-3,
        );
    }
}

fn cradle(table: &mut Table) {
    for (case, end, expected) in [
        ("cradle_touching", 5e-4, [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]),
        ("cradle_apart", 0.2, [0.0, 0.0, 1.0]),
    ] {
        let mut s = plane(case, &[]);
        until(&mut s, end, |_| {});
        let mut order: Vec<usize> = (0..3).collect();
        order.sort_by(|a, b| {
            s.state.bodies.position[*a]
                .x
                .total_cmp(&s.state.bodies.position[*b].x)
        });
        for (k, (ball, v)) in order.iter().zip(expected).enumerate() {
            let quantity = format!("velocity of ball {} (m/s)", k + 1);
            table.compare(case, &quantity, v, s.state.bodies.velocity[*ball].x, 1e-8);
        }
    }
}

fn column(table: &mut Table) {
    let mut s: Simulation<Dim2> = plane("column", &["solver.tolerance=1e-10"]);
    until(&mut s, 2e-3, |_| {});
    let weight = s.state.bodies.mass[mover(&s)] * G;
    let mut forces: Vec<f64> = s
        .state
        .network
        .contacts
        .iter()
        .map(|c| c.normal.dot(&c.impulse) / s.options.scheme.h)
        .collect();
    forces.sort_by(f64::total_cmp);
    for (k, force) in forces.iter().enumerate() {
        let quantity = format!("force of contact {} over m g", 10 - k);
        table.compare("column", &quantity, (k + 1) as f64, force / weight, 1e-8);
    }
}
