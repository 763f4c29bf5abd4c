//! Quinn's oxidational wear: oxide grows on the spots that touch, and detaches at a critical
//! thickness.
use crate::GAS;
use fretwork_law::{Law, Site, WearLaw, abi, parameters};

parameters! {
    /// V = K F s/H with K = d A exp(-Q/(R_g T))/(f^2 rho^2 xi^2 U), at most 1: the fraction of
    /// encounters of a spot of diameter d, each of duration d/U, in which the oxide reaches the
    /// thickness xi. U is the sliding speed, T the temperature of the contact, including the flash
    /// temperature.
    pub struct Oxidation {
        arrhenius: "kg^2/(m^4 s)" = 1e6, 0.0, 1e60, "A, Arrhenius' constant of parabolic oxidation: of steel in Lim and Ashby's wear maps";
        activation: "J/mol" = 1.38e5, 0.0, 1e8, "Q, activation energy, as A";
        oxygen: "" = 0.2885, 1e-6, 1.0, "f, share of oxygen in the mass of the oxide: 0.2885 for Fe3O4 by Quinn";
        density: "kg/m^3" = 5.21e3, 1.0, 1e5, "rho of the oxide";
        thickness: "m" = 3e-6, 1e-12, 1.0, "xi, thickness at which the oxide comes off";
        spot: "m" = 1e-5, 1e-12, 1.0, "d, diameter of a spot that touches";
        hardness: "Pa" = 2.6e9, 1.0, 1e30, "H of the softer body";
    }
}

impl Law for Oxidation {
    const NAME: &'static str = "oxidation";
    const DOC: &'static str =
        "oxide that grows on spots by Arrhenius' law and comes off at a thickness";
    const REFERENCE: &'static str = "T. F. J. Quinn, Tribol. Int. 16 (1983) 257-271 and 305-315; A and Q of S. C. Lim, M. F. Ashby, Acta Metall. 35 (1987) 1-24";
    const FLAGS: u64 = abi::FLAG_TEMPERATURE;
}

impl WearLaw for Oxidation {
    fn volume(&self, site: &Site, _state: &mut [f64]) -> f64 {
        if site.slip <= 0.0 || site.h <= 0.0 {
            return 0.0;
        }
        let rate = self.arrhenius * (-self.activation / (GAS * site.temperature.max(1.0))).exp();
        let mass = self.oxygen * self.density * self.thickness;
        let encounter = self.spot * site.h / site.slip;
        let share = (encounter * rate / (mass * mass)).min(1.0);
        share * site.force() / self.hardness * site.slip
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    fn volume(law: &Oxidation, temperature: f64, slip: f64) -> f64 {
        let site = Site {
            temperature,
            slip,
            ..compressed(26.0)
        };
        law.volume(&site, &mut [])
    }

    /// K follows Arrhenius' law between two temperatures; below its bound the volume depends on the
    /// time, not on the slip.
    #[test]
    fn follows_arrhenius() {
        let law = Oxidation::default();
        let ratio = volume(&law, 700.0, 1.0) / volume(&law, 600.0, 1.0);
        let expected = (1.38e5 / GAS * (1.0 / 600.0 - 1.0 / 700.0)).exp();
        assert!((ratio / expected - 1.0).abs() < 1e-12);
        assert!((volume(&law, 600.0, 2.0) / volume(&law, 600.0, 1.0) - 1.0).abs() < 1e-12);
        // At the bound K = 1 the whole real contact area detaches.
        assert_eq!(volume(&law, 1e5, 1e-9), 26.0 / 2.6e9 * 1e-9);
        assert_eq!(volume(&law, 600.0, 0.0), 0.0);
    }
}
