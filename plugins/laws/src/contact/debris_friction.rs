//! Friction that debris between the bodies changes: from a coefficient of bare surfaces to that of
//! a layer of third body.
use fretwork_law::{ContactLaw, Friction, Law, Site, Variable, parameters};

parameters! {
    /// The defaults are of steel that is bare, and covered by its oxide; the thickness has no
    /// general value.
    pub struct DebrisFriction {
        mu_bare: "" = 0.4, 0.0, 1e6, "friction coefficient of bare surfaces", friction;
        mu_covered: "" = 0.6, 0.0, 1e6, "friction coefficient of a layer of debris", friction;
        thickness: "m" = 1e-6, 1e-12, 1e3, "debris, volume over area, that covers 63 % of the way between both";
    }
}

impl Law for DebrisFriction {
    const NAME: &'static str = "debris-friction";
    const DOC: &'static str = "mu_covered + (mu_bare - mu_covered) exp(-debris/thickness), with the debris that a patch under fretting keeps in each cell";
    const REFERENCE: &'static str = "third body: M. Godet, Wear 100 (1984) 437-452";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"debris",
        c"m",
        c"debris between the bodies, volume over area",
    )];
}

impl ContactLaw for DebrisFriction {
    fn friction(&self, _site: &Site, state: &[f64]) -> Friction {
        let bare = (-state[0].max(0.0) / self.thickness).exp();
        Friction::coulomb(self.mu_covered + (self.mu_bare - self.mu_covered) * bare)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debris_takes_friction_from_bare_to_covered() {
        let law = DebrisFriction {
            mu_bare: 0.3,
            mu_covered: 0.7,
            thickness: 2e-6,
        };
        let mu = |debris: f64| law.friction(&Site::default(), &[debris]).mu;
        assert_eq!(mu(0.0), 0.3);
        assert_eq!(mu(f64::MAX), 0.7);
        let half = 2e-6 * core::f64::consts::LN_2;
        assert!((mu(half) - 0.5).abs() < 1e-15);
    }
}
