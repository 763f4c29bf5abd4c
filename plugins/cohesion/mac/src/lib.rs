//! Monerie-Acary-Cangemi: sigma = beta^2 (C_N u_n n + C_T u_t), beta = 1 - D.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, export, parameters};

parameters! {
    /// Stiffness degrades with the square of the intensity of adhesion.
    pub struct Mac {
        c_n: "Pa/m" = 1e12, 0.0, 1e30, "normal stiffness C_N of the intact bond";
        c_t: "Pa/m" = 1e12, 0.0, 1e30, "tangential stiffness C_T of the intact bond";
    }
}

impl Law for Mac {
    const NAME: &'static str = "mac";
    const DOC: &'static str = "Monerie-Acary-Cangemi bond, traction (1 - D)^2 C x, psi = (1 - D)^2 (C_N <x_n>^2 + C_T |x_t|^2)/2";
    const REFERENCE: &'static str = "Y. Monerie, V. Acary, Rev. Eur. Elements Finis 10 (2001) 141-159; Raous, Cangemi, Cocou (1999)";
    const FLAGS: u64 = abi::FLAG_TENSION_ONLY | abi::FLAG_OPENING;
}

impl CohesionLaw for Mac {
    const DEGRADATION: f64 = 2.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        let g = (1.0 - site.damage) * (1.0 - site.damage);
        let [n, t1, t2] = site.opening;
        let (k_n, k_t) = (g * self.c_n, g * self.c_t);
        Traction {
            traction: [k_n * n, k_t * t1, k_t * t2],
            stiffness_n: k_n,
            stiffness_t: k_t,
            ..Traction::default()
        }
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        let beta = 1.0 - site.damage;
        let (n, t) = (site.normal_opening(), site.tangential_opening());
        0.5 * beta * beta * (self.c_n * n * n + self.c_t * t * t)
    }
}

export!(cohesion Mac);
