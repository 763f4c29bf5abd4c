//! A cantilever under a force at its end, in plane strain: Euler and Bernoulli's deflection F
//! L^3/(3 E' I), E' = E/(1 - nu^2), and Timoshenko's shear, F L/(kappa G A).

use super::*;

/// Deflection at the end (m) with a number of cells over the height, at rest under a force of 1
/// kN/m.
fn deflection(cells: usize) -> f64 {
    let (length, height, force) = (0.5, 0.05, 1e3);
    let mut s = scene::<Dim2>(&Sketch {
        bodies: crate::extremes::bench::floor::<Dim2>(),
        ..sketch(1.0, 1.0)
    });
    let mesh = block::<Dim2>(&[
        even(0.0, length, 10 * cells),
        even(1.0, 1.0 + height, cells),
    ])
    .unwrap();
    let supports = [
        support("left", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support(
            "right",
            &[None, Some(Dof::Force(TimeFunction::Constant(-force)))],
        ),
    ];
    add(&mut s, body(mesh, STEEL, &supports));
    go(&mut s, 8);
    closes(&s, 1e-9);
    let mesh = mesh_of_tip(&s, length);
    let inertia = height.powi(3) / 12.0;
    let bending = force * length.powi(3) / (3.0 * STEEL.plane_strain() * inertia);
    let shear = force * length / (5.0 / 6.0 * STEEL.shear() * height);
    -mesh / (bending + shear)
}

/// Mean displacement of the end along y (m).
fn mesh_of_tip(s: &Simulation<Dim2>, length: f64) -> f64 {
    let mesh = mesh(s, 0);
    let tip: Vec<f64> = mesh
        .points
        .iter()
        .zip(&mesh.displacement)
        .filter(|(x, _)| x[0] > length * (1.0 - 1e-9))
        .map(|(_, u)| u[1])
        .collect();
    tip.iter().sum::<f64>() / tip.len() as f64
}

#[test]
fn a_cantilever_bends_by_its_closed_form() {
    let ratios = [4, 8, 16].map(deflection);
    // The error of elements of constant strain decreases with about the square of their size, since
    // the corners of the clamped end have singular stresses.
    let order = ((ratios[1] - ratios[0]) / (ratios[2] - ratios[1])).log2();
    assert!((1.6..2.3).contains(&order), "{ratios:?}: {order}");
    let extrapolated = ratios[2] + (ratios[2] - ratios[1]) / 3.0;
    near(1.0, extrapolated, 0.01);
}
