//! Friction that decreases with the sliding velocity: mu = mu_d + (mu_s - mu_d) exp(-V/V_s).
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters, require};

parameters! {
    /// Smooth decrease from mu_s at rest to mu_d at high velocity.
    pub struct VelocityWeakening {
        mu_s: "" = 0.4, 0.0, 1e6, "friction coefficient at rest", friction;
        mu_d: "" = 0.3, 0.0, 1e6, "friction coefficient at high velocity, at most mu_s", friction;
        v_s: "m/s" = 0.1, 1e-12, 1e6, "velocity over which it falls, V_s";
    }
}

impl Law for VelocityWeakening {
    const NAME: &'static str = "velocity-weakening";
    const DOC: &'static str = "mu_d + (mu_s - mu_d) exp(-V/V_s)";
    const REFERENCE: &'static str = "L. C. Bo, D. Pavelescu, Wear 82 (1982) 277-289, exponent 1";

    fn validate(&self) -> Result<(), String> {
        require(
            self.mu_d <= self.mu_s,
            "`mu_d` exceeds `mu_s`; this law weakens with velocity",
        )
    }
}

impl ContactLaw for VelocityWeakening {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let slip = site.sliding_speed();
        Friction::coulomb(self.mu_d + (self.mu_s - self.mu_d) * (-slip / self.v_s).exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::friction_at as at;

    #[test]
    fn falls_by_half_every_v_s_ln_2() {
        let law = VelocityWeakening {
            mu_s: 0.6,
            mu_d: 0.2,
            v_s: 0.5,
        };
        let step = 0.5 * core::f64::consts::LN_2;
        for (k, mu) in [0.6, 0.4, 0.3, 0.25, 0.225].into_iter().enumerate() {
            // Neither the direction of sliding nor the normal velocity matters.
            let v = step * k as f64;
            let (a, b) = (at(&law, [3.0, 0.6 * v, -0.8 * v]), at(&law, [0.0, -v, 0.0]));
            assert!((a - mu).abs() < 1e-14 && (b - mu).abs() < 1e-14);
        }
    }

    #[test]
    fn friction_at_speed_is_the_lower_one() {
        let law = VelocityWeakening::default();
        let swapped = VelocityWeakening {
            mu_s: 0.1,
            ..VelocityWeakening::default()
        };
        assert!(law.validate().is_ok() && swapped.validate().is_err());
    }
}
