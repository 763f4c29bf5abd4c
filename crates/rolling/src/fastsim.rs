//! FASTSIM, the simplified theory of rolling contact: a patch on springs, whose compliances are
//! such that small creepages give Kalker's forces (J. J. Kalker, Vehicle System Dynamics 11, 1982).
//!
//! Pressures are parabolic, 2 P/(pi a b) (1 - x²/a² - y²/b²), as the theory is made for them. From
//! the leading edge on, traction grows by the rigid slip over the compliance of each direction and
//! is cut at the bound of the law. Kalker cuts it along itself; here it is cut along the slip, so
//! that in full slip it opposes the creepage where the compliances differ, too.
//!
//! A law is asked for the rigid slip, as by M. Spiryagin, O. Polach and C. Cole (Vehicle System
//! Dynamics 51, 2013). Friction that falls with the slip of a place has no solution on springs,
//! whose traction may fall at once: slip grows away from the rigid one as material goes on.

use crate::fields::{Vector, length};
use crate::friction::{Bound, Cells, Friction};
use crate::motion::{Creepage, rigid_slip};
use crate::normal::Pressure;
use crate::patch::{Refined, Rolling, coarser};
use crate::tangential::Tractions;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{Kalker, PointPatch, Solid, like_bodies};
use std::f64::consts::PI;

/// An elliptic patch on springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fastsim {
    /// The patch by Hertz.
    pub patch: PointPatch,
    /// Load (N).
    pub load: f64,
    /// Compliances for creepage along the rolling, across it, and spin (m/Pa).
    pub compliance: [f64; 3],
}

/// Largest number of steps to a size of a traction, and its relative error.
const STEPS: usize = 60;
const CLOSE: f64 = 1e-12;

impl Fastsim {
    /// Largest difference of the force to that of the exact theory over the force of full slip,
    /// without spin and with it, over creepages in all directions, ratios of the axes from 0.2 to 5
    /// and all Poisson's ratios (a test of [`crate::closed`]).
    pub const ERROR: [f64; 2] = [0.04, 0.17];

    /// Returns the patch of two bodies by Hertz, with an elastic layer between them of this
    /// thickness over its shear modulus (m/Pa); `None` outside Kalker's table. The compliances are
    /// L1 = 8 a/(3 C11 G), L2 = 8 a/(3 C22 G), L3 = pi a sqrt(a/b)/(4 C23 G), and that of the layer
    /// in addition.
    pub fn new(patch: &PointPatch, load: f64, bodies: &[Solid; 2], layer: f64) -> Option<Self> {
        let like = like_bodies(bodies);
        let kalker = Kalker::new(patch.along / patch.across, like.poisson)?;
        let (a, shear) = (patch.along, like.shear());
        let compliance = [
            8.0 * a / (3.0 * kalker.c11 * shear),
            8.0 * a / (3.0 * kalker.c22 * shear),
            PI * a * (a / patch.across).sqrt() / (4.0 * kalker.c23 * shear),
        ];
        Some(Self {
            patch: *patch,
            load,
            compliance: compliance.map(|c| c + layer),
        })
    }

    /// Solves steady rolling over a grid around the patch, at a speed (m/s).
    pub fn rolls(
        &self,
        grid: CellGrid,
        creepage: &Creepage,
        law: &dyn Friction,
        speed: f64,
    ) -> Rolling {
        let pressure = self.pressure(&grid);
        let cells = Cells {
            grid: &grid,
            pressure: &pressure.pressure,
            speed,
        };
        let bounds = law.bounds(cells, &rigid_slip(&grid, creepage));
        let rows = Rows {
            springs: self,
            grid: &grid,
            creepage,
        };
        let tractions = rows.follow(&pressure.pressure, &bounds);
        Rolling::new(grid, pressure, tractions, creepage)
    }

    /// Solves steady rolling over a grid, and over two of cells twice as large.
    pub fn refined(
        &self,
        grid: CellGrid,
        creepage: &Creepage,
        law: &dyn Friction,
        speed: f64,
    ) -> Refined {
        let solve = |grid: CellGrid| self.rolls(grid, creepage, law, speed);
        Refined::of(solve(grid), coarser(&grid).map(solve))
    }

    /// Returns the parabolic pressures, which have the load on any grid.
    fn pressure(&self, grid: &CellGrid) -> Pressure {
        let [a, b] = [self.patch.along, self.patch.across];
        let of = |cell: usize| {
            let [x, y] = grid.middle(cell);
            (1.0 - (x / a).powi(2) - (y / b).powi(2)).max(0.0)
        };
        let shape: Vec<f64> = (0..grid.len()).map(of).collect();
        let factor = self.load / (shape.iter().sum::<f64>() * grid.area(3));
        Pressure {
            pressure: shape.into_iter().map(|p| factor * p).collect(),
            approach: self.patch.approach,
            iterations: 0,
        }
    }
}

