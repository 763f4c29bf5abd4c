//! Exponential softening from a strength, with a given fracture energy.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// traction = strength exp(-(u - u_0)/l) beyond u_0 = strength/K, with l from
    /// energy = strength u_0/2 + strength l. Below `left` times the strength the bond is broken; the tail
    /// that is cut off has the energy left (energy - strength u_0/2).
    pub struct ExponentialSoftening {
        strength: "Pa" = 3e5, 1e-30, 1e30, "traction at which damage begins";
        energy: "J/m^2" = 0.5, 1e-30, 1e30, "fracture energy, the area under the curve";
        left: "" = 1e-3, 0.0, 0.5, "share of the strength below which the bond is broken";
    }
}

impl Law for ExponentialSoftening {
    const NAME: &'static str = "exponential-softening";
    const DOC: &'static str =
        "traction falls exponentially from the strength, area = fracture energy";
    const REFERENCE: &'static str = "M. Ortiz, A. Pandolfi, Int. J. Numer. Methods Eng. 44 (1999) 1267-1282 (history by secant unloading); exponential softening as in J. Oliver et al., Eng. Fract. Mech. 69 (2002) 113-136";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        // If cut earlier, the missing tail exceeds the tolerance of certification.
        (self.left <= 5e-3).then_some(self.energy)
    }
}

impl DamageLaw for ExponentialSoftening {
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.strength {
            return site.damage;
        }
        let first = self.strength / k;
        let l = self.energy / self.strength - 0.5 * first;
        // A bond that stores more than the fracture energy at its strength breaks.
        let share = if l > 0.0 {
            (-(u - first) / l).exp()
        } else {
            0.0
        };
        if share <= self.left {
            return 1.0;
        }
        intact.damage_for(self.strength * share).max(site.damage)
    }
}

export!(damage ExponentialSoftening);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    #[test]
    fn the_area_is_the_fracture_energy_less_the_tail() {
        let law = ExponentialSoftening::default();
        for (m, k) in [(1.0, 1e12), (2.0, 1e12), (2.0, 1e14)] {
            let pull = testing::pull(&law, k, m, 20e-6, 400_000);
            let first = law.strength / k;
            let tail = law.left * (law.energy - 0.5 * law.strength * first);
            assert!(
                (pull.area / (law.energy - tail) - 1.0).abs() < 1e-4,
                "{m} {k}: {pull:?}"
            );
            assert_eq!(pull.damage, 1.0);
        }
    }

    /// Over the range of K of real interfaces: at K = 1e10 half of the energy is stored before the onset.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = ExponentialSoftening {
            strength: 1e5,
            energy: 1.0,
            left: 1e-3,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                let pull = testing::pull(&law, k, m, 80e-6, 400_000);
                let tail = law.left * (law.energy - 0.5 * law.strength.powi(2) / k);
                assert!(
                    (pull.area / (law.energy - tail) - 1.0).abs() < 1e-4,
                    "{m} {k}: {pull:?}"
                );
                assert_eq!(pull.damage, 1.0);
            }
        }
    }

    #[test]
    fn extremes_stay_in_range() {
        testing::damage_stays_in_range::<ExponentialSoftening>();
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        testing::damage_never_falls(&ExponentialSoftening::default());
    }
}
