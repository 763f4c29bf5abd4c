//! Mohr-Coulomb: |t_t| <= c + mu p, with p >= -tension: a permanent plastic strength, not a bond.
//!
//! Cohesion and tension act where surfaces touch, at gaps up to `range`. Farther apart the contact
//! follows Coulomb's law alone. Contacts are detected up to the alert distance, a numerical
//! parameter, on which the strength would depend without its own range. LMGC90's IQS_WET_DS_CLB has
//! an equal condition on the gap, with the thickness Wthk.
//!
//! The host's cone is |t_t| <= mu (p + c_n) + c_t with c_n the tension strength. The shear strength
//! at zero pressure is c if c_t = c - mu tension.
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};

parameters! {
    /// Friction, cohesion and a tension cut-off below the apex c/mu of the cone. The range is the
    /// distance at which surfaces touch: a roughness, or the thickness of a film.
    pub struct MohrCoulomb {
        mu: "" = 0.5, 0.0, 1e6, "friction coefficient, tangent of the friction angle", friction;
        cohesion: "Pa" = 1e5, 0.0, 1e30, "shear strength c without pressure";
        tension: "Pa" = 5e4, 0.0, 1e30, "tension cut-off, at most cohesion/mu";
        range: "m" = 1e-7, 0.0, 1e30, "largest gap over which cohesion and tension act";
    }
}

impl Law for MohrCoulomb {
    const NAME: &'static str = "mohr-coulomb";
    const DOC: &'static str =
        "|t_t| <= c + mu p with a tension cut-off; the strength stays when it slides";
    const REFERENCE: &'static str =
        "R. I. Borja, Plasticity: Modeling and Computation, Springer (2013); C. A. Coulomb (1773)";
    fn validate(&self) -> Result<(), String> {
        if self.mu * self.tension > self.cohesion {
            return Err(format!(
                "`tension` exceeds cohesion/mu = {:e} Pa, the apex of the cone",
                self.cohesion / self.mu
            ));
        }
        Ok(())
    }
}

impl ContactLaw for MohrCoulomb {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let (cohesion, tension) = match site.gap <= self.range {
            true => (self.cohesion, self.tension),
            false => (0.0, 0.0),
        };
        Friction {
            mu: self.mu,
            tension_strength: tension,
            shear_cohesion: (cohesion - self.mu * tension).max(0.0),
            ..Friction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The host's cone is the Mohr-Coulomb line: its strength is c at p = 0, c + mu p under
    /// pressure, and less in tension.
    #[test]
    fn is_the_line_of_mohr_and_coulomb() {
        let law = MohrCoulomb {
            mu: 0.5,
            cohesion: 10.0,
            tension: 8.0,
            range: 1e-6,
        };
        let f = law.friction(&Site::default(), &[]);
        let strength = |p: f64| f.mu * (p + f.tension_strength) + f.shear_cohesion;
        assert_eq!(f.tension_strength, 8.0);
        for (p, t) in [(0.0, 10.0), (100.0, 60.0), (-8.0, 6.0)] {
            assert_eq!(strength(p), t);
        }
    }

    /// Surfaces within the range hold, others slide by friction alone.
    #[test]
    fn the_strength_ends_with_the_range() {
        let law = MohrCoulomb {
            range: 2e-6,
            ..MohrCoulomb::default()
        };
        let at = |gap| {
            let site = Site {
                gap,
                ..Site::default()
            };
            let f = law.friction(&site, &[]);
            (f.mu, f.tension_strength > 0.0, f.shear_cohesion > 0.0)
        };
        for gap in [-1e-3, 0.0, 2e-6] {
            assert_eq!(at(gap), (0.5, true, true), "{gap}");
        }
        assert_eq!(at(2.1e-6), (0.5, false, false));
    }

    #[test]
    fn keeps_the_cut_off_below_the_apex() {
        let law = |mu, cohesion, tension| MohrCoulomb {
            mu,
            cohesion,
            tension,
            range: 1e-7,
        };
        assert!(law(0.5, 10.0, 20.0).validate().is_ok());
        assert!(law(0.5, 10.0, 20.1).validate().is_err());
        // Tresca's cylinder has no apex.
        assert!(law(0.0, 10.0, 1e30).validate().is_ok());
        assert!(MohrCoulomb::default().validate().is_ok());
        let f = law(1e6, 1e30, 1e30).friction(&Site::default(), &[]);
        assert!(f.shear_cohesion.is_finite() && f.shear_cohesion >= 0.0);
    }
}
