//! An elastic foundation: springs in tension, compression, shear and bending.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, parameters};

parameters! {
    /// Traction (1 - D) k x in tension and in compression, moment (1 - D) k_r theta over the area.
    /// The spring carries compression until the gap closes, so a bond formed at a gap g is
    /// compressed by g before the contact is rigid: grains at a gap over a first body are its
    /// compliant surface layer, like the bristles of a brush.
    pub struct ElasticFoundation {
        k_n: "Pa/m" = 1e13, 0.0, 1e30, "normal stiffness, both ways";
        k_t: "Pa/m" = 1e13, 0.0, 1e30, "tangential stiffness";
        k_r: "Pa m" = 0.0, 0.0, 1e30, "bending stiffness, moment over area and angle";
        d_n: "Pa s/m" = 0.0, 0.0, 1e30, "normal damping";
        d_t: "Pa s/m" = 0.0, 0.0, 1e30, "tangential damping";
    }
}

impl Law for ElasticFoundation {
    const NAME: &'static str = "elastic-foundation";
    const DOC: &'static str = "springs in tension, compression, shear and bending (Winkler), psi = (1 - D) (k_n x_n^2 + k_t |x_t|^2 + k_r |theta|^2)/2";
    const REFERENCE: &'static str =
        "K. L. Johnson, Contact Mechanics (1985), section 4.3; 8.3 and 8.6 for bristles that roll";
    const FLAGS: u64 = abi::FLAG_OPENING | abi::FLAG_MOMENT | abi::FLAG_FORMS;
}

impl CohesionLaw for ElasticFoundation {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        let g = 1.0 - site.damage;
        // The bond resists bending; rotation about the normal is free.
        let [_, b1, b2] = site.rotation;
        let bend = g * self.k_r;
        Traction {
            moment: [0.0, bend * b1, bend * b2].map(bounded),
            stiffness_bend: bend,
            damping_n: g * self.d_n,
            damping_t: g * self.d_t,
            ..Traction::linear(site, g * self.k_n, g * self.k_t)
        }
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let [n, t1, t2] = site.opening;
        let [_, b1, b2] = site.rotation;
        // The factors are multiplied one by one, since a square may overflow where its product with
        // a zero is zero.
        let bent = self.k_r * b1 * b1 + self.k_r * b2 * b2;
        let moved = self.k_n * n * n + self.k_t * t1 * t1 + self.k_t * t2 * t2;
        bounded(0.5 * (1.0 - site.damage) * (moved + bent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moment_is_the_slope_of_the_energy() {
        let law = ElasticFoundation {
            k_r: 3.0,
            ..ElasticFoundation::default()
        };
        fretwork_law::testing::traction_is_the_slope_of_the_energy(&law);
    }
}
