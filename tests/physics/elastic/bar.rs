//! An elastic bar hits a rigid wall (the usual impact benchmark: E 210 GPa, rho 7800 kg/m^3, 1 m
//! long, 0.1 m/s): the wave that runs to its end and back carries a constant force, v sqrt(E rho)
//! per area, for 2 L/c, and leaves the bar with its speed reversed.

use super::*;
use crate::extremes::bench::floor;

const LENGTH: f64 = 1.0;
const WIDTH: f64 = 0.02;
const SPEED: f64 = 0.1;

/// The bar before its impact, without lateral strain: with nu = 0 it is one-dimensional.
fn falling(step: f64, theta: f64, cells: usize) -> Simulation<Dim2> {
    let mut s = scene::<Dim2>(&Sketch {
        bodies: floor::<Dim2>(),
        mu: 0.0,
        ..sketch(step, theta)
    });
    let gap = 1e-6;
    let across = even(0.0, WIDTH, 1);
    let mesh = block::<Dim2>(&[across, even(gap, gap + LENGTH, cells)]).unwrap();
    let material = Elasticity {
        poisson: 0.0,
        ..STEEL
    };
    let supports = [
        support("left", &[Some(Dof::Fixed), None]),
        support("right", &[Some(Dof::Fixed), None]),
    ];
    let mut spec = body(mesh, material, &supports);
    spec.touching = Touching::Points("bottom");
    spec.velocity[1] = -SPEED;
    add(&mut s, spec);
    s
}

/// Impulse on the wall in each step (N s/m), and the momentum at the end (kg m/s/m).
fn impact(s: &mut Simulation<Dim2>, time: f64) -> (Vec<f64>, f64) {
    let steps = (time / s.options.scheme.h).round() as usize;
    let impulses = (0..steps).map(|_| {
        go(s, 1);
        let contacts = s.state.network.contacts.iter();
        contacts.map(|c| c.impulse[1]).sum()
    });
    let impulses = impulses.collect();
    let system = s.state.systems.get(0).unwrap();
    let mass = STEEL.density * WIDTH * LENGTH;
    near(mass, system.mass(), 1e-12);
    (impulses, mass)
}

#[test]
fn a_bar_that_hits_a_wall_is_thrown_back_by_its_wave() {
    let wave = (STEEL.young / STEEL.density).sqrt();
    let force = WIDTH * SPEED * (STEEL.young * STEEL.density).sqrt();
    // The benchmark's bar has 3.14e-4 m^2: 1270.8 N.
    near(1270.8, force / WIDTH * 3.14e-4, 1e-4);
    let step = 1e-6;
    let mut s = falling(step, 0.5, 100);
    let (impulses, mass) = impact(&mut s, 6e-4);
    closes(&s, 1e-6);
    let touched: Vec<usize> = (0..impulses.len()).filter(|k| impulses[*k] > 0.0).collect();
    let (first, last) = (touched[0], touched[touched.len() - 1] + 1);
    near(2.0 * LENGTH / wave, (last - first) as f64 * step, 0.02);
    let quarter = (last - first) / 4;
    let middle = &impulses[first + quarter..last - quarter];
    near(
        force,
        middle.iter().sum::<f64>() / (middle.len() as f64 * step),
        0.02,
    );
    let after = impulses.iter().sum::<f64>() / mass - SPEED;
    near(SPEED, after, 0.02);
    // The energy that the impact of the points at its end dissipates vanishes with refinement of
    // the mesh.
    let energy = &s.state.energy;
    let taken = 1.0 - (energy.kinetic + energy.elastic) / (0.5 * mass * SPEED * SPEED);
    assert!((0.0..0.01).contains(&taken), "{taken:e}");
}

/// With steps far above and far below the time in which a wave crosses an element, the solution
/// does not grow at theta from 1/2 to 1.
#[test]
fn any_step_is_stable() {
    for (step, theta) in [(1e-3, 0.5), (1e-3, 1.0), (1e-5, 0.5), (1e-8, 0.5)] {
        let mut s = falling(step, theta, 20);
        let start = s.state.energy.kinetic;
        go(&mut s, 100);
        let energy = &s.state.energy;
        let now = energy.kinetic + energy.elastic;
        assert!(now <= start * (1.0 + 1e-9), "{step}: {now} of {start}");
        closes(&s, 1e-9);
    }
}
