//! Steady rolling against the program CONTACT (E. A. H. Vollebregt, github eve70a/CONTACT, commit
//! d431cdb): its reference output `tractcurv`, and Kalker's table of coefficients.

use super::pressed::{centred, pressed, steel};
use fretwork_rolling::{
    Coulomb, Creepage, Falling, Friction, Motion, Pressure, Surfaces, Tractions, tangential,
};

const MU: f64 = 0.33;
const LOAD: f64 = 106.7e3;

/// The patch of `tractcurv`: G 82 GPa, nu 0.28, a/b 0.5, curvature 1.6/m along the rolling.
struct Patch {
    surfaces: Surfaces,
    pressure: Pressure,
}

impl Patch {
    fn new(cells: [usize; 2], layer: f64) -> Self {
        let body = steel(2.0 * 82e9 * 1.28, 0.28);
        // The curvature across, for which a/b is one half.
        let load = (LOAD, [1.6, 0.562_829_829]);
        let (surfaces, pressure, hertz) = pressed(body, layer, load, cells);
        assert!((hertz.along / hertz.across - 0.5).abs() < 1e-4, "{hertz:?}");
        let close = |a: f64, b: f64, by: f64| assert!((a / b - 1.0).abs() < by, "{a} {b}");
        close(pressure.approach, hertz.approach, 1e-3);
        close(pressure.largest(), hertz.pressure, 2e-3);
        Self { surfaces, pressure }
    }

    fn rolls(&self, creepage: [f64; 3], law: &dyn Friction, speed: f64) -> Tractions {
        let [along, across, spin] = creepage;
        let motion = Motion::Steady(Creepage {
            along,
            across,
            spin,
        });
        let pressure = &self.pressure.pressure;
        tangential(&self.surfaces, pressure, &motion, (law, speed), None, 1e-6)
            .unwrap_or_else(|e| panic!("{e}"))
    }

    /// Forces over mu P.
    fn forces(&self, found: &Tractions) -> [f64; 2] {
        let scale = self.surfaces.grid.area(3) / (MU * LOAD);
        [0, 1].map(|k| scale * found.traction.iter().map(|p| p[k]).sum::<f64>())
    }
}

fn near(got: f64, expected: f64, by: f64) {
    assert!((got - expected).abs() < by, "{got} for {expected}");
}

#[test]
fn the_creep_curve_is_that_of_contact() {
    let patch = Patch::new([48, 44], 0.0);
    for (xi, expected) in [
        (4e-4, 0.2588),
        (8e-4, 0.4742),
        (1.2e-3, 0.6482),
        (1.6e-3, 0.7831),
        (2.0e-3, 0.8816),
        (2.4e-3, 0.9467),
        (2.8e-3, 0.9832),
        (3.2e-3, 0.9976),
    ] {
        let found = patch.rolls([xi, 0.0, 0.0], &Coulomb(MU), 1.0);
        let [x, y] = patch.forces(&found);
        near(-x, expected, 2e-4);
        near(y, 0.0, 1e-8);
        assert!(found.unique);
    }
}

#[test]
fn spin_and_creepage_in_any_direction_are_those_of_contact() {
    let patch = Patch::new([48, 44], 0.0);
    for (creepage, x, y) in [
        ([0.0, 1e-3, 0.0], 0.0, -0.4773),
        ([0.0, 0.0, 0.2], 0.0, -0.2781),
        ([0.0, 0.0, 0.6], 0.0, -0.4464),
        ([1e-3, 5e-4, 0.3], -0.3063, -0.5284),
        ([1e-3, -5e-4, 0.3], -0.3137, -0.1680),
        ([-5e-4, 1e-3, 0.5], 0.0990, -0.6372),
    ] {
        let found = patch.rolls(creepage, &Coulomb(MU), 1.0);
        let [fx, fy] = patch.forces(&found);
        near(fx, x, 5e-4);
        near(fy, y, 5e-4);
    }
    // The moment of lateral creepage (N m).
    let found = patch.rolls([0.0, 1e-3, 0.0], &Coulomb(MU), 1.0);
    let grid = &patch.surfaces.grid;
    let moment: f64 = (0..grid.len())
        .map(|c| {
            let ([x, y], p) = (grid.middle(c), found.traction[c]);
            (x * p[1] - y * p[0]) * grid.area(3)
        })
        .sum();
    near(moment / 30.87, 1.0, 1e-3);
}

