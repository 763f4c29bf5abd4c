//! FASTSIM, the simplified theory of rolling contact: a patch on springs, whose compliances are
//! such that small creepages give Kalker's forces (J. J. Kalker, Vehicle System Dynamics 11, 1982).

use crate::fields::{Vector, length};
use crate::motion::Creepage;
use fretwork_elastic::patch::{Kalker, PointPatch, Solid, like_bodies};
use std::f64::consts::PI;

/// An elliptic patch on springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fastsim {
    /// Semi-axes along and across the rolling (m).
    pub axes: [f64; 2],
    /// Load (N).
    pub load: f64,
    /// Compliances for creepage along the rolling, across it, and spin (m/Pa).
    pub compliance: [f64; 3],
}

impl Fastsim {
    /// Returns the patch of two bodies by Hertz; `None` outside Kalker's table. The compliances are
    /// L1 = 8 a/(3 C11 G), L2 = 8 a/(3 C22 G), L3 = pi a sqrt(a/b)/(4 C23 G).
    pub fn new(patch: &PointPatch, load: f64, bodies: &[Solid; 2]) -> Option<Self> {
        let like = like_bodies(bodies);
        let kalker = Kalker::new(patch.along / patch.across, like.poisson)?;
        let (a, shear) = (patch.along, like.shear());
        Some(Self {
            axes: [a, patch.across],
            load,
            compliance: [
                8.0 * a / (3.0 * kalker.c11 * shear),
                8.0 * a / (3.0 * kalker.c22 * shear),
                PI * a * (a / patch.across).sqrt() / (4.0 * kalker.c23 * shear),
            ],
        })
    }

    /// Returns the forces on the first body along and across the rolling (N) with a coefficient of
    /// friction, over a number of strips and steps in each.
    ///
    /// The bound is parabolic, mu 2 P/(pi a b) (1 - x²/a² - y²/b²), as the theory is made for it.
    pub fn force(&self, creepage: &Creepage, mu: f64, [strips, steps]: [usize; 2]) -> Vector {
        let [a, b] = self.axes;
        let [l1, l2, l3] = self.compliance;
        let highest = 2.0 * mu * self.load / (PI * a * b);
        let width = 2.0 * b / strips as f64;
        let mut force = [0.0; 2];
        for strip in 0..strips {
            let y = -b + (strip as f64 + 0.5) * width;
            let half = a * (1.0 - (y / b).powi(2)).sqrt();
            let step = 2.0 * half / steps as f64;
            let mut p = [0.0; 2];
            for k in 0..steps {
                let x = half - (k as f64 + 0.5) * step;
                let bound = highest * (1.0 - (x / a).powi(2) - (y / b).powi(2));
                // The first place lies half a step behind the edge.
                let passed = if k == 0 { 0.5 * step } else { step };
                p[0] -= passed * (creepage.along / l1 - y * creepage.spin / l3);
                p[1] -= passed * (creepage.across / l2 + x * creepage.spin / l3);
                let size = length(p);
                if size > bound {
                    p = p.map(|p| p * bound / size);
                }
                (0..2).for_each(|k| force[k] += p[k] * step * width);
            }
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_elastic::patch::{effective_modulus, point};

    fn patch() -> Fastsim {
        let steel = Solid {
            young: 2.0 * 82e9 * 1.28,
            poisson: 0.28,
        };
        let hertz = point(
            106.7e3,
            [1.6, 0.562_829_829],
            effective_modulus(&[steel; 2]),
        );
        Fastsim::new(&hertz, 106.7e3, &[steel; 2]).unwrap()
    }

    /// The series `tractcurv_fastsim` of the program CONTACT (github eve70a/CONTACT, commit
    /// d431cdb).
    #[test]
    fn forces_are_those_of_contacts_fastsim() {
        let fastsim = patch();
        for (along, expected) in [
            (4e-4, 0.2577),
            (1.2e-3, 0.6281),
            (2e-3, 0.8433),
            (2.8e-3, 0.9505),
        ] {
            let creepage = Creepage {
                along,
                ..Creepage::default()
            };
            let [x, y] = fastsim.force(&creepage, 0.33, [44, 48]);
            let share = -x / (0.33 * 106.7e3);
            assert!(
                (share / expected - 1.0).abs() < 0.03,
                "{along}: {share} {expected}"
            );
            assert!(y.abs() < 1e-9 * x.abs());
        }
    }

    /// Small creepages give Kalker's forces in the limit of many steps.
    #[test]
    fn small_creepages_give_kalkers_forces() {
        let fastsim = patch();
        let kalker = Kalker::new(fastsim.axes[0] / fastsim.axes[1], 0.28).unwrap();
        let [a, b] = fastsim.axes;
        let small = 1e-8;
        let of = |creepage: Creepage| fastsim.force(&creepage, 1e3, [400, 400]);
        let along = of(Creepage {
            along: small,
            ..Creepage::default()
        })[0];
        let across = of(Creepage {
            across: small,
            ..Creepage::default()
        })[1];
        let spin = of(Creepage {
            spin: small,
            ..Creepage::default()
        })[1];
        for (got, expected) in [
            (along, kalker.c11 * a * b),
            (across, kalker.c22 * a * b),
            (spin, kalker.c23 * a * b * (a * b).sqrt()),
        ] {
            let expected = -expected * 82e9 * small;
            assert!((got / expected - 1.0).abs() < 0.01, "{got} {expected}");
        }
    }
}
