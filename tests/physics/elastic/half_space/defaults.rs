//! Hertz's pressure, cell by cell, in cases with default settings of the solver, or with some of
//! them set.

use super::*;
use crate::scene;
use fretwork::solve::local::solver::Method;

/// E* of two bodies of `contact_steel` (Pa).
const MODULUS: f64 = 0.5 * 209.92e9 / (1.0 - 0.28 * 0.28);

/// A cylinder of R 40 mm under 200 N/mm, without a ramp, with cells of 20 um; the arguments give
/// further fields of the case, its mass (kg/m) and its drives.
fn pressed(more: &str, mass: f64, dofs: &str) -> Simulation<Dim2> {
    let cells = "material: \"steel\", x: (from: -6e-4, to: 6e-4, size: 2e-5), depth: 1e-2";
    let text = format!(
        "(name: \"cylinder\", dimension: 2, time: (step: 2.5e-4, end: 0.1, theta: 1), materials: {{\"steel\": \"contact_steel\"}},
          interfaces: [(name: \"c\", between: (\"steel\", \"steel\"), contact: \"coulomb\", parameters: (contact: {{\"mu\": 0.8}}))], {more}
          half_spaces: [(name: \"flat\", {cells}, touches: Surface),
            (name: \"cylinder\", {cells}, side: Above, profile: Summit(x: 40e-3), mass: {mass}, dofs: ({dofs}), touches: Points)])"
    );
    scene::text::<Dim2>(&text)
}

/// Largest difference of a cell's pressure from Hertz's ellipse about the centre of pressure within
/// 0.9 a, over p0.
fn off(s: &Simulation<Dim2>, (load, radius, size): (f64, f64, f64)) -> f64 {
    let a = (4.0 * load * radius / (PI * MODULUS)).sqrt();
    let p0 = 2.0 * load / (PI * a);
    let found = tractions(s, size);
    let centre = -mean(&found, 1, |x| x.x);
    let inner = found.iter().filter(|t| (t.at.x - centre).abs() < 0.9 * a);
    assert!(
        inner.clone().count() as f64 > 1.7 * a / size,
        "cells without a load"
    );
    let difference = |t: &Traction<nalgebra::Vector2<f64>>| {
        let x = (t.at.x - centre) / a;
        (-t.on.y / p0 - (1.0 - x * x).sqrt()).abs()
    };
    inner.map(difference).fold(0.0, f64::max)
}

const LINE: (f64, f64, f64) = (2e5, 40e-3, 2e-5);
const STILL: &str = "y: Force(-2e5)";
const TO_AND_FRO: &str = "x: Displacement(Sine(amplitude: 20e-6, frequency: 20)), y: Force(-2e5)";

/// Without contacts the load would move a light body at metres per second. Relative to that
/// velocity, residuals that change pressures of single cells by half are negligible.
#[test]
fn single_cells_have_the_pressure_of_hertz() {
    for (more, mass) in [
        ("", 10.0),
        ("", 0.1),
        ("solver: (method: Newton),", 10.0),
        ("solver: (method: Newton, norm: Velocity),", 0.1),
        ("solver: (norm: Velocity),", 10.0),
        ("solver: (method: Anderson, max_iterations: 100000),", 10.0),
        (
            "solver: (method: Newton), detection: (alert: 1e-5, skin: 1e-4),",
            10.0,
        ),
    ] {
        let mut s = pressed(more, mass, STILL);
        go(&mut s, 20);
        let off = off(&s, LINE);
        println!("{more} {mass} kg: {off:.4} of p0");
        assert!(off < 0.01, "{more} {mass}: {off}");
    }
}

/// Default cells are fine enough at the end of two cycles of gross slip.
#[test]
fn cells_have_it_after_cycles_too() {
    for more in ["", "solver: (method: Newton),"] {
        let mut s = pressed(more, 10.0, TO_AND_FRO);
        go(&mut s, 400);
        let off = off(&s, LINE);
        println!("{more}: {off:.4} of p0");
        assert!(off < 0.01, "{more}: {off}");
    }
}

/// A very large tolerance leaves pressures wrong, but no cell without a contact: a point that is
/// pressed behind the surface still touches.
#[test]
fn a_loose_tolerance_loses_no_contact() {
    for method in [Method::Newton, Method::Auto] {
        let mut s = pressed("", 10.0, TO_AND_FRO);
        s.options.solver.method = method;
        s.options.solver.tolerance = 0.03;
        go(&mut s, 200);
        let load: f64 = -tractions(&s, 2e-5)
            .iter()
            .map(|t| t.on.y * 2e-5)
            .sum::<f64>();
        let off = off(&s, LINE);
        println!("{method:?}: load {load:e}, {off:.3} of p0");
        assert!(off < 1.0, "{off}");
    }
}

/// A sphere of R 50 mm under 99.52 N with default settings and 5 cells over a.
#[test]
fn a_sphere_has_it_at_defaults() {
    let a = (0.75 * 99.52 * 0.05 / MODULUS).cbrt();
    let size = a / 5.0;
    let cells = format!(
        "material: \"steel\", x: (from: {0}, to: {1}, size: {size}), y: (from: {0}, to: {1}, size: {size})",
        -7.0 * size,
        7.0 * size
    );
    let text = format!(
        "(name: \"sphere\", dimension: 3, time: (step: 6.25e-4, end: 0.1, theta: 1), materials: {{\"steel\": \"contact_steel\"}},
          interfaces: [(name: \"c\", between: (\"steel\", \"steel\"), contact: \"coulomb\", parameters: (contact: {{\"mu\": 0.6}}))],
          half_spaces: [(name: \"flat\", {cells}, touches: Surface),
            (name: \"sphere\", {cells}, side: Above, profile: Summit(x: 0.05, y: 0.05), mass: 0.01, dofs: (z: Force(-99.52)), touches: Points)])"
    );
    let mut s = scene::text::<Dim3>(&text);
    go(&mut s, 10);
    let found = tractions(&s, size * size);
    let p0 = 1.5 * 99.52 / (PI * a * a);
    // Cells at the edge are only partly in contact.
    let inner = found.iter().filter(|t| t.at.xy().norm() < 0.8 * a);
    let differ =
        inner.map(|t| (-t.on.z / p0 - (1.0 - (t.at.xy().norm() / a).powi(2)).sqrt()).abs());
    let off = differ.fold(0.0, f64::max);
    println!("{off:.4} of p0");
    assert!(off < 0.015, "{off}");
}