/// The second series of `tractcurv`: friction that falls with the velocity of slip, and an elastic
/// layer of 1.25 mm with 8.2 GPa, at 10 m/s.
#[test]
fn falling_friction_with_a_layer_is_that_of_contact() {
    let patch = Patch::new([48, 44], 1.25e-3 / 8.2e9);
    let law = Falling {
        at_rest: MU,
        kinetic: 0.14,
        half: 1.25,
        memory: 3e-6,
    };
    for (xi, expected) in [
        (1e-3, 0.1825),
        (2e-3, 0.3495),
        (4e-3, 0.6101),
        (8e-3, 0.8652),
        (1e-2, 0.9119),
        (1.5e-2, 0.9442),
        (2e-2, 0.9393),
        (5e-2, 0.8622),
        (0.1, 0.7559),
        (0.25, 0.5685),
    ] {
        let found = patch.rolls([xi, 0.0, 0.0], &law, 10.0);
        let [x, _] = patch.forces(&found);
        near(-x / expected, 1.0, 2.5e-3);
    }
}

/// Kalker's coefficients C11, C22 and C23 at nu = 1/4 (J. J. Kalker, 1990, table E3), and the
/// reciprocity C23 = -C32, with pressures as on an ellipse and without slip.
#[test]
fn small_creepages_give_kalkers_coefficients() {
    let (shear, n) = (80e9, 40);
    let body = steel(2.0 * shear * 1.25, 0.25);
    for (ratio, expected) in [
        (0.2, [3.37, 2.63, 0.603]),
        (0.5, [3.62, 3.01, 0.929]),
        (1.0, [4.12, 3.67, 1.47]),
        (2.0, [5.10, 4.90, 2.62]),
    ] {
        let [a, b] = [5e-3 * f64::sqrt(ratio), 5e-3 / f64::sqrt(ratio)];
        let grid = centred([n, n], [1.02 * a, 1.02 * b]);
        let pressure: Vec<f64> = (0..grid.len())
            .map(|c| {
                let [x, y] = grid.middle(c);
                1e15 * (1.0 - (x / a).powi(2) - (y / b).powi(2)).max(0.0).sqrt()
            })
            .collect();
        let surfaces = Surfaces::new(grid, [body; 2], 0.0);
        // Force along x and y, and moment.
        let of = |creepage: [f64; 3]| {
            let [along, across, spin] = creepage;
            let motion = Motion::Steady(Creepage {
                along,
                across,
                spin,
            });
            let law = (&Coulomb(1.0) as &dyn Friction, 1.0);
            let found = tangential(&surfaces, &pressure, &motion, law, None, 1e-18).unwrap();
            let grid = &surfaces.grid;
            let mut sum = [0.0; 3];
            for (c, p) in found.traction.iter().enumerate() {
                let [x, y] = grid.middle(c);
                let parts = [p[0], p[1], x * p[1] - y * p[0]];
                (0..3).for_each(|k| sum[k] += parts[k] * grid.area(3));
            }
            sum
        };
        let (small, c) = (1e-6, f64::sqrt(a * b));
        let c11 = -of([small, 0.0, 0.0])[0] / (shear * c * c * small);
        let [_, across, moment] = of([0.0, small, 0.0]);
        let c22 = -across / (shear * c * c * small);
        let c32 = -moment / (shear * c * c * c * small);
        let spin = 1e-3;
        let c23 = -of([0.0, 0.0, spin])[1] / (shear * c * c * c * spin);
        for (got, expected) in [c11, c22, c23].into_iter().zip(expected) {
            near(got / expected, 1.0, 0.02);
        }
        // The place of the spin, a sixth of a cell ahead, is a lateral creepage.
        let ahead = c22 * surfaces.grid.size[0] / (6.0 * c);
        near(c32 / (c23 - ahead), -1.0, 1e-8);
    }
}
