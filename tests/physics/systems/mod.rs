//! Dynamical systems beside rigid bodies: a body of two masses on a spring vibrates, falls, slides,
//! collides and is bonded according to closed forms, and continues from a saved state.

mod calls;
mod methods;
mod scales;
mod spring;
mod stiffening;

use crate::extremes::bench::{G, Sketch, ball, floor, grains, place, plane, volume};
use crate::stepping::{closes, go, near, steps};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::record::encoding::{decode, encode};
use fretwork::step::{Simulation, State};
use spring::{Spring, Touching};

const R: f64 = 0.1;

fn sketch() -> Sketch {
    Sketch {
        solver: "tolerance: 1e-13, norm: Velocity, max_iterations: 100000, test_every: 1,"
            .to_owned(),
        ..Sketch::default()
    }
}

fn built<S: Space>(sketch: &Sketch) -> Simulation<S> {
    sketch.build::<S>().unwrap_or_else(|e| panic!("{e}"))
}

fn at<S: Space>(x: f64, up: f64) -> S::Vector {
    let mut place = S::Vector::zero();
    (place[0], place[S::D - 1]) = (x, up);
    place
}

/// Positions of the contactors of the first system.
fn contactors<S: Space>(s: &Simulation<S>) -> Vec<S::Vector> {
    let bodies = s.state.systems.bodies(0).iter();
    bodies
        .map(|b| s.state.bodies.position[*b as usize])
        .collect()
}

/// Momentum of the grains and of the first system, along the first axis.
fn momentum<S: Space>(s: &Simulation<S>, mass: [f64; 2]) -> f64 {
    let grains: f64 = s
        .state
        .bodies
        .grains()
        .map(|b| s.state.bodies.mass[b] * s.state.bodies.velocity[b][0])
        .sum();
    let velocity = s.state.systems.get(0).unwrap().velocity();
    grains + mass[0] * velocity[0] + mass[1] * velocity[S::D]
}

