//! Static and dynamic friction: mu_s while the contact sticks, mu_d while it slides.
//!
//! Sticking is determined from the velocity (no internal variable): a contact sticks up to v_s,
//! since a solver leaves a small velocity. Above it the coefficient decreases along a ramp of width
//! v_r, since with a jump a contact near v_s would change its coefficient at every step. Choose v_r
//! above h (mu_s - mu_d) p_n/(h m), the change of velocity that the full decrease causes in one
//! step.
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters, require};

parameters! {
    /// mu_s for V <= v_s, mu_d for V >= v_s + v_r, linear in between.
    pub struct StaticDynamic {
        mu_s: "" = 0.4, 0.0, 1e6, "static friction coefficient", friction;
        mu_d: "" = 0.3, 0.0, 1e6, "dynamic friction coefficient, at most mu_s", friction;
        v_s: "m/s" = 1e-4, 0.0, 1e6, "tangential velocity up to which the contact sticks";
        v_r: "m/s" = 1e-4, 1e-12, 1e6, "width of the ramp from mu_s to mu_d, against chatter";
    }
}

impl Law for StaticDynamic {
    const NAME: &'static str = "static-dynamic";
    const DOC: &'static str = "mu_s while |u_t| <= v_s, mu_d from v_s + v_r on";
    const REFERENCE: &'static str =
        "D. Karnopp, J. Dyn. Syst. Meas. Control 107 (1985) 100-103, with a ramp for the jump";

    fn validate(&self) -> Result<(), String> {
        require(
            self.mu_d <= self.mu_s,
            "`mu_d` exceeds `mu_s`; dynamic friction is the lower one",
        )
    }
}

impl ContactLaw for StaticDynamic {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let slip = site.sliding_speed();
        let sliding = ((slip - self.v_s) / self.v_r).clamp(0.0, 1.0);
        Friction::coulomb(self.mu_s + (self.mu_d - self.mu_s) * sliding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::friction_at as at;

    #[test]
    fn is_static_then_a_ramp_then_dynamic() {
        let law = StaticDynamic {
            mu_s: 0.5,
            mu_d: 0.3,
            v_s: 1.0,
            v_r: 2.0,
        };
        assert_eq!(at(&law, [-9.0, 0.0, 0.0]), 0.5);
        assert_eq!(at(&law, [0.0, 0.6, 0.8]), 0.5);
        assert!((at(&law, [0.0, 0.0, -2.0]) - 0.4).abs() < 1e-15);
        assert!((at(&law, [0.0, 1.8, 2.4]) - 0.3).abs() < 1e-15);
        assert!((at(&law, [0.0, 1e3, 0.0]) - 0.3).abs() < 1e-15);
    }

    /// A block pulled by a force between both friction bounds stays at rest if it sticks and keeps
    /// sliding if it slides. A decelerating block comes to rest without its friction ever
    /// decreasing again.
    #[test]
    fn does_not_chatter() {
        let law = StaticDynamic::default();
        let (g, h) = (9.81, 1e-5);
        let run = |mut v: f64, pull: f64| {
            let (mut falls, mut last) = (0, 0.0);
            for _ in 0..100_000 {
                let mu = at(&law, [0.0, v, 0.0]);
                falls += usize::from(mu < last);
                last = mu;
                let free = v + h * g * pull;
                v = free.signum() * (free.abs() - h * g * mu).max(0.0);
            }
            (v, falls)
        };
        assert_eq!(run(0.0, 0.35), (0.0, 0));
        assert_eq!(run(0.1, 0.25), (0.0, 0));
        // While sliding, its velocity increases by (0.35 - 0.3) g in a second.
        let (v, falls) = run(0.01, 0.35);
        assert!((v - (0.01 + 0.05 * 9.81)).abs() < 1e-9 && falls == 0, "{v}");
    }

    #[test]
    fn dynamic_friction_is_the_lower_one() {
        let law = StaticDynamic::default();
        let swapped = StaticDynamic {
            mu_s: 0.1,
            ..StaticDynamic::default()
        };
        assert!(law.validate().is_ok() && swapped.validate().is_err());
    }
}
