//! Identities: the energy ledger, friction from forces and from heat, action and reaction.

use super::Table;
use crate::scene;
use fretwork::energy::Energy;
use fretwork::geometry::space::Dim3;
use fretwork::record::friction_report::Friction;

pub fn all(table: &mut Table) {
    ledger(table);
    pulled(table);
    three_dimensions(table);
}

/// Bonds and friction under a moving lid, theta = 1/2, run and reported as by the program.
fn ledger(table: &mut Table) {
    let sets = ["output.frames=0", "output.figures=false"];
    let summary = scene::ran("verification/energy", &sets, |_| {});
    let found = &summary.found;
    let e = found.get::<Energy>().unwrap();
    let cycles = &found.get::<Friction>().unwrap().cycles;
    assert!(
        e.elastic > 0.0 && e.friction > 0.0,
        "bonds and friction are at work"
    );
    assert_eq!(cycles.len(), 2);
    let steps = found.number("solver.unconverged_steps").unwrap();
    table.compare("energy", "steps not converged", 0.0, steps, 0.0);
    let off = e.residual / e.external_work.abs();
    table.compare("energy", "residual over external work", 0.0, off, 1e-6);
    for c in cycles {
        let name = format!("cycle {}: mu from heat is mu from forces", c.cycle);
        let (forces, heat) = (c.energetic_coefficient, c.friction_from_dissipation);
        table.compare("energy", &name, forces, heat, 1e-9);
    }
}

/// A frictionless bond is pulled and sheared: without pressure there is no friction coefficient.
fn pulled(table: &mut Table) {
    let summary = scene::ran("verification/pulled_friction", &[], |_| {});
    let mu = summary.found.number("friction_coefficient").unwrap_or(0.0);
    table.compare(
        "pulled_friction",
        "friction coefficient under tension",
        0.0,
        mu,
        0.0,
    );
}

/// The shear cell: ledger, and the impulses on all bodies sum to zero.
fn three_dimensions(table: &mut Table) {
    let mut s = scene::case::<Dim3>("shear_cell_3d", &["time.end=0.07"]);
    let mut momentum = 0.0f64;
    while s.state.time < 0.07 {
        let before: Vec<_> = s.state.bodies.velocity.clone();
        s.step().unwrap_or_else(|e| panic!("{e}"));
        // Without gravity the free grains gain what the driven bodies lose.
        let driven = |b: usize| s.state.bodies.driven.iter().any(|d| d.body as usize == b);
        let gained: nalgebra::Vector3<f64> = (0..s.state.bodies.len())
            .filter(|b| !driven(*b))
            .map(|b| (s.state.bodies.velocity[b] - before[b]) * s.state.bodies.mass[b])
            .sum();
        let lost: nalgebra::Vector3<f64> = s.state.received.iter().map(|r| r.0).sum();
        let scale: f64 = s.state.received.iter().map(|r| r.0.norm()).sum::<f64>() + 1e-12;
        momentum = momentum.max((gained + lost).norm() / scale);
    }
    assert!(
        s.state.energy.friction > 0.0 && s.state.network.contacts.len() > 500,
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
        s.state.energy.relative_residual(),
        1e-9,
    );
}