/// Free vibration. The midpoint rule conserves energy and advances the phase by 2 atan(w h/2) per
/// step: tan(w' h/2) = w h/2.
fn vibrates<S: Space>() {
    let (mass, k, stretch) = ([2.0, 3.0], 4e3, 0.01);
    let mut s = built::<S>(&Sketch {
        gravity: 0.0,
        bodies: floor::<S>(),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(mass, k, R, [at::<S>(0.0, 2.0), at::<S>(1.0, 2.0)]);
    spring.displacement[S::D] = stretch;
    s.add_system(Box::new(spring));
    let stored = 0.5 * k * stretch * stretch;
    assert_eq!(s.state.energy.elastic, stored);
    let omega = (k / (mass[0] * mass[1] / (mass[0] + mass[1]))).sqrt();
    let phase = 2.0 * (0.5 * omega * s.options.scheme.h).atan();
    for n in 1..=2000 {
        go(&mut s, 1);
        let [a, b] = contactors(&s)[..] else {
            panic!("two contactors")
        };
        let expected = stretch * (phase * f64::from(n)).cos();
        assert!((b[0] - a[0] - 1.0 - expected).abs() < 1e-11 * f64::from(n));
        near(
            stored,
            s.state.energy.kinetic + s.state.energy.elastic,
            1e-11,
        );
    }
    closes(&s, 1e-12);
}

#[test]
fn it_vibrates_at_the_frequency_of_the_midpoint_rule() {
    vibrates::<Dim2>();
    vibrates::<Dim3>();
}

/// The system is dropped upright on a floor, without restitution: the lower ball then carries the
/// weight of both masses, the spring that of the upper one.
fn comes_to_rest<S: Space>() {
    let (mass, k) = ([2.0, 3.0], 5e4);
    let mut s = built::<S>(&Sketch {
        bodies: floor::<S>(),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(mass, k, R, [at::<S>(0.0, 0.11), at::<S>(0.0, 0.6)]);
    spring.damping = 200.0;
    s.add_system(Box::new(spring));
    go(&mut s, 1500);
    let up = S::D - 1;
    near(
        (mass[0] + mass[1]) * G,
        -s.state.received[0].0[up] / s.options.scheme.h,
        1e-9,
    );
    let [a, b] = contactors(&s)[..] else {
        panic!("two contactors")
    };
    near(mass[1] * G / k, 0.49 - (b[up] - a[up]), 1e-9);
    // The step in which the ball reaches the floor closes the gap at its start.
    near(R, a[up], 1e-9);
    assert!(s.state.energy.viscous > 0.0 && s.state.energy.impact > 0.0);
    closes(&s, 1e-12);
}

#[test]
fn it_comes_to_rest_and_the_contact_carries_its_weight() {
    comes_to_rest::<Dim2>();
    comes_to_rest::<Dim3>();
}

/// Both balls slide on the floor with the deceleration mu g, whatever their masses: they stop after
/// v^2/(2 mu g).
fn slides<S: Space>() {
    let (v, mu) = (1.0, 0.3);
    let mut s = built::<S>(&Sketch {
        mu,
        bodies: floor::<S>(),
        ..sketch()
    });
    let spring = Spring::<S>::new([2.0, 3.0], 5e4, R, [at::<S>(0.0, R), at::<S>(0.5, R)]);
    s.add_system(Box::new(spring.moving(v, v)));
    for n in 1..=300 {
        go(&mut s, 1);
        let t = f64::from(n) * s.options.scheme.h;
        let [a, b] = contactors(&s)[..] else {
            panic!("two contactors")
        };
        assert!((a[0] - (v * t - 0.5 * mu * G * t * t)).abs() < 1e-9);
        assert!((b[0] - a[0] - 0.5).abs() < 1e-9);
    }
    go(&mut s, 200);
    near(0.5 * 5.0 * v * v, s.state.energy.friction, 1e-6);
    near(v * v / (2.0 * mu * G), contactors(&s)[0][0], 1e-5);
    closes(&s, 1e-12);
}

#[test]
fn it_slides_to_a_stop_at_mu_g() {
    slides::<Dim2>();
    slides::<Dim3>();
}

/// The system strikes a grain: momentum is conserved, the ball leaves at e times its approach
/// speed, and the ledger closes.
fn strikes<S: Space>(touching: Touching, theta: f64, stiffening: f64) {
    let (mass, e) = ([2.0, 3.0], 0.6);
    let row = [ball(&place::<S>(1.0, 0.0, 1.0), R)];
    let mut s = built::<S>(&Sketch {
        gravity: 0.0,
        theta,
        restitution: Some(e),
        bodies: floor::<S>(),
        grains: grains("m0", &row),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(mass, 5e4, R, [at::<S>(-0.5, 1.0), at::<S>(0.75, 1.0)]);
    (spring.touching, spring.stiffening) = (touching, stiffening);
    if touching == Touching::Middle {
        spring.home[1][0] = 1.95;
    }
    s.add_system(Box::new(spring.moving(0.5, 0.5)));
    let before = momentum(&s, mass);
    let first = s.state.systems.bodies(0)[s.state.systems.bodies(0).len() - 1] as usize;
    let grain = s.state.bodies.grains().next().unwrap();
    let approach =
        |s: &Simulation<S>| s.state.bodies.velocity[first][0] - s.state.bodies.velocity[grain][0];
    let mut struck = 0;
    for _ in 0..400 {
        let came = approach(&s);
        go(&mut s, 1);
        if s.state
            .network
            .contacts
            .iter()
            .any(|c| c.impulse != S::Vector::zero())
        {
            near(-e * came, approach(&s), 1e-11);
            struck += 1;
        }
        near(before, momentum(&s, mass), 1e-12);
    }
    assert!(struck > 0 && s.state.energy.elastic > 0.0);
    // Velocities are averaged by theta: above 1/2 the scheme books part of the loss of the impact
    // or more than it; the tangent of a stiffening spring is not its secant.
    let sinks = (s.state.energy.impact, s.state.energy.scheme);
    assert!(sinks.0 + sinks.1 > 0.0);
    assert_eq!(sinks.1 == 0.0, theta == 0.5 && stiffening == 0.0);
    closes(&s, 1e-12);
}

#[test]
fn it_strikes_a_grain_and_momentum_and_energy_are_booked() {
    for touching in [Touching::Ends, Touching::Middle] {
        strikes::<Dim2>(touching, 0.5, 0.0);
        strikes::<Dim3>(touching, 0.5, 0.0);
        strikes::<Dim2>(touching, 0.7, 0.0);
    }
}

#[test]
fn a_stiffening_one_strikes_a_grain_and_momentum_and_energy_are_booked() {
    for touching in [Touching::Ends, Touching::Middle] {
        strikes::<Dim2>(touching, 0.5, 1e5);
        strikes::<Dim3>(touching, 0.5, 1e5);
        strikes::<Dim2>(touching, 0.7, 1e5);
    }
}

/// Without a spring each mass is a smooth grain of equal mass: it falls and bounces like one.
fn is_a_grain<S: Space>() {
    let row = [ball(&place::<S>(0.0, 0.0, 0.5), R)];
    let rigid = Sketch {
        mu: 0.0,
        restitution: Some(0.7),
        bodies: floor::<S>(),
        grains: grains("m0", &row),
        ..sketch()
    };
    let mut grain = built::<S>(&rigid);
    let mut s = built::<S>(&Sketch {
        grains: String::new(),
        ..rigid
    });
    let m = 1000.0 * volume::<S>(R);
    let spring = Spring::<S>::new([m, m], 0.0, R, [at::<S>(0.0, 0.5), at::<S>(3.0, 0.8)]);
    s.add_system(Box::new(spring));
    let (at, up) = (grain.state.bodies.grains().next().unwrap(), S::D - 1);
    for _ in 0..1200 {
        go(&mut grain, 1);
        go(&mut s, 1);
        assert!((grain.state.bodies.position[at][up] - contactors(&s)[0][up]).abs() < 1e-12);
    }
    assert!(grain.state.energy.impact > 0.0);
}

#[test]
fn masses_without_a_spring_bounce_as_grains() {
    is_a_grain::<Dim2>();
    is_a_grain::<Dim3>();
}

/// A bond between a grain and the second mass, as stiff as the spring, makes a chain of three equal
/// masses. With initial velocities of v outwards, zero, and v outwards it is in its mode of w^2 =
/// k/m: the bond opens by v/w sin w' t.
fn is_bonded<S: Space>() {
    let (m, v, omega) = (1000.0 * volume::<S>(R), 0.01, 40.0f64);
    let k = m * omega * omega;
    let reduced: f64 = 0.5 * R;
    let area = match S::D {
        2 => reduced,
        _ => std::f64::consts::PI * reduced * reduced,
    };
    let stiffness = k / area;
    let at_grain = place::<S>(2.0 * R, 0.0, 1.0);
    let velocity = place::<S>(v, 0.0, 0.0);
    let mut s = built::<S>(&Sketch {
        gravity: 0.0,
        bodies: floor::<S>(),
        grains: grains(
            "m0",
            &[format!(
                "(at: {at_grain}, radius: {R:?}, velocity: {velocity})"
            )],
        ),
        interface: "cohesion: \"elastic-bond\", bonds: Start,",
        parameters: format!(", cohesion: {{\"k_n\": {stiffness:?}, \"k_t\": {stiffness:?}}}"),
        ..sketch()
    });
    let spring = Spring::<S>::new([m, m], k, R, [at::<S>(-1.0, 1.0), at::<S>(0.0, 1.0)]);
    s.add_system(Box::new(spring.moving(-v, 0.0)));
    let grain = s.state.bodies.grains().next().unwrap();
    let phase = 2.0 * (0.5 * omega * s.options.scheme.h).atan();
    let half = (std::f64::consts::PI / phase) as u32;
    assert!(half > 40);
    for n in 1..half {
        go(&mut s, 1);
        let opened = v / omega * (phase * f64::from(n)).sin();
        let moved = s.state.bodies.position[grain][0] - 2.0 * R;
        assert!(
            (moved - opened).abs() < 1e-9 * v / omega,
            "{moved:e}, {opened:e}"
        );
        assert_eq!(s.state.network.bonds_made(), 1);
    }
    closes(&s, 1e-12);
}

#[test]
fn a_bond_holds_it_to_a_grain() {
    is_bonded::<Dim2>();
    is_bonded::<Dim3>();
}

/// A heap of rough grains falls between walls on a sprung body whose balls may touch each other,
/// and on a second one that runs into it.
fn heap<S: Space>(theta: f64) -> Simulation<S> {
    let mut row = Vec::new();
    for k in 0..24u32 {
        let (x, y) = (
            0.12 + 0.22 * f64::from(k % 4),
            0.5 + 0.21 * f64::from(k / 4),
        );
        let across = if k % 2 == 0 { 0.03 } else { -0.03 };
        row.push(ball(&place::<S>(x, across, y), R - 1e-3 * f64::from(k % 5)));
    }
    let walls = [
        floor::<S>(),
        plane::<S>("left", 1.0, 0.0, 0.0),
        format!(
            "(name: \"right\", material: \"m0\", shapes: [HalfSpace(normal: {})], position: {}),",
            place::<S>(-1.0, 0.0, 0.0),
            place::<S>(1.0, 0.0, 0.0)
        ),
    ];
    let mut s = built::<S>(&Sketch {
        theta,
        bodies: walls.concat(),
        grains: grains("m0", &row),
        solver: "tolerance: 1e-6, max_iterations: 2000,".to_owned(),
        ..sketch()
    });
    let mut spring = Spring::<S>::new(
        [20.0, 30.0],
        1e4,
        R,
        [at::<S>(0.15, 0.12), at::<S>(0.3505, 0.12)],
    );
    spring.touching = Touching::EndsEachOther;
    spring.damping = 20.0;
    s.add_system(Box::new(spring.moving(0.1, 0.0)));
    let spring = Spring::<S>::new(
        [40.0, 30.0],
        1e4,
        R,
        [at::<S>(0.551, 0.12), at::<S>(0.8, 0.12)],
    );
    s.add_system(Box::new(spring.moving(-0.3, -0.3)));
    s
}

/// Grains and contactors exert forces on each other, and so do contactors on those of their own and
/// of another system.
fn kinds<S: Space>(s: &Simulation<S>, seen: &mut [bool; 3]) {
    for c in &s.state.network.contacts {
        if c.impulse == S::Vector::zero() {
            continue;
        }
        match c.bodies.map(|b| s.state.bodies.carrier(b as usize)) {
            [None, None] => {}
            [Some(a), Some(b)] => seen[if a.system == b.system { 1 } else { 2 }] = true,
            _ => seen[0] = true,
        }
    }
}

fn ledger_of_heap<S: Space>(theta: f64, count: usize, tolerance: f64) {
    let mut s = heap::<S>(theta);
    let mut seen = [false; 3];
    for _ in 0..count {
        steps(&mut s, 1);
        kinds(&s, &mut seen);
    }
    assert_eq!(seen, [true; 3]);
    assert!(s.state.energy.friction > 0.0 && s.state.energy.viscous > 0.0);
    closes(&s, tolerance);
}

#[test]
fn a_heap_on_two_of_them_closes_the_ledger() {
    ledger_of_heap::<Dim2>(0.5, 600, 1e-11);
    ledger_of_heap::<Dim2>(0.7, 600, 1e-11);
    ledger_of_heap::<Dim3>(0.5, 600, 1e-11);
}

fn state<S: Space>(s: &Simulation<S>) -> Vec<u8> {
    encode(&s.state).unwrap()
}

fn goes_on<S: Space>() {
    let (mut whole, mut resumed) = (heap::<S>(0.5), heap::<S>(0.5));
    steps(&mut whole, 300);
    let bytes = state(&whole);
    let saved: State<S> = decode(&bytes).unwrap();
    assert!(resumed.restore(saved));
    assert!(
        state(&resumed) == bytes,
        "what is put back is not what was kept"
    );
    steps(&mut whole, 100);
    steps(&mut resumed, 100);
    assert!(
        state(&whole) == state(&resumed),
        "the steps after it differ"
    );
    // A scene without these systems rejects the state, and is unchanged.
    let mut other = heap::<S>(0.5);
    other.add_system(Box::new(Spring::<S>::new(
        [1.0, 1.0],
        1e3,
        R,
        [at::<S>(0.5, 9.0), at::<S>(1.0, 9.0)],
    )));
    let before = state(&other);
    let saved: State<S> = decode(&bytes).unwrap();
    assert!(!other.restore(saved) && state(&other) == before);
}

#[test]
fn it_goes_on_from_a_saved_state_with_the_same_bits() {
    goes_on::<Dim2>();
    goes_on::<Dim3>();
}

#[test]
fn threads_do_not_change_its_bits() {
    let after = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mut s = heap::<Dim2>(0.5);
            s.options.solver.parallel = threads > 1;
            steps(&mut s, 400);
            state(&s)
        })
    };
    let one = after(1);
    assert!(one == after(1) && one == after(2) && one == after(3));
}

/// A system that moves when it is added keeps its kinetic energy in the ledger if imposed motion
/// begins later.
#[test]
fn imposed_motion_that_begins_later_leaves_the_energy_of_systems() {
    let mut s = built::<Dim2>(&Sketch {
        gravity: 0.0,
        bodies: floor::<Dim2>(),
        ..sketch()
    });
    let spring = Spring::<Dim2>::new(
        [2.0, 3.0],
        4e3,
        R,
        [at::<Dim2>(0.0, 2.0), at::<Dim2>(1.0, 2.0)],
    );
    s.add_system(Box::new(spring.moving(1.0, 0.0)));
    s.set_in_motion();
    assert_eq!(s.state.energy.kinetic, 1.0);
    assert_eq!(s.state.energy.initial_kinetic, 1.0);
    go(&mut s, 10);
    closes(&s, 1e-12);
}

/// A moment does no work on a contactor that does not rotate: with rolling friction it slides as
/// with friction alone, and decelerates by mu g.
#[test]
fn a_contactor_that_does_not_turn_takes_moments_without_power() {
    let (mu, speed, mass) = (0.3, 2.0, [2.0, 3.0]);
    let mut s = built::<Dim2>(&Sketch {
        contact: "rolling-friction",
        of_contact: ", \"rolling\": 0.02".to_owned(),
        mu,
        bodies: floor::<Dim2>(),
        ..sketch()
    });
    let spring = Spring::<Dim2>::new(mass, 4e3, R, [at::<Dim2>(0.0, R), at::<Dim2>(1.0, R)]);
    s.add_system(Box::new(spring.moving(speed, speed)));
    go(&mut s, 100);
    let left = speed - mu * G * s.state.time;
    near(5.0 * left, momentum(&s, mass), 1e-9);
    let heat = 2.5 * (speed * speed - left * left);
    near(heat, s.state.energy.friction, 1e-9);
    closes(&s, 1e-12);
}
