//! A liquid bridge between two grains. It forms in contact, its force decreases with the gap, and
//! it breaks at a distance.
use fretwork_law::{CohesionLaw, Law, Site, Traction, Variable, parameters};

parameters! {
    /// Spheres: F = k R for gap <= 0 and k R exp(-gap/lambda) up to d_max = (1 + angle/2) V^(1/3),
    /// with k = 2 pi gamma cos(angle), R = sqrt(R_i R_j), here 2 r with r the reduced radius (exact
    /// for equal spheres), and lambda = 0.9/sqrt(2) sqrt(V/R). Disks: F = 2 gamma cos(angle) per
    /// length over d_max = (1 + angle/2) sqrt(V), V then the area of the bridge.
    pub struct CapillaryBridge {
        gamma: "N/m" = 0.072, 0.0, 1e30, "surface tension";
        angle: "rad" = 0.0, 0.0, 1.57, "contact angle";
        volume: "m^3" = 1e-18, 1e-40, 1e30, "volume of the bridge (m^2 in 2D)";
    }
}

impl Law for CapillaryBridge {
    const NAME: &'static str = "capillary-bridge";
    const DOC: &'static str = "liquid bridge that forms in contact and breaks at a distance";
    const REFERENCE: &'static str = "V. Richefeu, M. S. El Youssoufi, F. Radjai, Phys. Rev. E 73 (2006) 051304; rupture: G. Lian, C. Thornton, M. J. Adams, J. Colloid Interface Sci. 161 (1993) 138-147";
    const VARIABLES: &'static [Variable] =
        &[Variable::new(c"bridge", c"", c"1 while a bridge holds").written()];
}

impl CapillaryBridge {
    /// Gap at which the bridge breaks (m).
    fn rupture(&self, dimension: u32) -> f64 {
        let size = if dimension == 2 {
            self.volume.sqrt()
        } else {
            self.volume.cbrt()
        };
        (1.0 + 0.5 * self.angle) * size
    }

    fn force(&self, site: &Site) -> f64 {
        let pull = self.gamma * self.angle.cos();
        if site.dimension == 2 {
            return 2.0 * pull;
        }
        let r = 2.0 * site.radius.max(0.0);
        if r <= 0.0 {
            return 0.0;
        }
        // lambda must not be zero, since gap/lambda is 0/0 for huge grains.
        let lambda = (0.9 * std::f64::consts::FRAC_1_SQRT_2 * (self.volume / r).sqrt())
            .max(f64::MIN_POSITIVE);
        let fade = (-site.gap.max(0.0) / lambda).exp();
        (std::f64::consts::TAU * pull * r).min(f64::MAX) * fade
    }
}

impl CohesionLaw for CapillaryBridge {
    fn traction(&self, site: &Site, state: &[f64]) -> Traction {
        let holds = (state[0] > 0.5 && site.gap <= self.rupture(site.dimension)) || site.gap <= 0.0;
        if !(holds && site.area > 0.0) {
            return Traction::default();
        }
        Traction::attraction(self.force(site), site)
    }

    fn commit(&self, site: &Site, state: &mut [f64]) -> f64 {
        let holds = state[0] > 0.5 && site.gap <= self.rupture(site.dimension);
        state[0] = f64::from(u8::from(site.touches() || holds));
        site.damage
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_forms_in_contact_fades_and_breaks() {
        let law = CapillaryBridge::default();
        let (r, area) = (5e-5, 1e-9);
        let at = |gap: f64, bridge: f64| {
            let site = Site {
                gap,
                radius: 0.5 * r,
                area,
                dimension: 3,
                ..Site::default()
            };
            let pull = law.traction(&site, &[bridge]).tension_strength * area;
            let mut state = [bridge];
            law.commit(&site, &mut state);
            (pull, state[0])
        };
        assert_eq!(at(1e-8, 0.0), (0.0, 0.0));
        let full = std::f64::consts::TAU * 0.072 * r;
        let (force, bridge) = at(0.0, 0.0);
        assert!((force / full - 1.0).abs() < 1e-12 && bridge == 1.0);
        let lambda = 0.9 / 2f64.sqrt() * (1e-18f64 / r).sqrt();
        let (force, bridge) = at(lambda, 1.0);
        assert!((force / full * std::f64::consts::E - 1.0).abs() < 1e-9 && bridge == 1.0);
        // Here V^(1/3) = 1 um.
        assert_eq!(at(1.01e-6, 1.0), (0.0, 0.0));
    }
}
