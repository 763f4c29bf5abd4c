//! Forces of an elliptic patch in closed form: those of Kalker's linear theory, cut by the cubic of
//! Vermeulen and Johnson where friction holds less (Z. Y. Shen, J. K. Hedrick, J. A. Elkins,
//! Vehicle System Dynamics 12, 1983; P. J. Vermeulen, K. L. Johnson, Journal of Applied Mechanics
//! 31, 1964).
//!
//! ```text
//! f = |F|/(mu P) of the linear theory,   F/(mu P) -> f - f²/3 + f³/27 for f < 3, else 1
//! ```

use crate::fastsim::Fastsim;
use crate::fields::{Vector, length};
use crate::friction::{Cells, Friction};
use crate::motion::{Creepage, rigid_slip};
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{Kalker, PointPatch, Solid, like_bodies};

/// An elliptic patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closed {
    /// The patch by Hertz.
    pub patch: PointPatch,
    /// Load (N).
    pub load: f64,
    /// Forces of creepage along the rolling and across it (N), and of spin across it (N m).
    slopes: [f64; 3],
}

/// Error of creepage along or across the rolling over the force of full slip, and at most over the
/// force, and error by spin over the force that it has alone in the linear theory.
const PLAIN: [f64; 2] = [0.03, 0.1];
const SPIN: f64 = 1.2;

impl Closed {
    /// Returns the patch of two bodies by Hertz, with an elastic layer between them of this
    /// thickness over its shear modulus (m/Pa); `None` outside Kalker's table. The layer adds to
    /// the compliances that the simplified theory has for the same forces.
    pub fn new(patch: &PointPatch, load: f64, bodies: &[Solid; 2], layer: f64) -> Option<Self> {
        let like = like_bodies(bodies);
        let (a, b) = (patch.along, patch.across);
        let kalker = Kalker::new(a / b, like.poisson)?;
        let rigid = Fastsim::new(patch, load, bodies, 0.0)?.compliance;
        let [x, y, turn] = rigid.map(|own| own / (own + layer));
        let (scale, c) = (like.shear() * a * b, (a * b).sqrt());
        Some(Self {
            patch: *patch,
            load,
            slopes: [
                scale * kalker.c11 * x,
                scale * kalker.c22 * y,
                scale * c * kalker.c23 * turn,
            ],
        })
    }

    /// Returns the forces on the first body along the rolling and across it (N) where friction
    /// holds at most `held` (N), and the error of their vector (N).
    ///
    /// The error is the largest difference to the exact theory over creepages in all directions,
    /// ratios of the axes from 0.2 to 5 and all Poisson's ratios: 3 % of `held` along and across
    /// the rolling, and a tenth of the force at most; between them as much more as the creepage,
    /// which the force opposes in full slip, turns from the force of the linear theory; and 1.2
    /// times the force of the spin alone, up to all of `held`.
    pub fn forces(&self, creepage: &Creepage, held: f64) -> (Vector, f64) {
        let [along, across, spin] = self.slopes;
        let c = creepage;
        let plain = [-along * c.along, -across * c.across];
        let linear = [plain[0], plain[1] - spin * c.spin];
        let f = length(linear) / held;
        let share = match f {
            f if f >= 3.0 => 1.0 / f,
            f => 1.0 - f / 3.0 + f * f / 27.0,
        };
        let force = linear.map(|force| share * force);
        let (size, slip) = (length(plain), length([c.along, c.across]));
        let turned = match size > 0.0 {
            true => length([
                plain[0] / size + c.along / slip,
                plain[1] / size + c.across / slip,
            ]),
            false => 0.0,
        };
        let spun = SPIN * (spin * c.spin).abs();
        let error = (PLAIN[0] * held).min(PLAIN[1] * length(force)) + turned * length(force) + spun;
        (force, error.min(held))
    }

    /// Returns the pressure of Hertz at a place over the largest one.
    pub fn shape(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b] = [self.patch.along, self.patch.across];
        (1.0 - (x / a).powi(2) - (y / b).powi(2)).max(0.0).sqrt()
    }
}

