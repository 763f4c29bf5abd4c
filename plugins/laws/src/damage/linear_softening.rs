//! Linear softening from a strength to zero, with a given fracture energy.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// The traction decreases with the opening u from `strength` at u_0 = strength/K to zero at
    /// u_f = 2 energy/strength. If the bond is so compliant that u_f <= u_0 it breaks at the
    /// strength, and dissipates the stored energy strength^2/(2K).
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
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        intact.soften_linearly(site.damage, self.strength, self.energy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::pull;

    #[test]
    fn the_area_is_the_fracture_energy_for_any_exponent_and_stiffness() {
        let law = LinearSoftening::default();
        for m in [1.0, 2.0, 3.5] {
            for k in [1e12, 1e13, 1e14] {
                pull(&law, k, m, 4e-6, 200_000).took(law.energy);
            }
        }
    }

    #[test]
    fn a_soft_bond_snaps_at_the_strength() {
        // At K = 1e10, u_0 = 30 um is beyond u_f = 3.3 um.
        pull(&LinearSoftening::default(), 1e10, 1.0, 40e-6, 1_000_000).took(0.5 * 9e10 / 1e10);
    }

    /// The law is tested over the range of K of real interfaces: at K = 1e10 u_0 = 10 um is half of
    /// u_f.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = LinearSoftening {
            strength: 1e5,
            energy: 1.0,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                pull(&law, k, m, 25e-6, 400_000).took(law.energy);
            }
        }
    }
}