/// The rows of a grid, through which material passes from the leading edge.
struct Rows<'a> {
    springs: &'a Fastsim,
    grid: &'a CellGrid,
    creepage: &'a Creepage,
}

impl Rows<'_> {
    /// Returns how far material has rolled to the middle of a cell since that of the one before, or
    /// since the leading edge (m), and the growth of its traction there without slip (Pa).
    fn growth(&self, cell: usize) -> (f64, Vector) {
        let [x, y] = self.grid.middle(cell);
        let [a, b] = [self.springs.patch.along, self.springs.patch.across];
        let edge = a * (1.0 - (y / b).powi(2)).max(0.0).sqrt();
        let passed = (edge - x).min(self.grid.size[0]);
        let [l1, l2, l3] = self.springs.compliance;
        let c = self.creepage;
        let across = c.across / l2 + (x + 0.5 * passed) * c.spin / l3;
        let along = c.along / l1 - y * c.spin / l3;
        (passed, [-passed * along, -passed * across])
    }

    /// Follows all rows under bounds.
    fn follow(&self, pressure: &[f64], bounds: &[Bound]) -> Tractions {
        let (columns, count) = (self.grid.cells[0], pressure.len());
        let [l1, l2, _] = self.springs.compliance;
        let mut out = Tractions {
            traction: vec![[0.0; 2]; count],
            slip: vec![[0.0; 2]; count],
            bound: bounds.iter().map(|b| b.traction).collect(),
            sticks: vec![false; count],
            unique: true,
            ..Tractions::default()
        };
        for start in (0..count).step_by(columns) {
            let mut p = [0.0; 2];
            for cell in (start..start + columns).rev() {
                if pressure[cell] <= 0.0 {
                    p = [0.0; 2];
                    continue;
                }
                let (_, grown) = self.growth(cell);
                let z = [p[0] + grown[0], p[1] + grown[1]];
                let (size, held) = (length(z), bounds[cell].traction);
                out.sticks[cell] = size <= held;
                p = match size <= held {
                    true => z,
                    false => cut(z, [l1, l2], held),
                };
                out.traction[cell] = p;
                out.slip[cell] = [l1 * (p[0] - z[0]), l2 * (p[1] - z[1])];
            }
        }
        out
    }
}

