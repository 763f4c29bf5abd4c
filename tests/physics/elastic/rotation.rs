//! Blocks that spin freely: a rotation causes no stress, momentum is conserved, and the angle of a
//! step is that of the theta scheme, 2 atan(w h/2) at theta = 1/2.

use super::*;
use crate::extremes::bench::floor;
use fretwork::geometry::space::Dim3;
use std::f64::consts::PI;

/// A block of 0.2 by 0.1 (by 0.1) m far above the floor, that spins about z.
fn spinning<S: Space>(
    strain: Strain,
    material: Elasticity,
    spin: f64,
    [step, theta]: [f64; 2],
) -> Simulation<S> {
    let mut s = scene::<S>(&Sketch {
        bodies: floor::<S>(),
        ..sketch(step, theta)
    });
    let lines = [even(0.0, 0.2, 4), even(5.0, 5.1, 2), even(5.0, 5.1, 2)];
    let mesh = block::<S>(&lines[..S::D]).unwrap();
    let mut spec = body(mesh, material, &[]);
    spec.strain = strain;
    spec.spin[2] = spin;
    add(&mut s, spec);
    s
}

/// Positions of the points of the mesh (m).
fn places<S: Space>(s: &Simulation<S>) -> Vec<S::Vector> {
    let mesh = mesh(s, 0);
    let both = mesh.points.iter().zip(&mesh.displacement);
    both.map(|(x, u)| *x + *u).collect()
}

/// Angle of the side that initially lay along x, up to whole turns.
fn angle<S: Space>(s: &Simulation<S>) -> f64 {
    let at = places(s);
    let along = at[4] - at[0];
    along[1].atan2(along[0])
}

