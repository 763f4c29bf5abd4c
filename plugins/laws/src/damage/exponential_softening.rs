//! Exponential softening from a strength, with a given fracture energy.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// Beyond u_0 = strength/K the traction is strength exp(-(u - u_0)/l), with l from energy =
    /// strength u_0/2 + strength l. Below `left` times the strength the bond is broken; the tail
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
        // If the curve is cut earlier, the missing tail exceeds the tolerance of certification.
        (self.left <= 5e-3).then_some(self.energy)
    }
}

impl DamageLaw for ExponentialSoftening {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        intact.soften(site.damage, self.strength, |u, first| {
            let l = self.energy / self.strength - 0.5 * first;
            // A bond that stores more than the fracture energy at its strength breaks.
            let share = if l > 0.0 {
                (-(u - first) / l).exp()
            } else {
                0.0
            };
            (share > self.left).then_some(self.strength * share)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::pull;

    /// Returns the energy without the tail that is cut off, at a stiffness `k`.
    fn energy(law: &ExponentialSoftening, k: f64) -> f64 {
        law.energy - law.left * (law.energy - 0.5 * law.strength.powi(2) / k)
    }

    #[test]
    fn the_area_is_the_fracture_energy_less_the_tail() {
        let law = ExponentialSoftening::default();
        for (m, k) in [(1.0, 1e12), (2.0, 1e12), (2.0, 1e14)] {
            pull(&law, k, m, 20e-6, 400_000).took(energy(&law, k));
        }
    }

    /// The law is tested over the range of K of real interfaces: at K = 1e10 half of the energy is
    /// stored before the onset.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = ExponentialSoftening {
            strength: 1e5,
            energy: 1.0,
            left: 1e-3,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                pull(&law, k, m, 80e-6, 400_000).took(energy(&law, k));
            }
        }
    }
}
