//! Limits of bodies in large strain: nearly incompressible, elements of very different sizes,
//! bodies on each other, and a body that tumbles on a floor.

use super::*;
use crate::extremes::bench::floor;
use fretwork::step::Simulation;

fn below<S: Space>() -> String {
    floor::<S>().replace("shapes:", "position: [0.0, -1.0], shapes:")
}

/// Deflection of a cantilever, 10 : 1, relative to that of Euler and Bernoulli with Timoshenko's
/// shear: linear elements lock as Poisson's ratio approaches 1/2.
fn deflection(poisson: f64, cells: usize) -> f64 {
    let (length, height, force) = (0.1, 0.01, 1e-3);
    let material = Elasticity { poisson, ..RUBBER };
    let mut s = scene::<Dim2>(&Sketch {
        bodies: below::<Dim2>(),
        ..sketch(100.0, 1.0)
    });
    let lines = [even(0.0, length, 10 * cells), even(0.0, height, cells)];
    let supports = [
        support("left", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support(
            "right",
            &[None, Some(Dof::Force(TimeFunction::Constant(force)))],
        ),
    ];
    let mut spec = body(block::<Dim2>(&lines).unwrap(), material, &supports);
    spec.strain = Strain::Corotational;
    add(&mut s, spec);
    go(&mut s, 4);
    closes(&s, 1e-6);
    let bending = 4.0 * force * (length / height).powi(3) / material.plane_strain();
    let shear = force * length / (5.0 / 6.0 * material.shear() * height);
    holder(&s, 0, "right", 1).displacement / (bending + shear)
}

#[test]
fn nearly_incompressible_elements_lock() {
    for poisson in [0.3, 0.49, 0.4999] {
        let shares = [4, 8].map(|cells| deflection(poisson, cells));
        println!("nu {poisson}: {shares:?} of the deflection with 4 and 8 cells over the height");
        assert!(shares[0] < shares[1] && shares[1] < 1.01, "{shares:?}");
        assert!(shares[0] > 0.3, "{shares:?}");
    }
}

/// A block with elements from 1 um to 1 cm is bent back and forth.
#[test]
fn elements_of_all_sizes_in_one_mesh() {
    for strain in LARGE {
        for (h, theta) in [(1e-7, 0.5), (1e-3, 0.5), (0.1, 1.0)] {
            let mut s = scene::<Dim2>(&Sketch {
                bodies: below::<Dim2>(),
                ..sketch(h, theta)
            });
            let lines = [graded(0.0, 0.05, 1e-6, 4.0), even(0.0, 0.01, 2)];
            let mut spec = body(block::<Dim2>(&lines).unwrap(), RUBBER, &[]);
            (spec.strain, spec.spin[2]) = (strain, 2.0);
            add(&mut s, spec);
            let (start, mut most) = (s.state.energy.kinetic, 0.0f64);
            for _ in 0..50 {
                go(&mut s, 1);
                most = most.max((s.state.energy.kinetic + s.state.energy.elastic) / start - 1.0);
            }
            let off = s.state.energy.relative_residual();
            println!("{strain:?}, {h} s, theta {theta}: energy grows by {most:e}, ledger {off:e}");
            assert!(most < 1e-3 && off < 1e-8, "{strain:?}: {most:e}, {off:e}");
        }
    }
}

/// A soft block is pressed into a wider one by a third of its height: holders and contacts carry
/// equal forces.
#[test]
fn a_block_is_pressed_into_another() {
    let side = 0.01;
    let mut s = scene::<Dim2>(&Sketch {
        bodies: below::<Dim2>(),
        mu: 0.3,
        solver: "tolerance: 1e-12, norm: Velocity, method: Newton,".to_owned(),
        detection: [5e-4, 5e-4],
        ..sketch(1.0, 1.0)
    });
    let low = [support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)])];
    let high = [support(
        "top",
        &[Some(Dof::Fixed), ramp(-0.33 * side, 10.0)],
    )];
    let wide = [even(-side, 2.0 * side, 12), even(0.0, side, 4)];
    let mut spec = body(block::<Dim2>(&wide).unwrap(), RUBBER, &low);
    (spec.strain, spec.touching) = (Strain::NeoHookean, Touching::Surface("top"));
    add(&mut s, spec);
    // The points lie on vertices of the surface below, up to round-off.
    let narrow = [even(0.0, side, 4), even(side, 2.0 * side, 4)];
    let mut spec = body(block::<Dim2>(&narrow).unwrap(), RUBBER, &high);
    (spec.strain, spec.touching) = (Strain::NeoHookean, Touching::Points("bottom"));
    spec.name = "upper";
    add(&mut s, spec);
    let mut most = [0; 2];
    for _ in 0..14 {
        go(&mut s, 1);
        for (k, most) in most.iter_mut().enumerate() {
            *most = (*most).max(s.state.systems.get(k).unwrap().linearisations());
        }
    }
    closes(&s, 1e-8);
    let force = -holder(&s, 1, "top", 1).force;
    let contacts = s.state.network.contacts.iter();
    let carried = contacts.map(|c| c.impulse[1].abs()).sum::<f64>() / s.options.scheme.h;
    println!("pressed: {force} N/m, up to {most:?} iterations");
    near(force, carried, 1e-6);
    near(force, holder(&s, 0, "bottom", 1).force, 1e-6);
    // The stiffness is between that of the upper block alone and a tenth of it.
    let alone = 0.33 * RUBBER.plane_strain() * side;
    assert!((0.1 * alone..alone).contains(&force), "{force} of {alone}");
}

