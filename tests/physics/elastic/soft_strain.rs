//! Error of grains in small strain under large load: the force of a disk between two plates is
//! compared with that of an equal mesh of a neo-Hookean material; the two agree to first order.

use super::*;
use fretwork::elastic::grain::mesh::{disk, polygon};
use fretwork::elastic::{ElasticGrain, ElasticGrainSpec, GrainShape};
use nalgebra::Vector2;
use std::collections::BTreeMap;
use std::sync::Arc;

const RADIUS: f64 = 0.01;
const ELEMENTS: usize = 6;
const STEPS: usize = 20;

/// The mesh of a disk of unit radius.
fn unit() -> Mesh<Dim2> {
    let corners = disk::<Dim2>(ELEMENTS);
    polygon::<Dim2>(&corners, &Vector2::zeros(), 1.0 / ELEMENTS as f64).unwrap()
}

/// Plates that close on a disk at the origin by a fraction of its radius over twenty steps, with
/// theta 1.
fn plates(share: f64) -> Simulation<Dim2> {
    let (gap, speed) = (RADIUS, share * RADIUS / (1e-3 * STEPS as f64));
    let bodies = format!(
        "(name: \"low\", material: \"m0\", shapes: [HalfSpace(normal: [0.0, 1.0])], position: [0.0, -{gap:?}]),
         (name: \"high\", material: \"m0\", shapes: [HalfSpace(normal: [0.0, -1.0])], position: [0.0, {gap:?}],
          dofs: (x: Fixed, y: Velocity(Constant(-{speed:?})), rz: Fixed)),"
    );
    scene::<Dim2>(&Sketch {
        bodies,
        mu: 0.0,
        ..sketch(1e-3, 1.0)
    })
}

/// Force on the upper plate at the end (N/m).
fn force(s: &Simulation<Dim2>) -> f64 {
    let contacts = s.state.network.contacts.iter();
    let sum: f64 = contacts.map(|c| c.impulse.dot(&c.normal)).sum();
    0.5 * sum / 1e-3
}

/// Force, largest strain, and energy-weighted strain of the grain.
fn grain(share: f64) -> (f64, f64, f64) {
    let mut s = plates(share);
    let system = ElasticGrain::<Dim2>::new(ElasticGrainSpec {
        name: "grain".to_owned(),
        shape: Arc::new(GrainShape::new(unit(), RUBBER.poisson).unwrap()),
        size: RADIUS,
        radius: RADIUS,
        material: RUBBER,
        damping: Rayleigh::default(),
        surface_material: 0,
        position: Vector2::zeros(),
        rotation: 0.0,
        velocity: Vector2::zeros(),
        spin: nalgebra::Vector1::zeros(),
        displacement: Default::default(),
    });
    s.add_system(Box::new(system.unwrap()));
    go(&mut s, STEPS);
    let [strain, _] = s.state.systems.get(0).unwrap().small_strain().unwrap();
    // Strain energy density over E is half of the square of the strain.
    let mesh = mesh(&s, 0);
    let (mut sum, mut all) = (0.0, 0.0);
    let shear = RUBBER.shear();
    let lambda = RUBBER.lambda();
    for (element, stress) in mesh.elements.chunks_exact(3).zip(&mesh.stress) {
        let corners: Vec<_> = element.iter().map(|p| mesh.points[*p as usize]).collect();
        let volume = fretwork::elastic::element::Simplex::<Dim2>::new(&corners)
            .unwrap()
            .volume;
        let [x, y, _, _, _, xy] = *stress;
        let trace = (x + y) / (2.0 * (lambda + shear));
        let e = [x, y].map(|s| (s - lambda * trace) / (2.0 * shear));
        let exy = xy / (2.0 * shear);
        let middle = 0.5 * (e[0] + e[1]);
        let radius = (0.25 * (e[0] - e[1]).powi(2) + exy * exy).sqrt();
        let largest = middle.abs() + radius;
        let energy = 0.5 * volume * (x * e[0] + y * e[1] + 2.0 * xy * exy);
        sum += energy * largest;
        all += energy;
    }
    (force(&s), strain, sum / all)
}

/// Force of an equal disk of a neo-Hookean material.
fn neo_hookean(share: f64) -> f64 {
    let mut s = plates(share);
    let unit = unit();
    let points = unit.points().iter().map(|x| x * RADIUS).collect();
    let elements = unit.elements().flatten().copied().collect();
    // A chain has two ends, here at the side that touches no plate.
    let aside = |f: &usize| {
        !unit
            .facet(*f)
            .iter()
            .all(|p| unit.points()[*p as usize].x > 0.98)
    };
    let boundary = (0..unit.facets()).filter(aside);
    let boundary = boundary.flat_map(|f| unit.facet(f).iter().copied());
    let parts = BTreeMap::from([("surface".to_owned(), boundary.collect())]);
    let mut spec = body(Mesh::new(points, elements, &parts).unwrap(), RUBBER, &[]);
    spec.strain = Strain::NeoHookean;
    spec.touching = Touching::Points("surface");
    add(&mut s, spec);
    go(&mut s, STEPS);
    force(&s)
}

/// The warning of deformable grains begins at a strain of a tenth: the error of their forces is
/// then less than 1.5 per cent.
#[test]
fn forces_of_small_strain_hold_up_to_a_strain_of_a_tenth() {
    println!("approach/R, force (N/m), of the neo-Hookean disk, off by, largest strain, by energy");
    for (share, bound) in [(0.01, 0.005), (0.1, 0.015), (0.2, 0.04)] {
        let (force, strain, mean) = grain(share);
        let large = neo_hookean(share);
        let off = force / large - 1.0;
        println!("{share} {force:.3} {large:.3} {off:.4} {strain:.4} {mean:.4}");
        assert!(off.abs() < bound, "{share}: {off}");
        assert!((strain < 0.1) == (share <= 0.1), "{share}: {strain}");
    }
}