/// Returns the traction of a size (Pa) that opposes the slip by which springs of two compliances
/// (m/Pa) are relieved from a larger one: p with L (p - z) = -s p.
fn cut(z: Vector, compliance: [f64; 2], held: f64) -> Vector {
    if held <= 0.0 {
        return [0.0; 2];
    }
    let at = |s: f64| [0, 1].map(|k| compliance[k] * z[k] / (compliance[k] + s));
    // The size is convex and falls with s, so that Newton's method comes from below.
    let mut s = 0.0;
    for _ in 0..STEPS {
        let p = at(s);
        let size = length(p);
        if size <= (1.0 + CLOSE) * held {
            break;
        }
        let falls = [0, 1].map(|k| p[k] * p[k] / (compliance[k] + s));
        s += (size / held) * size * (size - held) / (falls[0] + falls[1]);
    }
    let p = at(s);
    let size = length(p);
    p.map(|p| p * held / size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::{Coulomb, Falling};
    use fretwork_elastic::patch::{effective_modulus, point};

    const STEEL: Solid = Solid {
        young: 2.0 * 82e9 * 1.28,
        poisson: 0.28,
    };

    fn patch(layer: f64) -> Fastsim {
        let modulus = effective_modulus(&[STEEL; 2]);
        let hertz = point(106.7e3, [1.6, 0.562_829_829], modulus);
        Fastsim::new(&hertz, 106.7e3, &[STEEL; 2], layer).unwrap()
    }

    fn grid(springs: &Fastsim, cells: [usize; 2]) -> CellGrid {
        let half = [springs.patch.along, springs.patch.across];
        CellGrid {
            from: half.map(|h| -h),
            size: [0, 1].map(|k| 2.0 * half[k] / cells[k] as f64),
            cells,
        }
    }

    fn along(along: f64) -> Creepage {
        Creepage {
            along,
            ..Creepage::default()
        }
    }

    /// The series `tractcurv_fastsim` of the program CONTACT (github eve70a/CONTACT, commit
    /// d431cdb).
    #[test]
    fn forces_are_those_of_contacts_fastsim() {
        let springs = patch(0.0);
        for (xi, expected) in [
            (4e-4, 0.2577),
            (1.2e-3, 0.6281),
            (2e-3, 0.8433),
            (2.8e-3, 0.9505),
        ] {
            let grid = grid(&springs, [48, 44]);
            let found = springs.rolls(grid, &along(xi), &Coulomb(0.33), 1.0);
            let [x, y] = found.force;
            let share = -x / (0.33 * 106.7e3);
            assert!(
                (share / expected - 1.0).abs() < 0.03,
                "{xi}: {share} {expected}"
            );
            assert!(y.abs() < 1e-9 * x.abs());
        }
    }

    /// The fifth case of CONTACT's example `fastsim`, parabolic bounds on 200 x 200 cells: creepage
    /// across the rolling and spin on an ellipse of 8 x 4 mm, whose forces are given over mu P and
    /// whose moment in N m. Its tractions are cut along themselves, which takes 2 % of the force
    /// and 1 % of the moment here.
    #[test]
    fn spin_is_that_of_contacts_fastsim() {
        let patch = PointPatch {
            pressure: 1.5 * 82e3 / (PI * 8e-3 * 4e-3),
            along: 8e-3,
            across: 4e-3,
            approach: 0.0,
        };
        let springs = Fastsim::new(&patch, 82e3, &[STEEL; 2], 0.0).unwrap();
        let creepage = Creepage {
            along: 0.0,
            across: -6.25e-4,
            spin: 0.625,
        };
        let found = springs.rolls(grid(&springs, [200; 2]), &creepage, &Coulomb(0.3), 1.0);
        let near = |got: f64, expected: f64| {
            assert!((got / expected - 1.0).abs() < 0.03, "{got} {expected}");
        };
        near(found.force[1] / (0.3 * 82e3), -0.6359);
        near(found.moment, -37.98);
    }

    /// Small creepages give Kalker's forces in the limit of many cells.
    #[test]
    fn small_creepages_give_kalkers_forces() {
        let springs = patch(0.0);
        let [a, b] = [springs.patch.along, springs.patch.across];
        let kalker = Kalker::new(a / b, 0.28).unwrap();
        let small = 1e-8;
        let of = |creepage: Creepage| {
            let found = springs.rolls(grid(&springs, [200; 2]), &creepage, &Coulomb(1e3), 1.0);
            found.force
        };
        let across = Creepage {
            across: small,
            ..Creepage::default()
        };
        let spin = Creepage {
            spin: small,
            ..Creepage::default()
        };
        for (got, expected) in [
            (of(along(small))[0], kalker.c11 * a * b),
            (of(across)[1], kalker.c22 * a * b),
            (of(spin)[1], kalker.c23 * a * b * (a * b).sqrt()),
        ] {
            let expected = -expected * 82e9 * small;
            assert!((got / expected - 1.0).abs() < 0.005, "{got} {expected}");
        }
    }

    /// A soft layer is all of the compliance: before slip the traction grows with the distance from
    /// the leading edge, and the force is 8 a² b xi/(3 h/G).
    #[test]
    fn a_soft_layer_gives_its_own_slope() {
        let layer = 1e-9;
        let springs = patch(layer);
        let [a, b] = [springs.patch.along, springs.patch.across];
        let found = springs.rolls(grid(&springs, [100; 2]), &along(1e-6), &Coulomb(10.0), 1.0);
        let own = 8.0 * a / (3.0 * springs.compliance[0]);
        let expected = -own * a * b * 1e-6;
        assert!((found.force[0] / expected - 1.0).abs() < 0.003);
        assert!((springs.compliance[0] / layer - 1.0).abs() < 0.06);
    }

    /// Falling friction is that of the rigid slip, which is what full slip has.
    #[test]
    fn falling_friction_is_that_of_the_rigid_slip() {
        let springs = patch(1.25e-3 / 8.2e9);
        let law = Falling {
            at_rest: 0.33,
            kinetic: 0.14,
            half: 1.25,
            memory: 3e-6,
        };
        let grid = grid(&springs, [48; 2]);
        let found = springs.rolls(grid, &along(0.1), &law, 10.0);
        let mu = 0.14 + 0.19 * f64::exp2(-0.1 * 10.0 / 1.25);
        assert!(
            (found.adhesion() / mu - 1.0).abs() < 2e-3,
            "{} {mu}",
            found.adhesion()
        );
    }
}