/// The left, lower and right side of a block as one part.
fn with_skin(mesh: &Mesh<Dim2>) -> Mesh<Dim2> {
    let sides = ["left", "bottom", "right"].into_iter();
    let facets = sides.flat_map(|part| mesh.part(part).unwrap().to_vec());
    let points = facets
        .flat_map(|f| mesh.facet(f as usize).to_vec())
        .collect();
    let parts = [("skin".to_owned(), points)].into();
    let elements = mesh.elements().flatten().copied().collect();
    Mesh::new(mesh.points().to_vec(), elements, &parts).unwrap()
}

/// A spinning soft block falls on a rough floor and bounces: energy does not grow, and the ledger
/// closes. Two runs, the second on two threads, are bit-identical.
#[test]
fn a_block_tumbles_on_a_rough_floor() {
    for strain in LARGE {
        let ends = [false, true].map(|parallel| {
            let mut s = scene::<Dim2>(&Sketch {
                bodies: floor::<Dim2>(),
                gravity: 9.81,
                mu: 0.5,
                ..sketch(5e-4, 0.5)
            });
            s.options.solver.parallel = parallel;
            let mesh = block::<Dim2>(&[even(0.0, 0.1, 4), even(0.06, 0.16, 4)]).unwrap();
            let mut spec = body(with_skin(&mesh), RUBBER, &[]);
            (spec.strain, spec.touching) = (strain, Touching::Points("skin"));
            (spec.spin[2], spec.velocity[1]) = (-8.0, -1.0);
            add(&mut s, spec);
            let (start, mut most) = (s.state.energy.kinetic, 0.0f64);
            for _ in 0..600 {
                go(&mut s, 1);
                let e = &s.state.energy;
                most = most.max((e.kinetic + e.elastic + e.potential) / start - 1.0);
            }
            closes(&s, 1e-8);
            let e = &s.state.energy;
            println!(
                "{strain:?}: friction {:e}, impact {:e}, scheme {:e} of {start:e} J, most {most:e}",
                e.friction, e.impact, e.scheme
            );
            assert!(
                e.friction > 0.0 && e.impact > 0.0 && most < 1e-3,
                "{most:e}"
            );
            bits(&s)
        });
        assert!(ends[0] == ends[1]);
    }
}

fn bits(s: &Simulation<Dim2>) -> Vec<u64> {
    let mesh = mesh(s, 0);
    let moved = mesh.displacement.iter();
    moved
        .flat_map(|u| [u[0].to_bits(), u[1].to_bits()])
        .collect()
}
