//! Unilateral contact without friction.
use fretwork_law::{ContactLaw, Friction, Law, Site, abi, parameters};

parameters! {
    /// Contact that follows Signorini's condition only.
    pub struct Frictionless {
        restitution_n: "" = 0.0, 0.0, 1.0, "normal restitution (Newton)";
    }
}

impl Law for Frictionless {
    const NAME: &'static str = "frictionless";
    const DOC: &'static str = "unilateral contact without friction";
    const REFERENCE: &'static str = "M. Jean, Comput. Methods Appl. Mech. Engrg 177 (1999) 235-257";
    const FLAGS: u64 = abi::FLAG_CONSTANT;
}

impl ContactLaw for Frictionless {
    fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
        Friction {
            restitution_n: self.restitution_n,
            ..Friction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_its_parameters() {
        let law = Frictionless { restitution_n: 0.5 };
        let f = law.friction(&Site::default(), &[]);
        assert_eq!((f.mu, f.restitution_n, f.tension_strength), (0.0, 0.5, 0.0));
    }
}
