//! A linear spring along the normal and one along the tangent, damped, with Coulomb friction.
use fretwork_law::{ContactLaw, Friction, Law, Site, Spring, abi, damping_ratio, parameters};

parameters! {
    /// Normal force F = k d for an overlap d; the tangential force grows with k_t and slips at mu
    /// F.
    pub struct LinearContact {
        stiffness: "N/m" = 1e6, 1e-300, 1e300, "normal stiffness k; in 2D per metre of depth (N/m^2)";
        ratio: "" = 0.8, 0.0, 1e3, "tangential over normal stiffness; 0: no tangential displacement before slip";
        restitution: "" = 1.0, 0.0, 1.0, "share of the approach velocity with which two bodies part";
        mu: "" = 0.3, 0.0, 1e6, "friction coefficient", friction;
    }
}

impl Law for LinearContact {
    const NAME: &'static str = "linear-contact";
    const DOC: &'static str = "linear springs at contacts, with damping and Coulomb friction";
    const REFERENCE: &'static str = "P. A. Cundall, O. D. L. Strack, Geotechnique 29 (1979) 47-65; damping: T. Schwager, T. Poschel, Granular Matter 9 (2007) 465-469";
    const FLAGS: u64 = abi::FLAG_COMPLIANT;
}

impl ContactLaw for LinearContact {
    fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
        Friction::coulomb(self.mu)
    }

    fn spring(&self, site: &Site, _state: &[f64], damping: f64) -> Spring {
        Spring::linear(site, self.stiffness, self.ratio, damping)
    }

    fn damping(&self) -> f64 {
        damping_ratio(self.restitution)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass on the spring, integrated by 20,000 steps of the velocity Verlet scheme, separates
    /// with the required restitution when its force is zero.
    #[test]
    fn impacts_rebound_as_asked() {
        for restitution in [0.05, 0.3, 0.6, 0.9, 1.0] {
            let law = LinearContact {
                stiffness: 4e5,
                ratio: 0.8,
                restitution,
                mu: 0.0,
            };
            let (m, mut x, mut v) = (0.2, 0.0, -1.0);
            let h = 1e-4 * (m / law.stiffness).sqrt();
            loop {
                let site = Site {
                    overlap: -x,
                    effective_mass: m,
                    ..Site::default()
                };
                let s = law.spring(&site, &[], law.damping());
                let force = s.force_n - s.damping_n * v;
                if force < 0.0 {
                    break;
                }
                v += h * force / m;
                x += h * v;
            }
            assert!((v - restitution).abs() < 2e-3, "{restitution}: {v}");
        }
    }
}
