//! Bodies that swing and rotate in hollow bodies remain on them: closed forms of the pendulum, of
//! rolling, and of a wall that carries its grains.

use crate::extremes::bench::{G, Sketch, place};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

/// Radius of the drum and of the grain (m), and of the circle of the grain's centre.
const DRUM: f64 = 0.5;
const GRAIN: f64 = 0.07;
const ARM: f64 = DRUM - GRAIN;

/// Complete elliptic integral of the first kind of the modulus k, by the arithmetic-geometric mean
/// (Abramowitz and Stegun, 17.6).
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0f64, (1.0 - k * k).sqrt());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

fn build<S: Space>(sketch: &Sketch) -> Simulation<S> {
    sketch.build().unwrap_or_else(|e| panic!("{e}"))
}

/// A grain in a drum, from the amplitude at rest.
fn swinging<S: Space>(amplitude: f64, mu: f64, step: f64) -> Simulation<S> {
    let at = place::<S>(ARM * amplitude.sin(), 0.0, -ARM * amplitude.cos());
    build(&Sketch {
        step,
        mu,
        detection: [1.4e-3, 0.035],
        bodies: format!(
            "(name: \"drum\", material: \"m0\", shapes: [Drum(radius: {DRUM:?}, axis: 1)]),"
        )
        .replace(if S::D == 2 { ", axis: 1" } else { "no" }, ""),
        grains: format!("List(material: \"m0\", grains: [(at: {at}, radius: {GRAIN:?})]),"),
        solver: "tolerance: 1e-12, max_iterations: 10000,".to_owned(),
        ..Sketch::default()
    })
}

/// Follows a swing. Returns the deviation of the centre from its circle over the grain's radius,
/// the energy loss relative to the difference between amplitude and bottom, and the times at which
/// it is at the bottom.
struct Swing {
    out: f64,
    lost: f64,
    bottoms: Vec<f64>,
}

fn swing<S: Space>(s: &mut Simulation<S>, end: f64) -> Swing {
    let last = S::D - 1;
    let mut found = Swing {
        out: 0.0,
        lost: 0.0,
        bottoms: Vec::new(),
    };
    let mass = s.state.bodies.mass[0];
    let height = s.state.bodies.position[0][last] + ARM;
    while s.state.time < end {
        let (before, t) = (s.state.bodies.position[0][0], s.state.time);
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let x = s.state.bodies.position[0];
        found.out = found.out.max((x[0].hypot(x[last]) - ARM).abs() / GRAIN);
        if before * x[0] < 0.0 {
            found
                .bottoms
                .push(t + (s.state.time - t) * before / (before - x[0]));
        }
    }
    let energy = &s.state.energy;
    found.lost = (energy.impact.abs() + energy.friction.abs()) / (mass * G * height);
    assert!(energy.relative_residual() < 1e-9);
    found
}

/// Without friction the centre is a pendulum of length R - r: T = 4 sqrt(L/g) K(sin(amplitude/2)).
/// If the grain rolls, the inertia about the contact replaces the mass: T is longer by sqrt(1 +
/// I/(m r^2)). At rest, at the amplitude, rolling needs mu = tan(amplitude)/(1 + m r^2/I), 0.86 for
/// a disk.
fn keeps_swinging<S: Space>(end: f64, step: f64) {
    let amplitude: f64 = 1.2;
    let inertia = if S::D == 2 { 0.5 } else { 0.4 };
    for (mu, of_mass) in [(0.0, 1.0), (1.2, 1.0 + inertia)] {
        let mut s = swinging::<S>(amplitude, mu, step);
        let found = swing(&mut s, end);
        let period = 4.0 * (of_mass * ARM / G).sqrt() * elliptic((0.5 * amplitude).sin());
        let n = found.bottoms.len();
        let measured = 2.0 * (found.bottoms[n - 1] - found.bottoms[0]) / (n - 1) as f64;
        println!(
            "{}D, mu {mu}: period {measured:.6} s (closed form {period:.6} s), {:.2e} of the radius off the circle, {:.2e} of the energy \
             lost in {end} s",
            S::D,
            found.out,
            found.lost
        );
        assert!(
            (measured / period - 1.0).abs() < 3e-4,
            "{measured} {period}"
        );
        assert!(found.out < 1e-3, "{}", found.out);
        assert!(found.lost < 2e-3, "{}", found.lost);
        assert_eq!(s.state.network.step_size.warning(), None);
    }
}

#[test]
fn a_disk_swings_in_a_drum_for_ever() {
    keeps_swinging::<Dim2>(60.0, 1e-3);
}

#[test]
fn a_sphere_swings_in_a_cylinder() {
    keeps_swinging::<Dim3>(20.0, 1e-3);
}

