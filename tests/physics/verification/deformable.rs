//! Deformable bodies with large strain and rotation.

use super::{Table, plane, until};
use std::f64::consts::PI;

/// Young's modulus (Pa), Poisson's ratio and density (kg/m^3) of the rubber.
const RUBBER: [f64; 3] = [1e6, 0.4, 1000.0];

pub fn all(table: &mut Table) {
    rubber_block(table);
    spinning_block(table);
}

/// The first Piola-Kirchhoff stress of the neo-Hookean material along a principal axis (J. Bonet
/// and R. D. Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", 2nd edition,
/// section 6.4.3) (Pa).
fn nominal(stretch: f64, volume: f64) -> f64 {
    let [young, poisson, _] = RUBBER;
    let shear = 0.5 * young / (1.0 + poisson);
    let lambda = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
    shear * (stretch - 1.0 / stretch) + lambda * volume.ln() / stretch
}

fn rubber_block(table: &mut Table) {
    let stretch = 0.7;
    let (mut low, mut high) = (1.0f64, 2.0f64);
    for _ in 0..100 {
        let across = 0.5 * (low + high);
        if nominal(across, stretch * across) > 0.0 {
            high = across;
        } else {
            low = across;
        }
    }
    let expected = -nominal(stretch, stretch * low) * 0.02;
    let mut s = plane("rubber_block", &[]);
    until(&mut s, 0.25, |_| ());
    let contacts = s.state.network.contacts.iter();
    let force = contacts.map(|c| c.impulse[1].abs()).sum::<f64>() / s.options.scheme.h;
    table.compare(
        "rubber_block",
        "force of the lid (N/m)",
        expected,
        force,
        1e-6,
    );
    let holders = s.state.systems.get(0).unwrap().holders();
    let bottom = holders.iter().find(|h| h.part == "bottom").unwrap().force;
    table.compare(
        "rubber_block",
        "force of the floor (N/m)",
        expected,
        bottom,
        1e-6,
    );
    let residual = s.state.energy.relative_residual();
    table.compare(
        "rubber_block",
        "residual of the ledger",
        0.0,
        residual,
        1e-9,
    );
}

fn spinning_block(table: &mut Table) {
    let mut s = plane("spinning_block", &[]);
    let (spin, h) = (10.0, s.options.scheme.h);
    let (mut stress, mut middle) = (0.0, 0);
    let start = s.state.energy.kinetic;
    until(&mut s, 0.628, |s| {
        let mesh = s.state.systems.get(0).unwrap().deformed_mesh().unwrap();
        middle = (0..mesh.points.len())
            .find(|p| mesh.points[*p].norm() < 1e-12)
            .unwrap_or_default();
        let around = mesh.elements.chunks_exact(3).zip(&mesh.stress);
        let around = around.filter(|(points, _)| points.contains(&(middle as u32)));
        let along: Vec<f64> = around.map(|(_, s)| s[0] + s[1]).collect();
        stress += along.iter().sum::<f64>() / along.len() as f64;
    });
    let steps = s.state.steps as f64;
    let mesh = s.state.systems.get(0).unwrap().deformed_mesh().unwrap();
    let at = |x: f64, y: f64| {
        let near = |p: &usize| (mesh.points[*p][0] - x).hypot(mesh.points[*p][1] - y) < 1e-9;
        let p = (0..mesh.points.len()).find(near).unwrap();
        mesh.points[p] + mesh.displacement[p]
    };
    let along = at(0.1, 0.0) - at(-0.1, 0.0);
    let turned = along[1].atan2(along[0]).rem_euclid(2.0 * PI);
    let expected = 2.0 * f64::atan(0.5 * spin * h) * steps;
    table.compare("spinning_block", "angle (rad)", expected, turned, 1e-3);
    // The body is stretched at once and oscillates about the stress of steady spin, which is the
    // mean over the turn.
    let steady = RUBBER[2] * spin * spin * 0.2 * 0.2 / 8.0;
    table.compare(
        "spinning_block",
        "mean stress in the middle (Pa)",
        steady,
        stress / steps,
        0.1,
    );
    let energy = &s.state.energy;
    let kept = (energy.kinetic + energy.elastic) / start;
    table.compare(
        "spinning_block",
        "energy at the end over that at the start",
        1.0,
        kept,
        1e-6,
    );
    let residual = energy.relative_residual();
    table.compare(
        "spinning_block",
        "residual of the ledger",
        0.0,
        residual,
        1e-9,
    );
}
