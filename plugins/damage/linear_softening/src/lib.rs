//! Linear softening from a strength to zero, with a given fracture energy.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// The traction decreases with the opening u from `strength` at u_0 = strength/K to zero at
    /// u_f = 2 energy/strength. If the bond is so compliant that u_f <= u_0 it breaks at the strength, and
    /// dissipates the stored energy strength^2/(2K).
    pub struct LinearSoftening {
        strength: "Pa" = 3e5, 1e-30, 1e30, "traction at which damage begins";
        energy: "J/m^2" = 0.5, 1e-30, 1e30, "fracture energy, the area under the curve";
    }
}

impl Law for LinearSoftening {
    const NAME: &'static str = "linear-softening";
    const DOC: &'static str =
        "traction falls linearly from the strength to zero, area = fracture energy";
    const REFERENCE: &'static str = "A. Hillerborg, M. Modeer, P.-E. Petersson, Cem. Concr. Res. 6 (1976) 773-781; bilinear law of P. H. Geubelle, J. S. Baylor, Compos. B 29 (1998) 589-602";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        Some(self.energy)
    }
}

impl DamageLaw for LinearSoftening {
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.strength {
            return site.damage;
        }
        let (first, last) = (self.strength / k, 2.0 * self.energy / self.strength);
        if u >= last || last <= first {
            return 1.0;
        }
        let traction = self.strength * ((last - u) / (last - first));
        intact.damage_for(traction).max(site.damage)
    }
}

export!(damage LinearSoftening);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    #[test]
    fn the_area_is_the_fracture_energy_for_any_exponent_and_stiffness() {
        let law = LinearSoftening::default();
        for m in [1.0, 2.0, 3.5] {
            for k in [1e12, 1e13, 1e14] {
                let pull = testing::pull(&law, k, m, 4e-6, 200_000);
                assert!(
                    (pull.area / law.energy - 1.0).abs() < 1e-4,
                    "{m} {k}: {pull:?}"
                );
                assert_eq!(pull.damage, 1.0);
            }
        }
    }

    #[test]
    fn a_soft_bond_snaps_at_the_strength() {
        let law = LinearSoftening::default();
        // K = 1e10: u_0 = 30 um is beyond u_f = 3.3 um.
        let pull = testing::pull(&law, 1e10, 1.0, 40e-6, 100_000);
        assert!(
            (pull.area / (0.5 * 9e10 / 1e10) - 1.0).abs() < 1e-3,
            "{pull:?}"
        );
        assert_eq!(pull.damage, 1.0);
    }

    /// Over the range of K of real interfaces: at K = 1e10 u_0 = 10 um is half of u_f.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = LinearSoftening {
            strength: 1e5,
            energy: 1.0,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                let pull = testing::pull(&law, k, m, 25e-6, 400_000);
                assert!(
                    (pull.area / law.energy - 1.0).abs() < 1e-4,
                    "{m} {k}: {pull:?}"
                );
                assert_eq!(pull.damage, 1.0);
            }
        }
    }

    #[test]
    fn extremes_stay_in_range() {
        testing::damage_stays_in_range::<LinearSoftening>();
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        testing::damage_never_falls(&LinearSoftening::default());
    }
}