/// The swing above starts 1.2 rad from the bottom. Along the wall, without gravity, the grain moves
/// with its initial speed.
#[test]
fn a_disk_goes_round_a_drum_with_the_speed_that_it_has() {
    let mut s = build::<Dim2>(&Sketch {
        mu: 0.0,
        gravity: 0.0,
        detection: [1.4e-3, 0.035],
        bodies: format!("(name: \"drum\", material: \"m0\", shapes: [Drum(radius: {DRUM:?})]),"),
        grains: format!(
            "List(material: \"m0\", grains: [(at: [0.0, {:?}], radius: {GRAIN:?}, velocity: [2.0, 0.0])]),",
            -ARM
        ),
        ..Sketch::default()
    });
    for _ in 0..20_000 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let r = s.state.bodies.position[0].norm();
        assert!(
            (r - ARM).abs() < 1e-4 * GRAIN,
            "{}: {}",
            s.state.time,
            r - ARM
        );
    }
    assert!((s.state.bodies.velocity[0].norm() / 2.0 - 1.0).abs() < 1e-5);
}

/// A box of planes and a box of convex shapes rotate: grains on their walls rotate with them, at m
/// w^2 r. A disk in the middle of a wall is not stable: it rolls away as exp(w t sqrt(2/3)), so it
/// is followed for one turn only.
#[test]
fn turning_walls_carry_their_grains_round() {
    let (turns, r) = (6.0, 0.02);
    let planes = "HalfSpace(normal: [-1.0, 0.0], at: [0.3, 0.0]), HalfSpace(normal: [1.0, 0.0], at: [-0.3, 0.0])";
    let blocks = "Polygon(points: [(0.3, -0.3), (0.35, -0.3), (0.35, 0.3), (0.3, 0.3)]), \
                  Polygon(points: [(-0.35, -0.3), (-0.3, -0.3), (-0.3, 0.3), (-0.35, 0.3)])";
    for shapes in [planes, blocks] {
        let x = 0.3 - r;
        let v = turns * x;
        let thrown = [
            format!(
                "List(material: \"m0\", grains: [(at: [{x:?}, 0.0], radius: {r:?}, velocity: [0.0, {v:?}], spin: [{turns:?}])]),"
            ),
            format!(
                "Polygons(material: \"m0\", grains: [(at: [{x:?}, 0.0], points: [(-{r:?}, -{r:?}), ({r:?}, -{r:?}), ({r:?}, {r:?}), \
                 (-{r:?}, {r:?})], velocity: [0.0, {v:?}], spin: [{turns:?}])]),"
            ),
        ];
        for (grains, steps) in thrown.into_iter().zip([1000_i32, 10_000]) {
            let mut s = build::<Dim2>(&Sketch {
                mu: 0.9,
                gravity: 0.0,
                detection: [4e-4, 0.01],
                bodies: format!(
                    "(name: \"box\", material: \"m0\", shapes: [{shapes}], dofs: (rz: Velocity(Constant({turns:?})))),"
                ),
                grains,
                ..Sketch::default()
            });
            let grain = s.state.bodies.grains().next().expect("a grain");
            let mut off = 0.0f64;
            let mut load = 0.0f64;
            for _ in 0..steps {
                s.step().unwrap_or_else(|e| panic!("{e}"));
                off = off.max((s.state.bodies.position[grain].norm() - x).abs() / r);
                load += s.state.received[0].0.norm() / f64::from(steps) / s.options.scheme.h;
            }
            let force = s.state.bodies.mass[grain] * turns * turns * x;
            println!(
                "off by {off:.2e} radii, force {:.5} of m w^2 r",
                load / force
            );
            assert!(off < 3e-3, "{shapes}: {off}");
            assert!((load / force - 1.0).abs() < 1e-3, "{load} {force}");
        }
    }
}

/// A disk that slides without friction from the top of a fixed one leaves it where the cosine of
/// the angle is 2/3; until then its energy is conserved.
#[test]
fn a_disk_leaves_another_one_at_two_thirds() {
    let start: f64 = 0.02;
    let sum = 0.4;
    let mut s = build::<Dim2>(&Sketch {
        step: 2e-4,
        mu: 0.0,
        bodies: "(name: \"hill\", material: \"m0\", shapes: [Balls([([0.0, 0.0], 0.3)])]),"
            .to_owned(),
        grains: format!(
            "List(material: \"m0\", grains: [(at: [{:?}, {:?}], radius: 0.1)]),",
            sum * start.sin(),
            sum * start.cos()
        ),
        ..Sketch::default()
    });
    let grain = s.state.bodies.grains().next().expect("a grain");
    let mut leaves = f64::NAN;
    for _ in 0..20_000 {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        let x = s.state.bodies.position[grain];
        if report.active > 0 {
            leaves = x.y / x.norm();
        }
        if x.norm() > 1.05 * sum {
            break;
        }
    }
    let known = 2.0 / 3.0 * start.cos();
    println!("leaves at cos {leaves:.5}, closed form {known:.5}");
    assert!((leaves / known - 1.0).abs() < 5e-3, "{leaves} {known}");
    assert!(s.state.energy.impact.abs() < 1e-3 * s.state.energy.kinetic);
}
