//! A rigid cylinder pressed on an elastic block, and moved along it: Hertz's line contact, and Cattaneo and Mindlin's stick zone.
//!
//! K. L. Johnson, "Contact Mechanics" (1985), sections 4.2 and 7.2: with E* = E/(1 - nu^2) and P the load per length,
//!
//! ```text
//! a = 2 sqrt(P R/(pi E*))        p(x) = p0 sqrt(1 - x^2/a^2), p0 = 2 P/(pi a)
//! c/a = sqrt(1 - Q/(mu P))       q(x) = mu p(x) - mu p0 (c/a) sqrt(1 - x^2/c^2) where |x| < c
//! ```

use super::*;

const RADIUS: f64 = 0.05;
const A: f64 = 1e-3;
const MU: f64 = 0.5;

/// Load per length for the half-width A (N/m).
fn load() -> f64 {
    std::f64::consts::PI * STEEL.plane_strain() * A * A / (4.0 * RADIUS)
}

/// The cylinder at rest under its load, and the tangential force along x as a share of mu P, with `n` elements over the half-width.
/// The solution is static: steps are long against all waves.
fn pressed(n: usize, tangential: f64) -> Simulation<Dim2> {
    let (far, size) = (40.0 * A, A / n as f64);
    let normal = load();
    // The load first, then the tangential force.
    let force = |from: f64, to: f64| {
        let end = from + 5.0;
        format!("Force(Ramp(from: 0.0, to: {to:?}, start: {from:?}, end: {end:?}))")
    };
    let along = force(6.0, tangential * MU * normal);
    let down = force(0.0, -normal);
    let mut s = scene::<Dim2>(&Sketch {
        bodies: format!(
            "(name: \"cylinder\", material: \"m0\", shapes: [Balls([([0.0, 0.0], {RADIUS:?})])], position: [0.0, {RADIUS:?}], \
             dofs: (x: {along}, y: {down}, rz: Fixed)),"
        ),
        mu: MU,
        ..sketch(0.5, 1.0)
    });
    // Even in the contact, coarser away from it.
    let even_to = 1.5 * A;
    let mut x = even(-even_to, even_to, 3 * n);
    let outside = graded(even_to, far, size, 1.25);
    x.extend(outside.iter().skip(1));
    let left: Vec<f64> = outside.iter().skip(1).map(|x| -x).rev().collect();
    x.splice(0..0, left);
    let mut y = graded(0.0, -far, size, 1.15);
    y.reverse();
    let supports = [support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)])];
    let mut spec = body(block::<Dim2>(&[x, y]).unwrap(), STEEL, &supports);
    spec.touching = Some("top");
    add(&mut s, spec);
    s
}

/// Place along x (m), pressure and shear traction (Pa) of each touching point.
fn tractions(s: &Simulation<Dim2>, n: usize) -> Vec<[f64; 3]> {
    let length = A / n as f64 * s.options.scheme.h;
    let contacts = s.state.network.contacts.iter();
    let mut out: Vec<[f64; 3]> = contacts
        .filter(|c| c.impulse[1] != 0.0)
        .map(|c| {
            let system = c.bodies.map(|b| s.state.bodies.carrier(b as usize));
            let side = usize::from(system[0].is_none());
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let x = s.state.bodies.position[c.bodies[side] as usize][0];
            [
                x,
                -sign * c.impulse[1] / length,
                sign * c.impulse[0] / length,
            ]
        })
        .collect();
    out.sort_by(|a, b| a[0].total_cmp(&b[0]));
    out
}

/// Root mean square of the difference from a closed form, as a share of p0.
fn off(tractions: &[[f64; 3]], which: usize, expected: impl Fn(f64) -> f64) -> f64 {
    let p0 = 2.0 * load() / (std::f64::consts::PI * A);
    let squares = tractions
        .iter()
        .map(|t| (t[which] - expected(t[0])).powi(2));
    (squares.sum::<f64>() / tractions.len() as f64).sqrt() / p0
}

fn ellipse(x: f64, half: f64) -> f64 {
    (1.0 - (x / half).powi(2)).max(0.0).sqrt()
}

#[test]
fn hertz() {
    let p0 = 2.0 * load() / (std::f64::consts::PI * A);
    let mut errors = Vec::new();
    for n in [5, 10, 20] {
        let mut s = pressed(n, 0.0);
        go(&mut s, 12);
        let found = tractions(&s, n);
        let total: f64 = found.iter().map(|t| t[1] * A / n as f64).sum();
        near(load(), total, 1e-6);
        errors.push(off(&found, 1, |x| p0 * ellipse(x, A)));
        println!(
            "{n}: {:?} {} {:e}",
            errors,
            found.len(),
            found[found.len() / 2][1] / p0
        );
    }
    assert!(errors[2] < 0.02, "{errors:?}");
    assert!(errors.windows(2).all(|e| e[1] < 0.75 * e[0]), "{errors:?}");
}

#[test]
fn cattaneo_and_mindlin() {
    let p0 = 2.0 * load() / (std::f64::consts::PI * A);
    for share in [0.36, 0.75] {
        let c = A * (1.0_f64 - share).sqrt();
        let mut s = pressed(20, share);
        go(&mut s, 24);
        let found = tractions(&s, 20);
        let expected = |x: f64| MU * p0 * (ellipse(x, A) - c / A * ellipse(x, c));
        let error = off(&found, 2, expected);
        println!("{share}: {error:e} {found:?}");
        assert!(error < 0.02 * MU + 0.005, "{share}: {error}");
        closes(&s, 1e-6);
    }
}
