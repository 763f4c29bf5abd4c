//! Shifts of a sphere on a flat against Cattaneo's and Mindlin's closed forms (K. L. Johnson,
//! Contact Mechanics, 1985, 7.2 and 7.4), exact at nu = 0, where tractions along the shift do not
//! move surfaces across it.

use super::pressed::{pressed, steel};
use fretwork_rolling::{Coulomb, Motion, Pressure, Surfaces, Tractions, tangential};

const MU: f64 = 0.6;
const LOAD: f64 = 100.0;
const CURVATURE: f64 = 20.0;

struct Sphere {
    surfaces: Surfaces,
    pressure: Pressure,
    /// Radius of the patch, and the displacement at which it slides (m).
    radius: f64,
    gross: f64,
}

fn sphere(cells: usize) -> Sphere {
    let body = steel(200e9, 0.0);
    let load = (LOAD, [CURVATURE; 2]);
    let (surfaces, pressure, hertz) = pressed(body, 0.0, load, [cells; 2]);
    // delta = (3 mu P/(16 a)) sum (2 - nu)/G, with G = E/2 at nu = 0.
    let gross = 3.0 * MU * LOAD / (16.0 * hertz.along) * 2.0 * 2.0 / (0.5 * body.young);
    Sphere {
        surfaces,
        pressure,
        radius: hertz.along,
        gross,
    }
}

impl Sphere {
    fn shifted(&self, by: f64, from: &Tractions) -> Tractions {
        let motion = Motion::Shift {
            by: [by, 0.0],
            from: from.traction.clone(),
        };
        let start = Some(&from.traction[..]);
        let p = &self.pressure.pressure;
        tangential(&self.surfaces, p, &motion, (&Coulomb(MU), 1.0), start, 1e-8)
            .unwrap_or_else(|e| panic!("{e}"))
    }

    fn at_rest(&self) -> Tractions {
        Tractions {
            traction: vec![[0.0; 2]; self.surfaces.grid.len()],
            ..Tractions::default()
        }
    }

    /// Tangential force over mu P.
    fn share(&self, found: &Tractions) -> f64 {
        let sum: f64 = found.traction.iter().map(|p| p[0]).sum();
        -sum * self.surfaces.grid.area(3) / (MU * LOAD)
    }
}

#[test]
fn a_sphere_slips_from_the_edge_as_cattaneo_says() {
    let sphere = sphere(64);
    for part in [0.2, 0.5, 0.8, 0.95] {
        let found = sphere.shifted(part * sphere.gross, &sphere.at_rest());
        // delta/delta_gross = 1 - (1 - Q/mu P)^(2/3).
        let expected = 1.0 - (1.0f64 - part).powf(1.5);
        let share = sphere.share(&found);
        assert!(
            (share / expected - 1.0).abs() < 0.01,
            "{part}: {share} {expected}"
        );
        // The part that sticks is a circle of the radius a (1 - Q/mu P)^(1/3).
        let sticking = found.sticks.iter().filter(|s| **s).count() as f64;
        let area = sticking * sphere.surfaces.grid.area(3);
        let radius = (area / std::f64::consts::PI).sqrt() / sphere.radius;
        let expected = (1.0f64 - part).sqrt();
        assert!(
            (radius - expected).abs() < 0.03,
            "{part}: {radius} {expected}"
        );
    }
}

/// The loop of a displacement of +-0.8 of that at gross slip, in steps: by Masing's rule its energy
/// follows from the first loading, which no number of steps changes.
#[test]
fn a_loop_has_mindlins_energy_in_any_number_of_steps() {
    let sphere = sphere(32);
    let amplitude = 0.8 * sphere.gross;
    let mut energies = Vec::new();
    for steps in [4, 16] {
        let mut state = sphere.shifted(amplitude, &sphere.at_rest());
        let mut dissipated = 0.0;
        for part in 0..2 * steps {
            let by = 2.0 * amplitude / f64::from(steps);
            state = sphere.shifted(if part < steps { -by } else { by }, &state);
            let area = sphere.surfaces.grid.area(3);
            let pairs = state.traction.iter().zip(&state.slip);
            dissipated -= pairs.map(|(p, s)| p[0] * s[0] + p[1] * s[1]).sum::<f64>() * area;
        }
        energies.push(dissipated / (MU * LOAD * sphere.gross));
    }
    // On loading Q/(mu P) = 1 - (1 - d)^(3/2), and after a reversal twice that at half the
    // distance.
    let loading = |d: f64| 1.0 - (1.0 - d).powf(1.5);
    let n = 100_000;
    let most = loading(0.8);
    let back = |x: f64| most - 2.0 * loading(0.5 * x);
    let step = 1.6 / f64::from(n);
    let expected: f64 = (0..n)
        .map(|k| {
            let x = (f64::from(k) + 0.5) * step;
            // The upper branch at the same place is the other branch turned round.
            (-back(1.6 - x) - back(x)) * step
        })
        .sum::<f64>()
        .abs();
    for energy in &energies {
        assert!(
            (energy / expected - 1.0).abs() < 0.03,
            "{energies:?} {expected}"
        );
    }
    assert!(
        (energies[0] / energies[1] - 1.0).abs() < 0.02,
        "{energies:?}"
    );
}