fn largest_stress<S: Space>(s: &Simulation<S>) -> f64 {
    let mesh = mesh(s, 0);
    let stresses = mesh.stress.iter().flatten();
    stresses.fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Angular momentum about z through the origin (kg m^2/s), with lumped masses: a (D + 1)-th of each
/// element at its corners.
fn momentum<S: Space>(s: &Simulation<S>, density: f64) -> f64 {
    let system = s.state.systems.get(0).unwrap();
    let mesh = system.deformed_mesh().unwrap();
    let mut sum = 0.0;
    for element in mesh.elements.chunks_exact(S::D + 1) {
        let corners: Vec<S::Vector> = element.iter().map(|p| mesh.points[*p as usize]).collect();
        let volume = fretwork::elastic::element::Simplex::<S>::new(&corners).unwrap();
        let share = density * volume.volume / (S::D + 1) as f64;
        for p in element {
            let x = system.node_position(*p);
            let v = system.node_velocity(*p, system.velocity());
            sum += share * (x[0] * v[1] - x[1] * v[0]);
        }
    }
    sum
}

/// A stiff block rotates by a tenth of a radian per step: a quarter and a whole turn cause no
/// stress, with steps ten thousand times the time of a wave.
fn turns_without_stress<S: Space>(strain: Strain) {
    let material = Elasticity {
        young: 1e11,
        ..RUBBER
    };
    let (spin, step) = (1.0, 0.1);
    let turn = 2.0 * f64::atan(0.5 * spin * step);
    let mut s = spinning::<S>(strain, material, spin, [step, 0.5]);
    let start = momentum(&s, material.density);
    for steps in [16, 47] {
        go(&mut s, steps);
        let stress = largest_stress(&s) / material.young;
        let expected = s.state.steps as f64 * turn;
        let off = (angle(&s) - expected + PI).rem_euclid(2.0 * PI) - PI;
        println!(
            "{strain:?} {}D, {expected:.3} rad: stress {stress:e} E, angle off by {off:e}",
            S::D
        );
        assert!(stress < 1e-9, "{strain:?}: {stress:e}");
        assert!(off.abs() < 1e-8, "{strain:?}: {off:e}");
    }
    near(start, momentum(&s, material.density), 1e-8);
    closes(&s, 1e-8);
}

#[test]
fn a_block_turns_without_stress() {
    for strain in LARGE {
        turns_without_stress::<Dim2>(strain);
        turns_without_stress::<Dim3>(strain);
    }
}

/// A soft block stretched by its spin: angular momentum is conserved, and the energy loss of the
/// scheme decreases with the square of the step.
fn keeps_its_momentum<S: Space>(strain: Strain) {
    let (spin, time) = (40.0, 2.0 * PI / 40.0);
    let runs = [400, 800, 1600].map(|steps| {
        let mut s = spinning::<S>(strain, RUBBER, spin, [time / f64::from(steps), 0.5]);
        let start = momentum(&s, RUBBER.density);
        let (mut most, mut linearised) = (0.0f64, 0);
        for _ in 0..steps {
            go(&mut s, 1);
            most = most.max(s.state.energy.scheme.abs());
            linearised += s.state.systems.get(0).unwrap().linearisations();
        }
        near(start, momentum(&s, RUBBER.density), 1e-9);
        closes(&s, 1e-9);
        let share = most / s.state.energy.elastic.max(1e-3 * s.state.energy.kinetic);
        println!(
            "{strain:?} {}D, {steps} steps a turn: scheme {share:e}, {:.2} iterations a step, stress {:e} E",
            S::D,
            f64::from(linearised) / f64::from(steps),
            largest_stress(&s) / RUBBER.young
        );
        most
    });
    // The waves of the sudden start are resolved by the shorter steps alone.
    let orders = [runs[0] / runs[1], runs[1] / runs[2]].map(f64::log2);
    println!("orders {orders:?}");
    assert!(orders[1] > 1.7, "{strain:?}: {orders:?}");
}

#[test]
fn a_spinning_block_keeps_its_angular_momentum() {
    for strain in LARGE {
        keeps_its_momentum::<Dim2>(strain);
        keeps_its_momentum::<Dim3>(strain);
    }
}

/// Damping by stiffness removes the vibration that a sudden spin excites, and does not brake the
/// spin; damping by mass brakes it by (1 - alpha h/2)/(1 + alpha h/2) per step.
#[test]
fn damping_follows_the_rotation() {
    for strain in LARGE {
        for (mass, stiffness) in [(0.0, 2e-3), (5.0, 0.0)] {
            let mut s = scene::<Dim2>(&Sketch {
                bodies: floor::<Dim2>(),
                ..sketch(1e-3, 0.5)
            });
            let mesh = block::<Dim2>(&[even(0.0, 0.2, 4), even(5.0, 5.1, 2)]).unwrap();
            let mut spec = body(mesh, RUBBER, &[]);
            (spec.strain, spec.spin[2]) = (strain, 20.0);
            spec.damping = Rayleigh { mass, stiffness };
            add(&mut s, spec);
            let start = momentum(&s, RUBBER.density);
            go(&mut s, 400);
            let factor = (1.0 - 0.5e-3 * mass) / (1.0 + 0.5e-3 * mass);
            // The moment of a braking force at the middle of the step is that of the mean momentum
            // up to the square of the step.
            let tolerance = if mass > 0.0 { 1e-4 } else { 1e-8 };
            let expected = start * factor.powi(400);
            near(expected, momentum(&s, RUBBER.density), tolerance);
            closes(&s, 1e-9);
            let energy = &s.state.energy;
            println!(
                "{strain:?}: viscous {:e} of {:e} J",
                energy.viscous, energy.initial_kinetic
            );
            // A steady spin of a stretched body is strain without rate.
            let share = energy.viscous / energy.initial_kinetic;
            assert!(share > 0.0 && (mass > 0.0 || share < 1e-2), "{share:e}");
        }
    }
}

/// With steps far below and far above the time of a wave (3 ms across the block), and moduli from
/// jelly to far above steel, energy does not grow.
#[test]
fn any_step_and_modulus_is_stable() {
    for strain in LARGE {
        for young in [1e3, 1e6, 1e15] {
            for (step, theta) in [(1e-6, 0.5), (1e-3, 0.5), (0.03, 0.5), (0.03, 1.0)] {
                let material = Elasticity { young, ..RUBBER };
                let mut s = spinning::<Dim2>(strain, material, 5.0, [step, theta]);
                let start = s.state.energy.kinetic;
                let mut most = 0.0f64;
                for _ in 0..100 {
                    go(&mut s, 1);
                    let energy = &s.state.energy;
                    most = most.max((energy.kinetic + energy.elastic) / start - 1.0);
                }
                let off = s.state.energy.relative_residual();
                println!(
                    "{strain:?}, {young:e} Pa, {step} s, theta {theta}: energy grows by {most:e}, ledger {off:e}"
                );
                assert!(most < 1e-3, "{strain:?}: {most:e}");
                // The stress of a strain of 1e-13 has a relative round-off of some thousandths.
                let rounded = if young > 1e14 { 1e-3 } else { 1e-8 };
                assert!(off < rounded, "{strain:?}: {off:e}");
            }
        }
    }
}
