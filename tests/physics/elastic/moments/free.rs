//! A free block and a grain that is bonded to it: angular momentum is conserved.

use super::bonds::section;
use super::*;
use fretwork::geometry::space::{Dim3, about_axes};

/// Angular momentum about the origin (kg m^2/s). The block has lumped masses, a (D + 1)-th of each
/// element at its corners.
fn angular<S: Space>(s: &Simulation<S>) -> S::Spin {
    let system = s.state.systems.get(0).unwrap();
    let mesh = system.deformed_mesh().unwrap();
    let mut sum = S::Spin::zero();
    for element in mesh.elements.chunks_exact(S::D + 1) {
        let corners: Vec<S::Vector> = element.iter().map(|p| mesh.points[*p as usize]).collect();
        let volume = fretwork::elastic::element::Simplex::<S>::new(&corners).unwrap();
        let share = RUBBER.density * volume.volume / (S::D + 1) as f64;
        for p in element {
            let v = system.node_velocity(*p, system.velocity());
            sum += S::moment(&system.node_position(*p), &(v * share));
        }
    }
    let (b, bodies) = (ball(s), &s.state.bodies);
    let inertia = S::BALL_INERTIA * bodies.mass[b] * R * R;
    let orbit = S::moment(&bodies.position[b], &(bodies.velocity[b] * bodies.mass[b]));
    sum + orbit + bodies.spin[b] * inertia
}

/// A free spinning block of rubber, under a grain on its upper side.
fn on_a_free_block<S: Space>(case: &Rolling, strain: Strain) -> Simulation<S> {
    let mut s = case.build::<S>(false);
    let mut lines = vec![even(-0.02, 0.02, 4); S::D - 1];
    lines.push(even(-0.02, 0.0, 2));
    let mut spec = body(block::<S>(&lines).unwrap(), RUBBER, &[]);
    (spec.strain, spec.touching) = (strain, Touching::Surface("top"));
    spec.spin = about_axes::<S>(&S::Spin::from_slice(&[4.0; 3][..S::Spin::N]));
    add(&mut s, spec);
    s
}

/// A spinning grain, at a place on the block with which it moves.
fn spinning<S: Space>(gap: f64) -> String {
    let mut at = vec![0.003; S::D];
    at[S::D - 1] = R + gap;
    grain(&at, &vec![0.0; S::D], &vec![-10.0; S::Spin::N])
}

/// Held by a bond with bending but without shear, whose force would act over its opening.
fn bonded<S: Space>(step: f64) -> Rolling {
    Rolling {
        step,
        theta: 0.5,
        gravity: 0.0,
        mu: 0.0,
        contact: "coulomb",
        interface: "cohesion: \"parallel-bond\", bonds: Start,",
        parameters: ", cohesion: {\"k_n\": 1e8, \"k_t\": 1.0, \"sigma_c\": 1e20, \"tau_c\": 1e20}"
            .to_owned(),
        grains: spinning::<S>(0.0),
        ..Rolling::default()
    }
}

/// Forces of contacts act in the middle of a step by the velocities at its start, those of strain
/// by both velocities: the error of the angular momentum decreases with the square of the step.
fn keeps<S: Space>(strain: Strain) {
    let time = 5e-3;
    let off = [1e-4, 5e-5, 2.5e-5].map(|step| {
        let mut s = on_a_free_block::<S>(&bonded::<S>(step), strain);
        let start = angular(&s);
        go(&mut s, (time / step) as usize);
        let off = (angular(&s) - start).norm() / start.norm();
        let own = S::BALL_INERTIA * s.state.bodies.mass[ball(&s)] * R * R;
        let turned = own * (spin(&s) - S::Spin::from_slice(&vec![-10.0; S::Spin::N])).norm();
        println!(
            "{}D {strain:?}, {step:e} s: angular momentum off by {off:e}, {:e} of it went from the grain to the block",
            S::D,
            turned / start.norm(),
        );
        closes(&s, 1e-9);
        off
    });
    assert!(off[2] < 1e-6 && off[2] < off[1] / 3.0, "{off:?}");
}

#[test]
fn a_bond_keeps_angular_momentum() {
    for strain in LARGE {
        keeps::<Dim2>(strain);
        keeps::<Dim3>(strain);
    }
}

/// Transfer of angular momentum from the grain to the block by a bending bond, relative to which
/// the block is stiff: the oscillator of k_n I between two moments of inertia J, which starts at
/// rest with the relative spin w, has transferred J w (1 - cos omega t).
fn hands_over<S: Space>() {
    let (step, time, k_n, between) = (5e-5, 5e-3, 1e5, 14.0);
    let case = bonded::<S>(step);
    let parameters = case.parameters.replace("1e8", "1e5");
    let mut s = on_a_free_block::<S>(&Rolling { parameters, ..case }, Strain::Corotational);
    let grain = S::BALL_INERTIA * s.state.bodies.mass[ball(&s)] * R * R;
    let (long, high): (f64, f64) = (0.04, 0.02);
    let mass = RUBBER.density * high * long.powi(S::D as i32 - 1);
    let block = mass * (long * long + high * high) / 12.0;
    let inertia = grain * block / (grain + block);
    go(&mut s, (time / step) as usize);
    let turned = grain * (spin(&s) - S::Spin::from_slice(&vec![-10.0; S::Spin::N])).norm();
    let [_, _, bending, _] = section(&s);
    let omega = (k_n * bending / inertia).sqrt();
    // The rotation is about both axes along the surface in 3D, not about the normal.
    let axes = (S::D as f64 - 1.0).sqrt();
    let expected = axes * inertia * between * (1.0 - (omega * time).cos());
    println!(
        "{}D: {turned:e} of {expected:e} kg m^2/s handed over, omega t = {}",
        S::D,
        omega * time
    );
    near(expected, turned, 0.02);
}

#[test]
fn a_bond_hands_angular_momentum_over() {
    hands_over::<Dim2>();
    hands_over::<Dim3>();
}
