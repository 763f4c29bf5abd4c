//! A linear elastic bond: traction (1 - D) k x.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, parameters};

parameters! {
    /// Linear bond that acts in tension and in shear; the contact carries compression. There the
    /// traction continues linearly, from which the host finds its zero; only the tensile part acts.
    pub struct ElasticBond {
        k_n: "Pa/m" = 1e14, 0.0, 1e30, "normal stiffness";
        k_t: "Pa/m" = 1e14, 0.0, 1e30, "tangential stiffness";
        d_n: "Pa s/m" = 0.0, 0.0, 1e30, "normal damping";
        d_t: "Pa s/m" = 0.0, 0.0, 1e30, "tangential damping";
    }
}

impl Law for ElasticBond {
    const NAME: &'static str = "elastic-bond";
    const DOC: &'static str =
        "linear elastic bond, traction (1 - D) k x, psi = (1 - D) (k_n <x_n>^2 + k_t |x_t|^2)/2";
    const REFERENCE: &'static str = "bond of BondedMohrCoulomb of MELODY: G. Mollon, Comput. Part. Mech. 5 (2018), doi:10.1007/s40571-018-0187-6";
    const FLAGS: u64 = abi::FLAG_TENSION_ONLY | abi::FLAG_OPENING | abi::FLAG_FORMS;
}

impl CohesionLaw for ElasticBond {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        let g = 1.0 - site.damage;
        Traction {
            damping_n: g * self.d_n,
            damping_t: g * self.d_t,
            ..Traction::linear(site, g * self.k_n, g * self.k_t)
        }
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let (n, [_, t1, t2]) = (site.normal_opening(), site.opening);
        bounded(0.5 * (1.0 - site.damage) * (self.k_n * n * n + self.k_t * (t1 * t1 + t2 * t2)))
    }
}
