//! Potyondy and Cundall's parallel bond: a short beam of cement in tension, shear, bending and
//! torsion.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, parameters};
use std::f64::consts::PI;

parameters! {
    /// Stresses k_n u_n and k_t u_t over the area A, moments k_n I theta in bending and k_t J theta
    /// in torsion. In 3D A = pi R^2, I = pi R^4/4, J = 2 I; in 2D A = 2 R, I = 2 R^3/3 per depth.
    /// It breaks at once if the edge fails in tension: F_n/A + |M_b| R/I > sigma_c, or in shear:
    /// |F_t|/A + |M_t| R/J > tau_c. The contact carries compression; R follows from the contact's
    /// area.
    pub struct ParallelBond {
        k_n: "Pa/m" = 1e14, 1.0, 1e30, "normal stiffness over the area";
        k_t: "Pa/m" = 1e14, 1.0, 1e30, "shear stiffness over the area";
        sigma_c: "Pa" = 1e7, 1e-30, 1e30, "tensile strength";
        tau_c: "Pa" = 1e7, 1e-30, 1e30, "shear strength";
    }
}

impl Law for ParallelBond {
    const NAME: &'static str = "parallel-bond";
    const DOC: &'static str =
        "cement beam with bending and twist, brittle at its tensile or shear strength";
    const REFERENCE: &'static str =
        "D. O. Potyondy, P. A. Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329-1364";
    const FLAGS: u64 = abi::FLAG_OPENING
        | abi::FLAG_TENSION_ONLY
        | abi::FLAG_MOMENT
        | abi::FLAG_BREAKS
        | abi::FLAG_FORMS;

    fn fracture_energy(&self, angle: f64) -> Option<f64> {
        // Energy stored at the break.
        let (c, s) = (angle.cos().max(0.0), angle.sin().abs());
        let u = (self.sigma_c / (self.k_n * c)).min(self.tau_c / (self.k_t * s));
        Some(0.5 * (self.k_n * c * c + self.k_t * s * s) * u * u)
    }
}

/// Returns the radius of the bond (m), and I/A and J/A (m^2).
fn section(site: &Site) -> (f64, f64, f64) {
    let area = site.area.max(0.0);
    if site.dimension == 2 {
        let r = 0.5 * area;
        (r, (r * r / 3.0).min(f64::MAX), 0.0)
    } else {
        let square = area / PI;
        (square.sqrt(), 0.25 * square, 0.5 * square)
    }
}

impl CohesionLaw for ParallelBond {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if site.damage >= 1.0 {
            return Traction::default();
        }
        let g = 1.0 - site.damage;
        let [twist, b1, b2] = site.rotation;
        let (_, i, j) = section(site);
        let (bend, turn) = (bounded(g * self.k_n * i), bounded(g * self.k_t * j));
        Traction {
            moment: [turn * twist, bend * b1, bend * b2].map(bounded),
            stiffness_twist: turn,
            stiffness_bend: bend,
            ..Traction::linear(site, g * self.k_n, g * self.k_t)
        }
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let (n, t) = (site.normal_opening(), site.tangential_opening());
        let [twist, b1, b2] = site.rotation;
        let (_, i, j) = section(site);
        let (bend, turn) = (bounded(self.k_n * i), bounded(self.k_t * j));
        // The factors are multiplied one by one, since a square may overflow where its product with
        // a zero is zero.
        let bending = bend * b1 * b1 + bend * b2 * b2 + turn * twist * twist;
        bounded(0.5 * (1.0 - site.damage) * (self.k_n * n * n + self.k_t * t * t + bending))
    }

    fn commit(&self, site: &Site, _state: &mut [f64]) -> f64 {
        let (r, _, _) = section(site);
        let [twist, b1, b2] = site.rotation;
        // |M_b| R/I = k_n |theta| R, |M_t| R/J = k_t |theta| R.
        let tension = self.k_n * (site.opening[0] + b1.hypot(b2) * r);
        let shear = self.k_t * (site.tangential_opening() + twist.abs() * r);
        if tension > self.sigma_c || shear > self.tau_c {
            1.0
        } else {
            site.damage
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beam theory gives M = k_n I theta and the edge stress M R/I, in 3D and in 2D.
    #[test]
    fn bending_is_the_beams() {
        let law = ParallelBond::default();
        for (dimension, r) in [(3, 2e-5), (2, 3e-5)] {
            let (area, i) = match dimension {
                3 => (PI * r * r, PI * r.powi(4) / 4.0),
                _ => (2.0 * r, 2.0 * r.powi(3) / 3.0),
            };
            let theta = 1e-4;
            let site = Site {
                area,
                dimension,
                rotation: [0.0, theta, 0.0],
                ..Site::default()
            };
            let moment = law.traction(&site, &[]).moment[1] * area;
            assert!((moment / (law.k_n * i * theta) - 1.0).abs() < 1e-12);
            let limit = law.sigma_c / (law.k_n * r);
            let broken = |theta: f64| {
                let rotation = [0.0, theta, 0.0];
                law.commit(&Site { rotation, ..site }, &mut []) == 1.0
            };
            assert!(!broken(0.999 * limit) && broken(1.001 * limit));
        }
    }

    #[test]
    fn twist_shears_the_edge() {
        let law = ParallelBond::default();
        let r = 1e-5;
        let site = Site {
            area: PI * r * r,
            dimension: 3,
            rotation: [1e-3, 0.0, 0.0],
            ..Site::default()
        };
        let moment = law.traction(&site, &[]).moment[0] * site.area;
        assert!((moment / (law.k_t * PI * r.powi(4) / 2.0 * 1e-3) - 1.0).abs() < 1e-12);
        let limit = law.tau_c / (law.k_t * r);
        let at = |twist: f64| {
            let rotation = [twist, 0.0, 0.0];
            law.commit(&Site { rotation, ..site }, &mut [])
        };
        assert_eq!((at(0.99 * limit), at(-1.01 * limit)), (0.0, 1.0));
    }
}
