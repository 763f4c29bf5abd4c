//! Identities: the energy ledger, friction from forces and from heat, action and reaction.

use super::{Table, plane};
use fretwork::geometry::space::Solid;
use fretwork::laws::SearchPath;
use fretwork::scene::load;
use fretwork::step::Simulation;
use std::path::Path;

pub fn all(table: &mut Table) {
    ledger(table);
    three_dimensions(table);
}

/// Bonds and friction under a moving lid, theta = 1/2.
fn ledger(table: &mut Table) {
    let mut s = plane("energy", &["solver.tolerance=1e-9"]);
    let top = s
        .bodies
        .driven
        .iter()
        .position(|d| d.name == "top")
        .unwrap();
    let (mut pull, mut pressure_path, h) = (0.0, 0.0, s.scheme.h);
    let mut before = 0.0;
    while s.time < 0.1 - 0.5 * h {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let v = s.bodies.velocity[s.bodies.driven[top].body as usize].x;
        let slide = 0.5 * h * (before + v);
        before = v;
        pull -= s.received[top].0.x / h * slide;
        pressure_path += s.received[top].0.y / h * slide.abs();
    }
    let e = &s.energy;
    assert!(
        e.elastic > 0.0 && e.friction > 0.0,
        "bonds and friction are at work"
    );
    table.compare(
        "energy",
        "residual over external work",
        0.0,
        e.residual / e.external_work.abs(),
        1e-6,
    );
    // The lid's inertia along its motion is no friction: it is imposed, so its work is booked apart.
    let held = e.kinetic + e.potential + e.elastic - e.initial_kinetic;
    let heat = e.dissipated() + held - (e.external_work - pull);
    let tolerance = (e.residual.abs() + 1e-12 * e.scale) / pressure_path.abs();
    table.compare(
        "energy",
        "friction, forces less heat",
        0.0,
        (pull - heat) / pressure_path,
        tolerance.max(1e-12),
    );
}

/// The shear cell: ledger, and the impulses on all bodies sum to zero.
fn three_dimensions(table: &mut Table) {
    let file = format!("{}/cases/shear_cell_3d.ron", env!("CARGO_MANIFEST_DIR"));
    let sets = [
        "time.end=0.07".to_owned(),
        "solver.correction=0.0".to_owned(),
    ];
    let loaded = load(Path::new(&file), &sets).unwrap_or_else(|e| panic!("{e}"));
    let mut s: Simulation<Solid> = loaded
        .build_in(&SearchPath::new(&[]))
        .unwrap_or_else(|e| panic!("{e}"))
        .simulation;
    let mut momentum = 0.0f64;
    while s.time < 0.07 {
        let before: Vec<_> = s.bodies.velocity.clone();
        s.step().unwrap_or_else(|e| panic!("{e}"));
        // What the free grains gained is what the driven bodies lost, gravity being off.
        let driven = |b: usize| s.bodies.driven.iter().any(|d| d.body as usize == b);
        let gained: nalgebra::Vector3<f64> = (0..s.bodies.len())
            .filter(|b| !driven(*b))
            .map(|b| (s.bodies.velocity[b] - before[b]) * s.bodies.mass[b])
            .sum();
        let lost: nalgebra::Vector3<f64> = s.received.iter().map(|r| r.0).sum();
        let scale: f64 = s.received.iter().map(|r| r.0.norm()).sum::<f64>() + 1e-12;
        momentum = momentum.max((gained + lost).norm() / scale);
    }
    assert!(
        s.energy.friction > 0.0 && s.network.contacts.len() > 500,
        "the cell is under load"
    );
    table.compare(
        "shear_cell_3d",
        "momentum out of balance",
        0.0,
        momentum,
        1e-9,
    );
    table.compare(
        "shear_cell_3d",
        "residual over largest energy",
        0.0,
        s.energy.relative_residual(),
        1e-9,
    );
}
