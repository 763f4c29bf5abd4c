//! Brittle failure at a Mohr-Coulomb envelope with a tension cut-off.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// D becomes 1 at once when the traction of the undamaged bond leaves the strength envelope:
    /// t_n > tensile_strength, or |t_t| > cohesion + friction p, with p the pressure of this step.
    pub struct MohrCoulombBrittle {
        tensile_strength: "Pa" = 1e8, 0.0, 1e30, "normal traction at which the bond breaks";
        cohesion: "Pa" = 1e8, 0.0, 1e30, "shear traction at which it breaks without pressure";
        friction: "" = 0.5, 0.0, 100.0, "growth of the shear strength with the pressure";
    }
}

impl Law for MohrCoulombBrittle {
    const NAME: &'static str = "mohr-coulomb-brittle";
    const DOC: &'static str = "breaks when t_n > tensile_strength or |t_t| > cohesion + friction p";
    const REFERENCE: &'static str = "law BondedMohrCoulomb of MELODY: G. Mollon, Comput. Part. Mech. 5 (2018), doi:10.1007/s40571-018-0187-6";
}

impl DamageLaw for MohrCoulombBrittle {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        let [n, t1, t2] = intact.traction;
        let shear = t1.hypot(t2);
        let broken =
            n > self.tensile_strength || shear > self.cohesion + self.friction * site.pressure();
        if broken { 1.0 } else { site.damage }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    #[test]
    fn breaks_on_the_envelope() {
        let law = MohrCoulombBrittle {
            tensile_strength: 10.0,
            cohesion: 5.0,
            friction: 0.5,
        };
        let at = |t: [f64; 3], p: f64| {
            let site = compressed(p);
            let intact = Intact {
                traction: t,
                ..Intact::default()
            };
            law.grow(&site, &intact, &mut [])
        };
        assert_eq!(
            (at([9.9, 0.0, 0.0], 0.0), at([10.1, 0.0, 0.0], 0.0)),
            (0.0, 1.0)
        );
        assert_eq!(
            (at([0.0, 3.0, 4.1], 0.0), at([0.0, 3.0, 4.1], 1.0)),
            (1.0, 0.0)
        );
    }
}
