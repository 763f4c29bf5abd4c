//! Laws that resist rotation: moments of contacts act on the frame of a grain.

use super::*;
use fretwork::solve::local::solver::Method;

/// Steps by a method that measures its own error, which is near that of the step.
fn advance<S: Space>(s: &mut Simulation<S>, steps: usize) {
    for _ in 0..steps {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.solver.error < 1e-6, "{:?}", report.solver);
    }
}

/// A square on a slope tips about its lower corner, against a rolling friction length l, if
/// (a/2)(sin phi - cos phi) > l cos phi. Its angular acceleration is the difference of the moments
/// over its moment of inertia about the corner, 2 M a^2/3.
#[test]
fn rolling_friction_holds_a_block_until_it_tips() {
    let (side, length, time) = (0.02, 0.002, 0.02);
    for young in [1e8, 1e10] {
        for (tan, tips) in [(1.15f64, false), (1.25, true), (1.4, true)] {
            let (sin, cos) = (tan.atan().sin(), tan.atan().cos());
            let case = Soft {
                step: 1e-4,
                theta: 1.0,
                young,
                elements: 2,
                damping: 1e-5,
                mu: 3.0,
                contact: (
                    "rolling-friction",
                    format!(", \"rolling\": {length:?}, \"rolling_factor\": 0.0"),
                ),
                gravity: vec![G * sin, -G * cos],
                bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], ""),
                grains: square("soft", [0.0, 0.01], side, 0.0, ""),
                tolerance: 1e-8,
                ..Soft::default()
            };
            let mut s = case.build::<Dim2>();
            // Sweeps do not always converge with a bound that depends on another unknown.
            s.options.solver.method = Method::Apgd;
            advance(&mut s, (time / 1e-4) as usize);
            let found = -s.state.systems.get(0).unwrap().velocity()[2] / time;
            let arm = 0.5 * side * (sin - cos) - length * cos;
            let expected = if tips {
                G * arm / (2.0 / 3.0 * side * side)
            } else {
                0.0
            };
            println!("E {young:e}, tan {tan}: {found} of {expected} rad/s^2");
            // The direction of the weight relative to the block changes by up to a tenth of its arm
            // over the time.
            assert!(
                (found - expected).abs() < 0.1 * expected + 0.05,
                "{young:e} {tan}: {found} {expected}"
            );
            closes(&s, 1e-9);
        }
    }
}

/// A cube that spins on a plane without friction, except for a spinning friction length l, loses
/// the angular momentum l int P dt, where the force P of the plane is the weight plus the force
/// that lifts the cube; then it stops.
fn spinning_cube(method: Method) -> Simulation<Dim3> {
    let mut s = Soft {
        step: 2e-4,
        theta: 0.5,
        young: 1e7,
        elements: 1,
        damping: 1e-5,
        mu: 0.0,
        contact: (
            "rolling-friction",
            ", \"spinning\": 0.001, \"rolling_factor\": 0.0".to_owned(),
        ),
        gravity: down(3),
        bodies: wall("floor", &[0.0, 0.0, 1.0], &[0.0, 0.0, 0.0], ""),
        grains: cuboid(
            "soft",
            [0.0, 0.0, 0.01],
            [0.02; 3],
            "spin: [0.0, 0.0, 20.0]",
        ),
        tolerance: 1e-11,
        ..Soft::default()
    }
    .build::<Dim3>();
    s.options.solver.method = method;
    s
}

#[test]
fn spinning_friction_takes_angular_momentum() {
    let mut s = spinning_cube(Method::Auto);
    let ([_, _, start], mass) = (
        <[f64; 3]>::from(momenta(&s, 0).1),
        s.state.systems.get(0).unwrap().mass(),
    );
    go(&mut s, 250);
    let lost = start - momenta(&s, 0).1.z;
    let pressed = mass * (G * s.state.time + velocity_of(&s, 0).z);
    println!("lost {lost:e} of {:e} kg m^2/s", 1e-3 * pressed);
    near(1e-3 * pressed, lost, 1e-6);
    closes(&s, 1e-9);
    go(&mut s, 1750);
    let spin = s.state.systems.get(0).unwrap().velocity()[5];
    assert!(spin.abs() < 1e-6, "{spin}");
    closes(&s, 1e-9);
}

/// A block bonded to a wall by its side, under its weight, at rest.
fn cantilever(method: Method, tolerance: f64, steps: usize) -> Simulation<Dim2> {
    let mut s = Soft {
        step: 1e-3,
        theta: 1.0,
        young: 1e13,
        elements: 1,
        gravity: down(2),
        interface: "cohesion: \"parallel-bond\", bonds: Start, bonds_within: 1e-5,",
        parameters: ", cohesion: {\"k_n\": 1e8, \"k_t\": 1e8, \"sigma_c\": 1e9, \"tau_c\": 1e9}"
            .to_owned(),
        bodies: wall("wall", &[1.0, 0.0], &[0.0, 0.0], ""),
        grains: square("soft", [0.01, 0.0], 0.02, 0.0, ""),
        mu: 0.0,
        tolerance,
        ..Soft::default()
    }
    .build::<Dim2>();
    s.options.solver.method = method;
    advance(&mut s, steps);
    s
}

