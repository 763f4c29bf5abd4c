//! Longitudinal creepage and force of an elliptic contact of like bodies with a friction
//! coefficient.

use crate::friction::Coulomb;
use crate::motion::Creepage;
use crate::normal::normal;
use crate::patch::{Patch, PatchError};
use crate::surfaces::Surfaces;
use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{PointPatch, Solid, effective_modulus, point};

/// Number of cells along each semi-axis of the finest grid, and the semi-axes of the patch in half
/// of the grid's side.
const CELLS: (usize, f64) = (48, 1.1);

/// An elliptic contact that rolls along its first axis. Over the load its force is mu times a
/// function of the creepage over mu, since like bodies have no coupling between pressures and
/// tractions.
#[derive(Clone, Debug)]
pub struct Creep {
    body: Elasticity,
    curvature: [f64; 2],
    load: f64,
    /// The patch by Hertz.
    pub hertz: PointPatch,
}

/// A part of the force of full slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Q/(mu P), extrapolated to cells of no size.
    pub value: f64,
    /// Error of the grid.
    pub error: f64,
}

impl Creep {
    /// Creates a contact of two bodies of this elasticity under a load (N), with the curvatures of
    /// their undeformed distance along the rolling and across it (1/m).
    pub fn new(body: Elasticity, curvature: [f64; 2], load: f64) -> Self {
        let solid = Solid {
            young: body.young,
            poisson: body.poisson,
        };
        Self {
            body,
            curvature,
            load,
            hertz: point(load, curvature, effective_modulus(&[solid, solid])),
        }
    }

    /// Returns Q/(mu P) at a creepage over mu.
    ///
    /// # Errors
    /// The patch has no solution on its grid.
    pub fn share(&self, creepage: f64) -> Result<Share, PatchError> {
        let distance = self.distance();
        let patch = Patch {
            bodies: [self.body; 2],
            layer: 0.0,
            distance: &distance,
            load: self.load,
        };
        let creepage = Creepage {
            along: creepage,
            ..Creepage::default()
        };
        let found = patch.refined(self.grid(), &creepage, &Coulomb(1.0), 1.0)?;
        Ok(Share {
            value: found.force[0].abs() / self.load,
            error: found.error[0] / self.load,
        })
    }

    /// Returns the creepage over mu at which the last place at the leading edge begins to slip: the
    /// strain of the surface there under mu times the pressures.
    ///
    /// # Errors
    /// The pressures have no solution on the grid.
    pub fn saturation(&self) -> Result<f64, PatchError> {
        let grid = self.grid();
        let surfaces = Surfaces::new(grid, [self.body; 2], 0.0);
        let distance = self.distance();
        let distance: Vec<f64> = (0..grid.len())
            .map(|cell| distance(grid.middle(cell)))
            .collect();
        let pressure = normal(&surfaces, &distance, self.load, None)?.pressure;
        let traction: Vec<_> = pressure.iter().map(|p| [*p, 0.0]).collect();
        let moved = surfaces.displacement(&traction, false);
        // Under the pressures of Hertz u_x is c - c_x x^2 - c_y y^2.
        let row = grid.cells[1] / 2 * grid.cells[0] + grid.cells[0] / 2;
        let cells = [row, row + CELLS.0 / 2];
        let [near, far] = cells.map(|cell| (grid.middle(cell)[0], moved[cell][0]));
        let second = (near.1 - far.1) / (far.0 * far.0 - near.0 * near.0);
        Ok(2.0 * second.abs() * self.hertz.along)
    }

    fn distance(&self) -> impl Fn([f64; 2]) -> f64 {
        let [along, across] = self.curvature;
        move |[x, y]: [f64; 2]| 0.5 * (along * x * x + across * y * y)
    }

    fn grid(&self) -> CellGrid {
        let half = [self.hertz.along, self.hertz.across].map(|a| CELLS.1 * a);
        let cells = 2 * CELLS.0;
        CellGrid {
            from: half.map(|h| -h),
            size: half.map(|h| 2.0 * h / cells as f64),
            cells: [cells; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const STEEL: Elasticity = Elasticity {
        young: 209.92e9,
        poisson: 0.28,
        density: 7800.0,
    };

    /// CONTACT's creep curve of a patch with a/b = 1/2 (github.com/eve70a/CONTACT,
    /// examples/catalogue): 106.7 kN, G 82 GPa, nu 0.28, R 625 mm along the rolling, mu 0.33.
    #[test]
    fn the_force_is_that_of_contact() {
        let young = 2.0 * 82e9 * 1.28;
        let body = Elasticity { young, ..STEEL };
        // With this radius across a/b is one half, by Hertz' elliptic integrals.
        let creep = Creep::new(body, [1.6, 1.0 / 1.77672], 106.7e3);
        assert!((2.0 * creep.hertz.along / creep.hertz.across - 1.0).abs() < 1e-5);
        for (percent, expected) in [(0.04, 0.2588), (0.16, 0.7831), (0.24, 0.9467)] {
            let share = creep.share(percent / 100.0 / 0.33).unwrap();
            // CONTACT's figures are of 48 x 44 cells.
            let off = (share.value - expected).abs();
            assert!(off < 0.012 * expected, "{percent}: {share:?}");
            assert!(share.error < 0.01, "{share:?}");
        }
    }

    /// u_x under tractions in proportion to the pressures of a circle is pi q0/(32 G a) (4 (2 - nu)
    /// a^2 - (4 - 3 nu) x^2 - (4 - nu) y^2) of each body (K. L. Johnson, Contact Mechanics, 1985,
    /// 3.91).
    #[test]
    fn full_slip_of_a_circle_begins_at_the_strain_of_its_edge() {
        let creep = Creep::new(STEEL, [2.0; 2], 75e3);
        let shear = STEEL.shear();
        let expected = PI * (4.0 - 3.0 * STEEL.poisson) * creep.hertz.pressure / (8.0 * shear);
        let found = creep.saturation().unwrap();
        assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
        let before = creep.share(0.9 * found).unwrap();
        assert!(before.value < 0.9999 && before.value > 0.98, "{before:?}");
        assert!(creep.share(1.05 * found).unwrap().value > 0.999);
    }

    /// A patch far longer across is Carter's strip: full slip begins at mu a/R.
    #[test]
    fn a_long_patch_is_carters() {
        let creep = Creep::new(STEEL, [2.0, 0.002], 75e3);
        let expected = creep.hertz.along * 2.0;
        let found = creep.saturation().unwrap();
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}
