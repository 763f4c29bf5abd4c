//! Friction of wheel on rail, decreasing with the slip velocity: mu = mu_0 ((1 - A) exp(-B w) + A).
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};

parameters! {
    /// The defaults are Polach's for a dry rail; for a wet one he gives mu_0 0.30, a 0.40, b 0.20.
    pub struct RailFallingFriction {
        mu_0: "" = 0.55, 0.0, 1e6, "friction coefficient without slip", friction;
        a: "" = 0.40, 0.0, 1.0, "A, friction at infinite slip over mu_0";
        b: "s/m" = 0.60, 0.0, 1e12, "B, decay with the slip velocity";
    }
}

impl Law for RailFallingFriction {
    const NAME: &'static str = "rail-falling-friction";
    const DOC: &'static str = "mu_0 ((1 - A) exp(-B w) + A), w the slip velocity";
    const REFERENCE: &'static str = "O. Polach, Wear 258 (2005) 992-1000";
}

impl ContactLaw for RailFallingFriction {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        // An infinite w with B = 0 would give NaN.
        let slip = site.sliding_speed().min(f64::MAX);
        Friction::coulomb(self.mu_0 * ((1.0 - self.a) * (-self.b * slip).exp() + self.a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::friction_at as at;

    #[test]
    fn falls_from_mu_0_to_a_mu_0() {
        let law = RailFallingFriction {
            mu_0: 0.5,
            a: 0.4,
            b: 2.0,
        };
        assert_eq!(at(&law, [-7.0, 0.0, 0.0]), 0.5);
        assert_eq!(at(&law, [0.0, 1e6, 0.0]), 0.2);
        // Half of the decrease is reached at w = ln 2/B.
        let w = core::f64::consts::LN_2 / 2.0;
        assert!((at(&law, [0.0, -0.6 * w, 0.8 * w]) - 0.35).abs() < 1e-15);
        // The slope at rest is -B (1 - A) mu_0.
        let slope = (at(&law, [0.0, 1e-6, 0.0]) - 0.5) / 1e-6;
        assert!((slope + 0.6).abs() < 1e-5);
    }

    #[test]
    fn is_finite_everywhere() {
        for b in [0.0, 0.6, 1e12] {
            let law = RailFallingFriction {
                b,
                ..RailFallingFriction::default()
            };
            for v in [0.0, 1e-320, -1e300, f64::MAX] {
                assert!(at(&law, [v; 3]).is_finite());
            }
        }
    }
}
