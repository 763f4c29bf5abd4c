//! Monerie-Acary-Cangemi: sigma = beta^2 (C_N u_n n + C_T u_t), beta = 1 - D.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, parameters};

parameters! {
    /// Stiffness degrades with the square of the intensity of adhesion. In compression the traction
    /// continues linearly, from which the host finds its zero; only the tensile part acts.
    pub struct MacCohesion {
        c_n: "Pa/m" = 1e12, 0.0, 1e30, "normal stiffness C_N of the intact bond";
        c_t: "Pa/m" = 1e12, 0.0, 1e30, "tangential stiffness C_T of the intact bond";
    }
}

impl Law for MacCohesion {
    const NAME: &'static str = "mac";
    const DOC: &'static str = "Monerie-Acary-Cangemi bond, traction (1 - D)^2 C x, psi = (1 - D)^2 (C_N <x_n>^2 + C_T |x_t|^2)/2";
    const REFERENCE: &'static str = "Y. Monerie, V. Acary, Formulation dynamique d'un modele de zone cohesive tridimensionnel, Rev. Eur. Elements Finis 10 (2001); M. Raous, L. Cangemi, M. Cocou, Comput. Methods Appl. Mech. Engrg 177 (1999) 383-399";
    const FLAGS: u64 = abi::FLAG_TENSION_ONLY | abi::FLAG_OPENING | abi::FLAG_FORMS;
}

impl CohesionLaw for MacCohesion {
    const DEGRADATION: f64 = 2.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        let g = (1.0 - site.damage) * (1.0 - site.damage);
        Traction::linear(site, g * self.c_n, g * self.c_t)
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let beta = 1.0 - site.damage;
        let (n, [_, t1, t2]) = (site.normal_opening(), site.opening);
        bounded(0.5 * beta * beta * (self.c_n * n * n + self.c_t * (t1 * t1 + t2 * t2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(opening: [f64; 3], damage: f64) -> Site {
        Site {
            opening,
            damage,
            ..Site::default()
        }
    }

    /// Drives one bond with the b = 0 damage of the model, beta = w/(C u^2), and returns the
    /// traction.
    fn envelope(law: &MacCohesion, w: f64, u: f64) -> f64 {
        let beta = (w / (law.c_n * u * u)).min(1.0);
        law.traction(&at([u, 0.0, 0.0], 1.0 - beta), &[]).traction[0]
    }

    /// The peak traction is sqrt(w C_N) at u_0 = sqrt(w/C_N), and the area w (less w/200 beyond 10
    /// u_0), for C = 1e12 and w = 0.1.
    #[test]
    fn peak_and_area_are_closed_forms() {
        let (law, w) = (MacCohesion::default(), 0.1);
        let u0 = (w / law.c_n).sqrt();
        assert!((envelope(&law, w, u0) / 0.316228e6 - 1.0).abs() < 1e-6);
        let n = 100_000;
        let du = 10.0 * u0 / f64::from(n);
        let mut area = 0.0;
        let mut peak = 0.0f64;
        for k in 0..n {
            let sigma = envelope(&law, w, (f64::from(k) + 0.5) * du);
            area += sigma * du;
            peak = peak.max(sigma);
        }
        assert!((area / 0.099_5 - 1.0).abs() < 1e-4, "{area}");
        assert!((peak / 0.316228e6 - 1.0).abs() < 1e-3, "{peak}");
    }

    #[test]
    fn unloading_goes_to_the_origin_along_the_secant() {
        let law = MacCohesion::default();
        let full = law.traction(&at([1e-6, -2e-6, 5e-7], 0.4), &[]);
        let half = law.traction(&at([5e-7, -1e-6, 2.5e-7], 0.4), &[]);
        for (a, b) in full.traction.iter().zip(half.traction) {
            assert_eq!(*a, 2.0 * b);
        }
        assert_eq!(full.stiffness_n, half.stiffness_n);
    }
}
