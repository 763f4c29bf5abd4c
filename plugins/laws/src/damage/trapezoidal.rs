//! A plateau at the strength, then linear softening: the trapezoid of ductile interfaces.
use crate::trapezoid::Trapezoid;
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// From u_0 = strength/K the traction has a plateau to u_p, then decreases linearly to zero at
    /// u_f; energy = strength (u_f + u_p - u_0)/2. `plateau` places u_p between u_0 and the end of
    /// the longest plateau that the energy allows, u_0/2 + energy/strength (where u_f = u_p). A
    /// bond that stores more than the energy at its strength breaks.
    pub struct Trapezoidal {
        strength: "Pa" = 3e5, 1e-30, 1e30, "traction of the plateau";
        energy: "J/m^2" = 0.5, 1e-30, 1e30, "fracture energy, the area under the curve";
        plateau: "" = 0.5, 0.0, 1.0, "length of the plateau: 0 none, 1 all of the energy";
    }
}

impl Law for Trapezoidal {
    const NAME: &'static str = "trapezoidal";
    const DOC: &'static str = "plateau at the strength, then a linear fall, area = fracture energy";
    const REFERENCE: &'static str =
        "V. Tvergaard, J. W. Hutchinson, J. Mech. Phys. Solids 40 (1992) 1377-1397";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        Some(self.energy)
    }
}

impl DamageLaw for Trapezoidal {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        intact.soften(site.damage, self.strength, |u, first| {
            let curve = Trapezoid::new(first, self.energy / self.strength, self.plateau);
            Some(self.strength * curve.share(u)?)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::pull;

    #[test]
    fn the_area_is_the_fracture_energy_for_any_plateau() {
        for plateau in [0.0, 0.3, 1.0] {
            let law = Trapezoidal {
                plateau,
                ..Trapezoidal::default()
            };
            for (m, k) in [(1.0, 1e12), (2.0, 1e13)] {
                pull(&law, k, m, 4e-6, 200_000).took(law.energy);
            }
        }
    }

    /// The law is tested over the range of K of real interfaces: at K = 1e10 u_0 = 10 um is half of
    /// u_f.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = Trapezoidal {
            strength: 1e5,
            energy: 1.0,
            plateau: 0.4,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                pull(&law, k, m, 25e-6, 400_000).took(law.energy);
            }
        }
    }
}
