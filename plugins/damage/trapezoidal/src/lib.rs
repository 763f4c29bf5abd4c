//! A plateau at the strength, then linear softening: the trapezoid of ductile interfaces.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// From u_0 = strength/K a plateau to u_p, then linear to u_f; energy = strength (u_f + u_p - u_0)/2.
    /// `plateau` places u_p between u_0 and the longest plateau that the energy allows,
    /// u_0/2 + energy/strength (where u_f = u_p). A bond that stores more than the energy at its strength breaks.
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
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.strength {
            return site.damage;
        }
        let first = self.strength / k;
        let longest = 0.5 * first + self.energy / self.strength;
        let end = first + self.plateau * (longest - first);
        let last = 2.0 * self.energy / self.strength + first - end;
        if longest <= first || u >= last {
            return 1.0;
        }
        let share = if u <= end {
            1.0
        } else {
            (last - u) / (last - end)
        };
        intact.damage_for(self.strength * share).max(site.damage)
    }
}

export!(damage Trapezoidal);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    #[test]
    fn the_area_is_the_fracture_energy_for_any_plateau() {
        for plateau in [0.0, 0.3, 1.0] {
            let law = Trapezoidal {
                plateau,
                ..Trapezoidal::default()
            };
            for (m, k) in [(1.0, 1e12), (2.0, 1e13)] {
                let pull = testing::pull(&law, k, m, 4e-6, 200_000);
                assert!(
                    (pull.area / law.energy - 1.0).abs() < 1e-4,
                    "{plateau} {m}: {pull:?}"
                );
                assert_eq!(pull.damage, 1.0);
            }
        }
    }

    /// Over the range of K of real interfaces: at K = 1e10 u_0 = 10 um is half of u_f.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = Trapezoidal {
            strength: 1e5,
            energy: 1.0,
            plateau: 0.4,
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
        testing::damage_stays_in_range::<Trapezoidal>();
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        testing::damage_never_falls(&Trapezoidal::default());
    }
}
