//! Tvergaard and Hutchinson's trapezoid: elastic, plateau, linear softening. It breaks without a
//! damage law.
use crate::trapezoid::Trapezoid;
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, parameters, require};

parameters! {
    /// For the opening u = sqrt(<u_n>^2 + |u_t|^2): K u to u_i = strength/K, the strength to u_p,
    /// then linear to u_u; energy = strength (u_u + u_p - u_i)/2. `u_p` = u_i + plateau
    /// (u_longest - u_i), where the longest plateau that the energy allows ends at u_i/2 +
    /// energy/strength. Unloading is to the origin.
    pub struct TvergaardHutchinson {
        k: "Pa/m" = 1e13, 1.0, 1e30, "stiffness, the same in both directions";
        strength: "Pa" = 1e6, 1e-30, 1e30, "traction of the plateau";
        energy: "J/m^2" = 5.0, 1e-30, 1e30, "fracture energy";
        plateau: "" = 0.5, 0.0, 1.0, "length of the plateau: 0 none, 1 all of the energy";
    }
}

impl Law for TvergaardHutchinson {
    const NAME: &'static str = "tvergaard-hutchinson";
    const DOC: &'static str =
        "trapezoidal cohesion that breaks by itself, energy = s (u_u + u_p - u_i)/2";
    const REFERENCE: &'static str =
        "V. Tvergaard, J. W. Hutchinson, J. Mech. Phys. Solids 40 (1992) 1377-1397";
    const FLAGS: u64 =
        abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_BREAKS | abi::FLAG_FORMS;

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        Some(self.energy)
    }

    fn validate(&self) -> Result<(), String> {
        let squared = self.strength * self.strength;
        require(
            squared < 2.0 * self.k * self.energy,
            "strength^2/(2 k) must be below the energy: the elastic part alone holds more",
        )?;
        // On the plateau 1 - D is strength/(k u). Below about 1e-12 it would be lost by round-off
        // relative to 1.
        require(
            squared >= 1e-12 * self.k * self.energy,
            "k is so high that 1 - D cannot be distinguished from 0: lower k, or raise the strength",
        )
    }
}

impl CohesionLaw for TvergaardHutchinson {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        Traction::damaged(site, self.k)
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        Traction::damaged_energy(site, self.k)
    }

    fn commit(&self, site: &Site, _state: &mut [f64]) -> f64 {
        let u = site.effective_opening();
        let first = self.strength / self.k;
        if u <= first {
            return site.damage;
        }
        let curve = Trapezoid::new(first, self.energy / self.strength, self.plateau);
        match curve.share(u) {
            Some(share) => (1.0 - share * first / u).max(site.damage),
            None => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    #[test]
    fn the_trapezoid_has_its_corners_and_its_area() {
        for plateau in [0.0, 0.5, 1.0] {
            let law = TvergaardHutchinson {
                plateau,
                ..TvergaardHutchinson::default()
            };
            let pull = testing::pull_breaking(&law, [0.6, 0.8, 0.0], 12e-6, 200_000);
            assert!(
                (pull.area / law.energy - 1.0).abs() < 1e-4,
                "{plateau}: {pull:?}"
            );
            // A step may not hit the corner exactly.
            assert!((pull.peak / law.strength - 1.0).abs() < 1e-3);
            assert_eq!(pull.damage, 1.0);
        }
    }
}
