//! Friction that grows as the bond is damaged.
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};

parameters! {
    /// |p_t| <= mu D p_n: an intact bond does not slide, a broken one has the full friction.
    pub struct CoulombDamage {
        mu: "" = 0.3, 0.0, f64::INFINITY, "friction coefficient of the broken contact", friction;
    }
}

impl Law for CoulombDamage {
    const NAME: &'static str = "coulomb-damage";
    const DOC: &'static str = "Coulomb friction mu (1 - beta), growing with the damage of the bond";
    const REFERENCE: &'static str =
        "M. Raous, L. Cangemi, M. Cocou, Comput. Methods Appl. Mech. Engrg 177 (1999) 383-399";
}

impl ContactLaw for CoulombDamage {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        Friction::coulomb(self.mu * site.damage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_is_mu_times_damage() {
        let law = CoulombDamage { mu: 0.4 };
        let at = |damage| {
            law.friction(
                &Site {
                    damage,
                    ..Site::default()
                },
                &[],
            )
            .mu
        };
        assert_eq!((at(0.0), at(0.5), at(1.0)), (0.0, 0.2, 0.4));
    }
}