/// Bonds in tension alone let the block rotate about its lower edge by theta: moments of normal
/// forces k_n A_k theta y_k and of bending k_n (A_k^3/12) theta carry M g a/2.
#[test]
fn bending_of_bonds_carries_a_cantilever() {
    let s = cantilever(Method::Auto, 1e-11, 400);
    let h = s.options.scheme.h;
    let (mut stiffness, mut moments) = (0.0, Vec::new());
    let network = &s.state.network;
    for contact in &network.contacts {
        let bond = network.bond(contact).unwrap();
        let y = place_of(&s, 0).y + contact.arms[0].y + 0.01;
        let bending = 1e8 * bond.area.powi(3) / 12.0;
        stiffness += 1e8 * bond.area * y * y + bending;
        moments.push((contact.moment[0] / h, bending));
    }
    let weight = s.state.systems.get(0).unwrap().mass() * G;
    let turned = weight * 0.01 / stiffness;
    println!(
        "{} bonds, turned by {turned:e} rad, moments {moments:?}",
        moments.len()
    );
    for (found, bending) in moments {
        near(bending * turned, found.abs(), 2e-3);
    }
    closes(&s, 1e-9);
}

/// Sweeps, gradients and methods with matrices give equal results where moments act on grains.
#[test]
fn methods_agree_on_moments() {
    let angle = |method| {
        cantilever(method, if method == Method::Apgd { 1e-8 } else { 1e-10 }, 4)
            .state
            .systems
            .get(0)
            .unwrap()
            .velocity()
            .to_vec()
    };
    let expected = angle(Method::Nlgs);
    for method in [
        Method::Anderson,
        Method::Newton,
        Method::Interior,
        Method::Apgd,
    ] {
        let found = angle(method);
        let scale = expected.iter().take(3).fold(0.0f64, |m, v| m.max(v.abs()));
        for (a, b) in found.iter().zip(&expected).take(3) {
            assert!(
                (a - b).abs() < 1e-5 * scale,
                "{method:?}: {found:?} {expected:?}"
            );
        }
    }
    let spin = |method| {
        let mut s = spinning_cube(method);
        s.options.solver.tolerance = 1e-8;
        advance(&mut s, 30);
        s.state.systems.get(0).unwrap().velocity()[5]
    };
    let expected = spin(Method::Nlgs);
    for method in [Method::Anderson, Method::Apgd] {
        near(expected, spin(method), 1e-7);
    }
}

/// A spinning cube on a deformable block of finite elements, in small and in large strain: normals
/// deviate from the vertical by an angle that decreases with the modulus.
#[test]
fn spinning_friction_acts_between_two_that_deform() {
    for (strain, young) in [
        ("Small", 1e7),
        ("Small", 1e9),
        ("NeoHookean", 1e7),
        ("NeoHookean", 1e9),
    ] {
        let mut s = Soft {
            step: 2e-4,
            theta: 0.5,
            young,
            elements: 1,
            damping: 1e-5,
            mu: 0.0,
            contact: (
                "rolling-friction",
                ", \"spinning\": 0.001, \"rolling_factor\": 0.0".to_owned(),
            ),
            gravity: down(3),
            bodies: wall("far", &[0.0, 0.0, 1.0], &[0.0, 0.0, -1.0], ""),
            grains: cuboid(
                "soft",
                [0.0, 0.0, 0.01],
                [0.02; 3],
                "spin: [0.0, 0.0, 20.0]",
            ),
            more: format!(
                "elastic: [(name: \"block\", material: \"soft\", strain: {strain}, damping: (mass: 0.0, stiffness: 1e-4), \
                 mesh: Block(x: (from: -0.03, to: 0.03, size: 0.02), y: (from: -0.03, to: 0.03, size: 0.02), \
                 z: (from: -0.02, to: 0.0, size: 0.02)), touches: Surface(\"top\"), \
                 supports: [(part: \"bottom\", x: Fixed, y: Fixed, z: Fixed)])],"
            ),
            tolerance: 1e-11,
            ..Soft::default()
        }
        .build::<Dim3>();
        let is_grain = |k: &usize| s.state.systems.get(*k).unwrap().is_grain();
        let grain = (0..2).find(is_grain).unwrap();
        let start = momenta(&s, grain).1.z;
        go(&mut s, 250);
        let lost = start - momenta(&s, grain).1.z;
        let mass = s.state.systems.get(grain).unwrap().mass();
        let pressed = mass * (G * s.state.time + velocity_of(&s, grain).z);
        println!(
            "{strain}, {young:e} Pa: lost {:e} of l int N dt",
            lost / (1e-3 * pressed)
        );
        near(1e-3 * pressed, lost, 1e3 / young);
        closes(&s, 1e-9);
    }
}
