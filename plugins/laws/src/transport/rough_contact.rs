//! Rough surfaces pressed together: they conduct through the spots that touch, and through the gas
//! in the gap.
use fretwork_law::{Conductance, Law, Site, TransportLaw, parameters, require};

parameters! {
    /// G/A = 1.25 k (m/sigma) (P/H)^0.95 + k_g/(d + Y + M), with the pressure P over the area A of
    /// the contact, k the conductivity of the pair, and d the gap. Where surfaces do not touch, the
    /// second term decreases linearly with the gap to zero at `reach`. The electrical conductance
    /// is the first term with 1/rho instead of k.
    pub struct RoughContact {
        roughness: "m" = 1e-6, 1e-300, 1e30, "sigma, root mean square height of both surfaces together";
        slope: "" = 0.1, 1e-12, 10.0, "m, mean absolute slope of both surfaces together";
        hardness: "Pa" = 2.6e9, 1e-300, 1e300, "H, hardness of the softer body";
        gas_conductivity: "W/(m K)" = 0.026, 0.0, 1e6, "k_g of what fills the gap: air; 0 for vacuum";
        separation: "m" = 3e-6, 0.0, 1e30, "Y, distance of the mean planes of surfaces that touch";
        rarefaction: "m" = 3.7e-7, 0.0, 1e30, "M, lengthening of the gap by the free path of the gas";
        reach: "m" = 1e-5, 1e-300, 1e30, "gap at which the gas conducts nothing";
    }
}

impl Law for RoughContact {
    const NAME: &'static str = "rough-contact";
    const DOC: &'static str =
        "constriction at the spots of rough surfaces in parallel with the gas in the gap";
    const REFERENCE: &'static str = "M. G. Cooper, B. B. Mikic, M. M. Yovanovich, Int. J. Heat Mass Transfer 12 (1969) 279-300; M. M. Yovanovich, IEEE Trans. Compon. Packag. Technol. 28 (2005) 182-206";

    fn validate(&self) -> Result<(), String> {
        require(
            self.separation + self.rarefaction > 0.0 || self.gas_conductivity == 0.0,
            "separation and rarefaction are both 0, so that the gas of a closed gap would conduct without bound; \
             give one of them",
        )
    }
}

impl TransportLaw for RoughContact {
    fn conductance(&self, site: &Site, _state: &mut [f64]) -> Conductance {
        // Beyond the hardness the surfaces touch everywhere.
        let pressed = (site.pressure() / self.hardness).min(1.0);
        let spots = 1.25 * self.slope / self.roughness * pressed.powf(0.95) * site.area;
        let gap = site.gap.max(0.0);
        let within = (1.0 - gap / self.reach).max(0.0);
        let length = gap + self.separation + self.rarefaction;
        let gas = match length > 0.0 {
            true => self.gas_conductivity / length * site.area * within,
            false => 0.0,
        };
        let electric = match site.resistivity > 0.0 {
            true => spots / site.resistivity,
            false => 0.0,
        };
        Conductance {
            thermal: site.conductivity * spots + gas,
            electric,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    /// At P/H = 1e-3 with m/sigma = 1e5 /m and k = 50 W/(m K) the spots have 1.25 50 1e5 1e-2.85 =
    /// 8828 W/(m^2 K), the gas has 0.026/3.37e-6 = 7715 W/(m^2 K).
    #[test]
    fn spots_and_gas_add() {
        let law = RoughContact::default();
        let mut site = Site {
            area: 1e-6,
            conductivity: 50.0,
            resistivity: 2e-7,
            ..compressed(2.6e6 * 1e-6)
        };
        let g = law.conductance(&site, &mut []);
        assert!(
            (g.thermal / 1e-6 / (8828.4 + 7715.1) - 1.0).abs() < 1e-4,
            "{g:?}"
        );
        assert!((g.electric / (8828.4e-6 / 50.0 / 2e-7) - 1.0).abs() < 1e-4);
        site.impulse[0] = 0.0;
        site.gap = 5e-6;
        let open = law.conductance(&site, &mut []);
        assert!((open.thermal / (0.5e-6 * 0.026 / 8.37e-6) - 1.0).abs() < 1e-12);
        assert_eq!(open.electric, 0.0);
    }
}
