//! Coulomb friction with rolling and spinning friction: |M_t| <= l_r p_n, |M_n| <= l_s p_n.
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};

parameters! {
    /// Each length is a constant plus a fraction of the reduced radius r1 r2/(r1 + r2), which is
    /// half the radius between equal bodies and the radius itself against a flat one.
    pub struct RollingFriction {
        mu: "" = 0.3, 0.0, 1e6, "friction coefficient", friction;
        rolling: "m" = 0.0, 0.0, 1e6, "constant part of the rolling friction length";
        spinning: "m" = 0.0, 0.0, 1e6, "constant part of the spinning friction length";
        rolling_factor: "" = 0.05, 0.0, 1e6, "rolling friction length over the reduced radius";
        spinning_factor: "" = 0.0, 0.0, 1e6, "spinning friction length over the reduced radius";
        restitution_n: "" = 0.0, 0.0, 1.0, "normal restitution (Newton)";
        restitution_t: "" = 0.0, 0.0, 1.0, "tangential restitution (Newton)";
    }
}

impl Law for RollingFriction {
    const NAME: &'static str = "rolling-friction";
    const DOC: &'static str = "Coulomb friction and moments up to a length times the normal force";
    const REFERENCE: &'static str =
        "N. Estrada, E. Azema, F. Radjai, A. Taboada, Phys. Rev. E 84 (2011) 011306";
}

impl ContactLaw for RollingFriction {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let radius = site.radius.max(0.0);
        let length = |part: f64, factor: f64| (part + factor * radius).min(f64::MAX);
        Friction {
            mu: self.mu,
            restitution_n: self.restitution_n,
            restitution_t: self.restitution_t,
            rolling: length(self.rolling, self.rolling_factor),
            spinning: length(self.spinning, self.spinning_factor),
            ..Friction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(law: &RollingFriction, radius: f64) -> Friction {
        let site = Site {
            radius,
            ..Site::default()
        };
        law.friction(&site, &[])
    }

    const LAW: RollingFriction = RollingFriction {
        mu: 0.4,
        rolling: 0.5,
        spinning: 0.25,
        rolling_factor: 0.125,
        spinning_factor: 2.0,
        restitution_n: 0.5,
        restitution_t: 0.1,
    };

    #[test]
    fn lengths_are_a_constant_and_a_share_of_the_radius() {
        let f = at(&LAW, 4.0);
        assert_eq!((f.mu, f.rolling, f.spinning), (0.4, 1.0, 8.25));
        assert_eq!((f.restitution_n, f.restitution_t), (0.5, 0.1));
        let point = at(&LAW, 0.0);
        assert_eq!((point.rolling, point.spinning), (0.5, 0.25));
    }
}