/// Returns the force that a law of friction holds where every cell of a grid slips as rigid bodies
/// do (N), under pressures of a shape that carry a load (N), at a speed (m/s).
pub fn held(
    grid: &CellGrid,
    (load, shape): (f64, impl Fn([f64; 2]) -> f64),
    creepage: &Creepage,
    law: &dyn Friction,
    speed: f64,
) -> f64 {
    let pressure: Vec<f64> = (0..grid.len()).map(|c| shape(grid.middle(c))).collect();
    let factor = load / (pressure.iter().sum::<f64>() * grid.area(3));
    let pressure: Vec<f64> = pressure.into_iter().map(|p| factor * p).collect();
    let cells = Cells {
        grid,
        pressure: &pressure,
        speed,
    };
    let bounds = law.bounds(cells, &rigid_slip(grid, creepage));
    bounds.iter().map(|b| b.traction).sum::<f64>() * grid.area(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::{Coulomb, Falling};
    use crate::patch::Patch;
    use fretwork_elastic::Elasticity;
    use fretwork_elastic::patch::{effective_modulus, point};

    const MU: f64 = 0.3;
    const LOAD: f64 = 1e5;

    fn steel(poisson: f64) -> Solid {
        Solid {
            young: 160e9 * (1.0 + poisson),
            poisson,
        }
    }

    /// A contact: curvatures (1/m) and Poisson's ratio.
    type Case = ([f64; 2], f64);

    /// Forces of creepages along, across and of spin in the linear theory, over the friction.
    type Parts = [f64; 3];

    /// Returns how far the closed form is off the exact theory and by how much it says to be, and
    /// how far FASTSIM is off, over the force of full slip.
    fn off((curvatures, poisson): Case, parts: Parts) -> [f64; 3] {
        let body = steel(poisson);
        let hertz = point(LOAD, curvatures, effective_modulus(&[body; 2]));
        let closed = Closed::new(&hertz, LOAD, &[body; 2], 0.0).unwrap();
        let size = MU * LOAD;
        let [along, across, spin] = [0, 1, 2].map(|k| parts[k] * size / closed.slopes[k]);
        let creepage = Creepage {
            along,
            across,
            spin,
        };
        let half = [hertz.along, hertz.across].map(|h| 1.25 * h);
        let grid = CellGrid {
            from: half.map(|h| -h),
            size: half.map(|h| 2.0 * h / 24.0),
            cells: [24; 2],
        };
        let distance = |[x, y]: [f64; 2]| 0.5 * (curvatures[0] * x * x + curvatures[1] * y * y);
        let patch = Patch {
            bodies: [Elasticity {
                young: body.young,
                poisson,
                density: 7800.0,
            }; 2],
            layer: 0.0,
            distance: &distance,
            load: LOAD,
        };
        let law = Coulomb(MU);
        let exact = patch.refined(grid, &creepage, &law, 1.0).unwrap().force;
        let springs = Fastsim::new(&hertz, LOAD, &[body; 2], 0.0).unwrap();
        let springs = springs.refined(grid, &creepage, &law, 1.0).force;
        let (force, error) = closed.forces(&creepage, size);
        let to = |f: Vector| length([f[0] - exact[0], f[1] - exact[1]]) / size;
        [to(force), error / size, to(springs)]
    }

    /// Creepages in all directions with small and large spin, up to full slip. Over 480 of them, at
    /// Poisson's ratios of 0, 0.28 and 0.5 and on 32 cells a side, the closed form kept its errors
    /// too, and FASTSIM was off by at most 0.035 without spin and 0.163 with it.
    #[test]
    fn errors_are_those_that_are_stated() {
        let directions = [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.7, 0.7, 0.0],
            [1.0, 0.0, 0.3],
            [0.0, 1.0, 0.3],
            [0.0, -1.0, 0.3],
            [0.0, -1.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        // Ratios of the axes are 5.3, 0.5, 1 and 0.18.
        for case in [
            ([1.0, 12.0], 0.28),
            ([1.6, 0.56], 0.28),
            ([2.0, 2.0], 0.0),
            ([4.0, 0.3], 0.5),
        ] {
            for direction in directions {
                for size in [0.1, 0.5, 2.0, 4.0] {
                    let parts = direction.map(|d| d * size);
                    let [closed, says, springs] = off(case, parts);
                    let spun = usize::from(direction[2] != 0.0);
                    assert!(closed <= says, "{case:?} {parts:?}: {closed} {says}");
                    let most = Fastsim::ERROR[spun];
                    assert!(springs <= most, "{case:?} {parts:?}: {springs} {most}");
                }
            }
        }
    }

    /// The coefficient is that of the rigid slip.
    #[test]
    fn falling_friction_holds_what_it_has_at_the_rigid_slip() {
        let body = steel(0.28);
        let hertz = point(LOAD, [1.6, 0.56], effective_modulus(&[body; 2]));
        let closed = Closed::new(&hertz, LOAD, &[body; 2], 0.0).unwrap();
        let half = [hertz.along, hertz.across];
        let grid = CellGrid {
            from: half.map(|h| -h),
            size: half.map(|h| 2.0 * h / 48.0),
            cells: [48; 2],
        };
        let law = Falling {
            at_rest: 0.33,
            kinetic: 0.14,
            half: 1.25,
            memory: 1e-9,
        };
        let creepage = Creepage {
            along: 0.05,
            ..Creepage::default()
        };
        let mu = 0.14 + 0.19 * f64::exp2(-0.05 * 10.0 / 1.25);
        let pressed = (LOAD, |place| closed.shape(place));
        let held = held(&grid, pressed, &creepage, &law, 10.0);
        assert!((held / (mu * LOAD) - 1.0).abs() < 1e-3, "{held} {mu}");
    }
}
