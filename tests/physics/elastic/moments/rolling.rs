//! Rolling and spinning friction of a disk and a sphere on stiff deformable ground give the results
//! of rigid ground.
//!
//! With the friction length l, a disk (b = 1/2) or a sphere (b = 2/5) of radius R that rolls is
//! slowed down by
//!
//! ```text
//! a = g l/R/(1 + b)                  on a slope a = (g l/R cos phi - g sin phi)/(1 + b), rolling from tan phi = l/R on
//! ```
//!
//! from m a = T, b m R^2 a/R = l N - T R with the friction T and the force N = m g of the ground. A
//! sphere that spins about the normal loses the angular momentum l int N dt. Source: K. L. Johnson,
//! "Contact Mechanics" (1985), section 8.1, of the moment of rolling resistance.

use super::*;
use fretwork::geometry::space::Dim3;
use fretwork::record::encoding::{decode, encode};
use fretwork::step::State;

const LENGTH: f64 = 0.05 * R;

/// Modulus (Pa) with which the ground deforms by less than 1e-7 R.
const STIFF: f64 = 1e10;

const GROUNDS: [Ground; 5] = [
    Ground::Rigid,
    BLOCK,
    Ground::Block(Strain::Corotational, 16, Touching::Surface("top")),
    Ground::Block(Strain::NeoHookean, 16, Touching::Surface("top")),
    Ground::HalfSpace(16, Cells::Surface),
];

fn rolls<S: Space>(ground: Ground, share: f64) {
    let b = if S::D == 2 { 0.5 } else { 0.4 };
    let (mut at, mut v, mut w) = (vec![0.0; S::D], vec![0.0; S::D], vec![0.0; S::Spin::N]);
    at[0] = -5e-3;
    at[S::D - 1] = R;
    let speed = 0.02;
    v[0] = speed;
    // The spin is about -z in 2D, about +y in 3D.
    match S::D {
        2 => w[0] = -speed / R,
        _ => w[1] = speed / R,
    }
    let mut s = ground.under::<S>(
        &Rolling {
            of_contact: lengths(LENGTH, 0.0),
            grains: grain(&at, &v, &w),
            ..Rolling::default()
        },
        STIFF,
    );
    let slowing = G * LENGTH / R / (1.0 + b);
    let time = speed / slowing;
    go(&mut s, (share * time / 1e-4) as usize);
    let found = speed - velocity(&s)[0];
    let expected = slowing * s.state.time;
    println!(
        "{}D {ground:?}: slowed down by {} of {expected}",
        S::D,
        found
    );
    near(expected, found, 2e-3);
    // The grain rolls and does not slide.
    let turned = match S::D {
        2 => -spin(&s)[0],
        _ => spin(&s)[1],
    };
    near(velocity(&s)[0] / R, turned, 2e-3);
    closes(&s, 1e-9);
    go(&mut s, (1.2 * (1.0 - share) * time / 1e-4) as usize);
    assert!(velocity(&s).norm() < 1e-4 * speed, "{:?}", velocity(&s));
    closes(&s, 1e-9);
}

#[test]
fn a_disk_slows_down_as_on_rigid_ground() {
    for ground in GROUNDS {
        rolls::<Dim2>(ground, 0.8);
    }
}

#[test]
fn a_sphere_slows_down_as_on_rigid_ground() {
    for ground in [
        Ground::Block(Strain::Small, 8, Touching::Surface("top")),
        Ground::HalfSpace(8, Cells::Surface),
    ] {
        rolls::<Dim3>(ground, 0.8);
    }
}

/// The slope is a tenth less and a tenth more than that at which a disk rolls.
#[test]
fn a_disk_rolls_where_the_slope_exceeds_the_friction_length() {
    for ground in [BLOCK, GROUNDS[3], GROUNDS[4]] {
        for factor in [0.9, 1.1] {
            let slope = (factor * LENGTH / R).atan();
            let mut s = ground.under::<Dim2>(
                &Rolling {
                    of_contact: lengths(LENGTH, 0.0),
                    grains: grain(&[0.0, R], &[0.0, 0.0], &[0.0]),
                    ..Rolling::default()
                },
                STIFF,
            );
            (s.state.gravity[0], s.state.gravity[1]) = (G * slope.sin(), -G * slope.cos());
            go(&mut s, 500);
            let found = velocity(&s)[0] / s.state.time;
            let expected = G * (slope.sin() - LENGTH / R * slope.cos()).max(0.0) / 1.5;
            println!("{ground:?}, {factor}: {found} of {expected} m/s^2");
            assert!((found - expected).abs() < 2e-3 * G * slope.sin());
            closes(&s, 1e-9);
        }
    }
}

/// A sphere spins about the normal without sliding friction.
#[test]
fn spinning_friction_takes_angular_momentum() {
    for ground in [
        Ground::Block(Strain::Small, 8, Touching::Surface("top")),
        Ground::Block(Strain::NeoHookean, 4, Touching::Surface("top")),
        Ground::Block(Strain::Small, 8, Touching::Points("top")),
        Ground::HalfSpace(8, Cells::Surface),
    ] {
        let start = 5.0;
        let mut s = ground.under::<Dim3>(
            &Rolling {
                mu: 0.0,
                of_contact: lengths(0.0, LENGTH),
                // The sphere is above a point of the mesh.
                grains: grain(&[0.0, 0.0, R], &[0.0; 3], &[0.0, 0.0, start]),
                ..Rolling::default()
            },
            STIFF,
        );
        let (mass, inertia) = (
            s.state.bodies.mass[ball(&s)],
            0.4 * s.state.bodies.mass[ball(&s)] * R * R,
        );
        go(&mut s, 200);
        let lost = inertia * (start - spin(&s)[2]);
        let pressed = mass * (G * s.state.time + velocity(&s)[2]);
        println!(
            "{ground:?}: lost {} of l int N dt",
            lost / (LENGTH * pressed)
        );
        near(LENGTH * pressed, lost, 1e-6);
        closes(&s, 1e-9);
        go(&mut s, 600);
        assert!(spin(&s).norm() < 1e-6, "{:?}", spin(&s));
        closes(&s, 1e-9);
    }
}

/// Results are bit-identical for any number of threads, and after a restart from a saved state.
#[test]
fn rolling_gives_the_same_bits() {
    let start = || {
        GROUNDS[3].under::<Dim2>(
            &Rolling {
                of_contact: lengths(LENGTH, 0.0),
                grains: grain(&[-5e-3, R], &[0.1, 0.0], &[-0.1 / R]),
                ..Rolling::default()
            },
            1e7,
        )
    };
    let mut s = start();
    go(&mut s, 100);
    let bytes = encode(&s.state).unwrap();
    go(&mut s, 100);
    let expected = encode(&s.state).unwrap();
    let mut resumed = start();
    let saved: State<Dim2> = decode(&bytes).unwrap();
    assert!(resumed.restore(saved));
    go(&mut resumed, 100);
    assert!(encode(&resumed.state).unwrap() == expected);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let found = pool.unwrap().install(|| {
            let mut s = start();
            go(&mut s, 200);
            encode(&s.state).unwrap()
        });
        assert!(found == expected, "{threads} threads");
    }
}
