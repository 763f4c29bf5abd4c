//! MELODY's linear cohesive zone: from a limit to a residual traction at a limit opening.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters, require};

parameters! {
    /// In MELODY's own damage d, u_max(d) = (p_limit/K)(1 - d) + u_limit d carries p_limit (1 -
    /// d) + p_residual d. The traction thus decreases linearly from (p_limit/K, p_limit) to
    /// (u_limit, p_residual), where the bond breaks; D of the host is the loss of the secant
    /// stiffness, (1 - D)^m = traction/(K u).
    pub struct CzmLinear {
        p_limit: "Pa" = 1e6, 1e-30, 1e30, "traction at which damage begins";
        p_residual: "Pa" = 1e5, 0.0, 1e30, "traction at which the bond breaks";
        u_limit: "m" = 1e-5, 1e-30, 1e30, "opening at which it breaks";
    }
}

impl Law for CzmLinear {
    const NAME: &'static str = "czm-linear";
    const DOC: &'static str =
        "traction falls linearly to a residual one at a limit opening, where the bond breaks";
    const REFERENCE: &'static str = "law CZMlinear of MELODY: G. Mollon, Comput. Part. Mech. 5 (2018), doi:10.1007/s40571-018-0187-6";

    fn validate(&self) -> Result<(), String> {
        require(
            self.p_residual <= self.p_limit,
            "p_residual must not exceed p_limit",
        )
    }
}

impl DamageLaw for CzmLinear {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        intact.soften(site.damage, self.p_limit, |u, first| {
            if u >= self.u_limit || self.u_limit <= first {
                return None;
            }
            let d = (u - first) / (self.u_limit - first);
            Some(self.p_limit * (1.0 - d) + self.p_residual * d)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened};

    /// MELODY's secant stiffness at its damage d is (p_limit (1 - d) + p_residual d)/u_max(d).
    #[test]
    fn the_secant_is_melodys() {
        let law = CzmLinear::default();
        for (k, m) in [(1e12, 1.0), (1e13, 2.0)] {
            for d in [0.1, 0.5, 0.9] {
                let u = law.p_limit / k * (1.0 - d) + law.u_limit * d;
                let ours = Bond::new(&law, 0.0).lead(&opened(k, u, m));
                let secant = (law.p_limit * (1.0 - d) + law.p_residual * d) / u;
                assert!(((1.0 - ours).powf(m) * k / secant - 1.0).abs() < 1e-9);
            }
        }
    }

    /// The bond carries the residual traction up to the limit opening, where it breaks.
    #[test]
    fn it_breaks_at_the_limit_opening() {
        let law = CzmLinear::default();
        for m in [1.0, 2.0] {
            let at = |u: f64| Bond::new(&law, 0.0).lead(&opened(1e12, u, m));
            let u = law.u_limit * (1.0 - 1e-9);
            let carried = (1.0 - at(u)).powf(m) * 1e12 * u;
            assert!((carried / law.p_residual - 1.0).abs() < 1e-6, "{carried}");
            assert_eq!(at(law.u_limit * (1.0 + 1e-12)), 1.0);
            assert_eq!(at(0.999 * law.p_limit / 1e12), 0.0);
        }
    }
}
