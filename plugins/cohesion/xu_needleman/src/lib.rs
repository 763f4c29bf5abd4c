//! Xu and Needleman's exponential cohesion, with history: it unloads to the origin and stays broken.
#![forbid(unsafe_code)]
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, export, parameters};

parameters! {
    /// t_n = (1 - D)(phi/delta_n^2) u_n and t_t = (1 - D)(2 phi/delta_t^2) u_t with phi = e strength delta_n and
    /// 1 - D = exp(-u_n/delta_n - |u_t|^2/delta_t^2), which never increases: on first loading this is the law of
    /// the paper in mode I, and in mode II (with q = 1, r = 0); in mixed mode the paper's factor (1 + u_n/delta_n)
    /// of t_t is omitted, so that one D applies to both. Below `left` the bond is broken.
    pub struct XuNeedleman {
        strength: "Pa" = 1e6, 1e-30, 1e30, "normal strength, reached at delta_n";
        delta_n: "m" = 1e-6, 1e-30, 1e30, "normal opening at the strength";
        delta_t: "m" = 1.5e-6, 1e-30, 1e30, "tangential length; the shear strength is reached at delta_t/sqrt(2)";
        left: "" = 1e-5, 1e-300, 0.5, "share of the stiffness below which the bond is broken";
    }
}

impl Law for XuNeedleman {
    const NAME: &'static str = "xu-needleman";
    const DOC: &'static str =
        "exponential cohesion with unloading to the origin, phi = e strength delta_n";
    const REFERENCE: &'static str =
        "X.-P. Xu, A. Needleman, J. Mech. Phys. Solids 42 (1994) 1397-1434";
    const FLAGS: u64 =
        abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_BREAKS | abi::FLAG_FORMS;

    fn fracture_energy(&self, angle: f64) -> Option<f64> {
        // For pure modes; in mixed mode the energy depends on the two lengths. The tail beyond `left` is cut off:
        // it is phi (1 + x) exp(-x) at x = -ln left in mode I, phi exp(-x) in mode II.
        let tail = if angle.sin().abs() < 1e-9 {
            (1.0 - self.left.ln()) * self.left
        } else if angle.cos().abs() < 1e-9 {
            self.left
        } else {
            return None;
        };
        Some(self.phi() * (1.0 - tail))
    }
}

impl XuNeedleman {
    fn phi(&self) -> f64 {
        std::f64::consts::E * self.strength * self.delta_n
    }

    fn stiffness(&self) -> (f64, f64) {
        let phi = self.phi();
        (
            phi / (self.delta_n * self.delta_n),
            2.0 * phi / (self.delta_t * self.delta_t),
        )
    }
}

impl CohesionLaw for XuNeedleman {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if site.damage >= 1.0 {
            return Traction::default();
        }
        let g = 1.0 - site.damage;
        let (k_n, k_t) = self.stiffness();
        Traction::linear(site, g * k_n, g * k_t)
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let (k_n, k_t) = self.stiffness();
        let (n, t) = (site.normal_opening(), site.tangential_opening());
        bounded(0.5 * (1.0 - site.damage) * (k_n * n * n + k_t * t * t))
    }

    fn commit(&self, site: &Site, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (n, t) = (
            site.normal_opening() / self.delta_n,
            site.tangential_opening() / self.delta_t,
        );
        let g = (-n - t * t).exp();
        if g <= self.left {
            1.0
        } else {
            site.damage.max(1.0 - g)
        }
    }
}

export!(cohesion XuNeedleman);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    /// Peak s at delta_n, area e s delta_n; in mode II sqrt(2 e) s delta_n/delta_t, the same area.
    #[test]
    fn peaks_and_areas_are_the_papers() {
        let law = XuNeedleman::default();
        let phi = std::f64::consts::E * 1e6 * 1e-6;
        let testing::Pull { peak, area, .. } =
            testing::pull_breaking(&law, [1.0, 0.0, 0.0], 30e-6, 400_000);
        assert!((peak / 1e6 - 1.0).abs() < 1e-6 && (area / phi - 1.0).abs() < 1e-3);
        let testing::Pull { peak, area, .. } =
            testing::pull_breaking(&law, [0.0, 1.0, 0.0], 30e-6, 400_000);
        let shear = (2.0 * std::f64::consts::E).sqrt() * 1e6 / 1.5;
        assert!(
            (peak / shear - 1.0).abs() < 1e-6 && (area / phi - 1.0).abs() < 1e-3,
            "{area}"
        );
    }

    #[test]
    fn numbers_stay_finite_and_a_broken_bond_carries_nothing() {
        testing::bond_stays_finite(&XuNeedleman::default());
    }

    /// With x = -ln left the area up to the cut is phi (1 - (1 + x) exp(-x)) in mode I, phi (1 - exp(-x)) in mode II.
    #[test]
    fn the_declared_energy_leaves_out_the_tail() {
        let law = XuNeedleman {
            left: 0.1,
            ..XuNeedleman::default()
        };
        for (angle, direction) in [
            (0.0, [1.0, 0.0, 0.0]),
            (std::f64::consts::FRAC_PI_2, [0.0, 1.0, 0.0]),
        ] {
            let area = testing::pull_breaking(&law, direction, 30e-6, 400_000).area;
            let declared = law.fracture_energy(angle).unwrap();
            assert!((area / declared - 1.0).abs() < 1e-3, "{area} {declared}");
        }
    }
}
