//! Heat and current through the contact circle of two elastic spheres: G = 2 k a, with Hertz'
//! radius a.
use fretwork_law::{Conductance, Law, Site, TransportLaw, parameters};
use std::f64::consts::PI;

parameters! {
    /// G = 2 k a with k = 2 k_1 k_2/(k_1 + k_2) and a = (3 F R/(4 E*))^(1/3), R the reduced radius,
    /// 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2. In 2D the spreading resistance of a cylinder is
    /// not finite. The resistance is therefore counted from the strip of half-width a = (4 F R/(pi
    /// E*))^(1/2) to the distance 2 R on either side, the radius of equal cylinders: G = pi k/(2
    /// asinh(2 R/a)) per metre of depth. The electrical conductance has 1/rho instead of k, rho =
    /// (rho_1 + rho_2)/2.
    pub struct BatchelorObrien {
        young_1: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the first material";
        poisson_1: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the first material";
        young_2: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the second material";
        poisson_2: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the second material";
    }
}

impl Law for BatchelorObrien {
    const NAME: &'static str = "batchelor-obrien";
    const DOC: &'static str =
        "2 k a through Hertz' contact radius a (in 2D a strip, to the distance of the radius)";
    const REFERENCE: &'static str = "G. K. Batchelor, R. W. O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313-333; W. L. Vargas, J. J. McCarthy, AIChE J. 47 (2001) 1052-1059";
}

impl BatchelorObrien {
    /// Half-width of the contact (m).
    fn half_width(&self, site: &Site) -> f64 {
        let compliance = (1.0 - self.poisson_1 * self.poisson_1) / self.young_1
            + (1.0 - self.poisson_2 * self.poisson_2) / self.young_2;
        let squeezed = site.force() * site.radius * compliance;
        match site.dimension {
            2 => (4.0 / PI * squeezed).sqrt(),
            _ => (0.75 * squeezed).cbrt(),
        }
    }
}

impl TransportLaw for BatchelorObrien {
    fn conductance(&self, site: &Site, _state: &mut [f64]) -> Conductance {
        site.through_spot(self.half_width(site))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    fn site(force: f64, dimension: u32) -> Site {
        Site {
            radius: 0.5e-3,
            conductivity: 50.0,
            resistivity: 2e-7,
            dimension,
            ..compressed(force)
        }
    }

    /// For two spheres of 1 mm and 210 GPa under 1 N, a = (3/4 1 N 0.5 mm/115.4 GPa)^(1/3) = 14.81
    /// um.
    #[test]
    fn spheres_conduct_through_hertz_circle() {
        let law = BatchelorObrien::default();
        let g = law.conductance(&site(1.0, 3), &mut []);
        assert!(
            (g.thermal / (2.0 * 50.0 * 1.4813e-5) - 1.0).abs() < 1e-4,
            "{g:?}"
        );
        assert!((g.electric / (2.0 * 1.4813e-5 / 2e-7) - 1.0).abs() < 1e-4);
        let eight = law.conductance(&site(8.0, 3), &mut []);
        assert!((eight.thermal / g.thermal - 2.0).abs() < 1e-12);
        assert_eq!(law.conductance(&site(0.0, 3), &mut []).thermal, 0.0);
    }

    /// The conductance of a narrow strip in 2D is pi k/(2 ln(4 R/a)).
    #[test]
    fn cylinders_conduct_through_a_strip() {
        let law = BatchelorObrien::default();
        let here = site(1e3, 2);
        let a = law.half_width(&here);
        let g = law.conductance(&here, &mut []).thermal;
        let narrow = PI * 50.0 / (2.0 * (4.0 * here.radius / a).ln());
        assert!((g / narrow - 1.0).abs() < 1e-4, "{g} {narrow}");
    }
}
