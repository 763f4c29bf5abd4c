//! Newton's restitution for impacts, none for contacts at rest, and Coulomb friction.
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};

parameters! {
    /// u_n+ = -e_n u_n- if the bodies approach faster than v_min. Below it the contact is
    /// persistent, e = 0: the weight alone adds g h per step, and with restitution the contact
    /// would rattle without end.
    pub struct NewtonRestitution {
        e_n: "" = 0.8, 0.0, 1.0, "normal restitution";
        e_t: "" = 0.0, 0.0, 1.0, "tangential restitution, in impacts only";
        v_min: "m/s" = 1e-3, 0.0, 1e6, "approach velocity up to which both are zero; above g h";
        mu: "" = 0.3, 0.0, 1e6, "friction coefficient", friction;
    }
}

impl Law for NewtonRestitution {
    const NAME: &'static str = "newton-restitution";
    const DOC: &'static str = "Newton's restitution above an approach velocity, Coulomb friction";
    const REFERENCE: &'static str =
        "J. J. Moreau, in Nonsmooth Mechanics and Applications, CISM 302, Springer (1988) 1-82";
}

impl ContactLaw for NewtonRestitution {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        // A tangential restitution of resting contacts would reverse their sliding at every step,
        // so both restitutions depend on the approach velocity.
        let impact = -site.velocity[0] > self.v_min;
        let only = |e| if impact { e } else { 0.0 };
        Friction {
            mu: self.mu,
            restitution_n: only(self.e_n),
            restitution_t: only(self.e_t),
            ..Friction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(law: &NewtonRestitution, velocity: [f64; 3]) -> [f64; 3] {
        let site = Site {
            velocity,
            ..Site::default()
        };
        let f = law.friction(&site, &[]);
        [f.restitution_n, f.restitution_t, f.mu]
    }

    const LAW: NewtonRestitution = NewtonRestitution {
        e_n: 0.5,
        e_t: 0.25,
        v_min: 0.01,
        mu: 0.3,
    };

    #[test]
    fn acts_on_impacts_only() {
        assert_eq!(at(&LAW, [-0.0101, 0.0, 0.0]), [0.5, 0.25, 0.3]);
        assert_eq!(at(&LAW, [-0.01, 5.0, 5.0]), [0.0, 0.0, 0.3]);
        assert_eq!(at(&LAW, [3.0, 1.0, 0.0]), [0.0, 0.0, 0.3]);
    }

    /// A ball bounces e^(2 n) h_0 high, and rests as soon as it arrives slower than v_min.
    #[test]
    fn bounces_end() {
        let (mut v, mut bounces) = (-1.0f64, 0);
        while v != 0.0 {
            v *= at(&LAW, [v, 0.0, 0.0])[0];
            bounces += usize::from(v != 0.0);
        }
        // 0.5^6 = 0.0156 > 0.01 still bounces, 0.5^7 does not.
        assert_eq!(bounces, 7);
    }
}
