//! Coulomb friction with Newton's restitution.
use fretwork_law::{ContactLaw, Friction, Law, Site, abi, parameters};

parameters! {
    /// |p_t| <= mu p_n, opposite to the sliding velocity; u+ = -e u- for closed contacts.
    pub struct Coulomb {
        mu: "" = 0.3, 0.0, f64::INFINITY, "friction coefficient", friction;
        restitution_n: "" = 0.0, 0.0, 1.0, "normal restitution (Newton)";
        restitution_t: "" = 0.0, 0.0, 1.0, "tangential restitution (Newton)";
    }
}

impl Law for Coulomb {
    const NAME: &'static str = "coulomb";
    const DOC: &'static str = "Coulomb friction with Newton's restitution";
    const REFERENCE: &'static str = "J. J. Moreau, Eur. J. Mech. A/Solids 13(4) (1994) 93-114";
    const FLAGS: u64 = abi::FLAG_CONSTANT;
}

impl ContactLaw for Coulomb {
    fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
        Friction {
            mu: self.mu,
            restitution_n: self.restitution_n,
            restitution_t: self.restitution_t,
            ..Friction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_its_parameters() {
        let law = Coulomb {
            mu: 0.4,
            restitution_n: 0.5,
            restitution_t: 0.1,
        };
        let f = law.friction(&Site::default(), &[]);
        assert_eq!((f.mu, f.restitution_n, f.restitution_t), (0.4, 0.5, 0.1));
    }
}
