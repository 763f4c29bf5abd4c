//! MELODY's linear cohesive zone: from a limit to a residual traction at a limit opening.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// In MELODY's own damage d, u_max(d) = (p_limit/K)(1 - d) + u_limit d carries p_limit (1 - d) +
    /// p_residual d. So the traction falls on a line from (p_limit/K, p_limit) to (u_limit, p_residual), where
    /// the bond breaks; D of the host is the loss of the secant stiffness, (1 - D)^m = traction/(K u).
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
        if self.p_residual > self.p_limit {
            return Err("p_residual must not exceed p_limit".into());
        }
        Ok(())
    }
}

impl DamageLaw for CzmLinear {
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.p_limit {
            return site.damage;
        }
        let first = self.p_limit / k;
        if u >= self.u_limit || self.u_limit <= first {
            return 1.0;
        }
        let d = (u - first) / (self.u_limit - first);
        let traction = self.p_limit * (1.0 - d) + self.p_residual * d;
        intact.damage_for(traction).max(site.damage)
    }
}

export!(damage CzmLinear);

#[cfg(test)]
mod tests {
    use super::*;

    /// MELODY's secant at its damage d: (p_limit (1 - d) + p_residual d)/u_max(d).
    #[test]
    fn the_secant_is_melodys() {
        let law = CzmLinear::default();
        for (k, m) in [(1e12, 1.0), (1e13, 2.0)] {
            for d in [0.1, 0.5, 0.9] {
                let u = law.p_limit / k * (1.0 - d) + law.u_limit * d;
                let intact = Intact {
                    energy: 0.5 * k * u * u,
                    traction: [k * u, 0.0, 0.0],
                    degradation: m,
                    ..Intact::default()
                };
                let ours = law.grow(&Site::default(), &intact, &[], &mut []);
                let secant = (law.p_limit * (1.0 - d) + law.p_residual * d) / u;
                assert!(((1.0 - ours).powf(m) * k / secant - 1.0).abs() < 1e-9);
            }
        }
    }

    /// Any finite bond, the least and the most of every parameter: D in [D_i, 1], variables finite.
    #[test]
    fn extremes_stay_in_range() {
        use fretwork_law::Parameters;
        let sizes = [0.0, 1e-300, 1e-12, 1e-3, 1.0, 1e5, 1e6, 1e30, 1e300];
        let damages = [0.0, 0.4, 1.0 - 1e-16, 1.0];
        for end in 0..3 {
            let values = CzmLinear::FIELDS
                .iter()
                .map(|f| [f.default, f.minimum, f.maximum][end]);
            let law = CzmLinear::read(&values.collect::<Vec<f64>>());
            for case in 0..9 * 9 * 9 * 4 * 4 {
                let (energy, t, s) = (sizes[case % 9], sizes[case / 9 % 9], sizes[case / 81 % 9]);
                let intact = Intact {
                    energy,
                    traction: [-t, t, t],
                    degradation: [0.5, 1.0, 2.0, 9.0][case / 729 % 4],
                    ..Intact::default()
                };
                let site = Site {
                    damage: damages[case / 2916],
                    h: s,
                    ..Site::default()
                };
                let mut next = [s; 0];
                let d = law.grow(&site, &intact, &[s; 0], &mut next);
                assert!(d >= site.damage && d <= 1.0, "{law:?} {intact:?} {s}: {d}");
                assert!(next.iter().all(|x| x.is_finite()), "{law:?} {intact:?}");
            }
        }
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        let law = CzmLinear::default();
        let (mut seed, mut u) = (1u64, 0.0f64);
        for m in [0.5, 1.0, 2.0] {
            let (mut d, mut state) = (0.0, [0.0; 0]);
            for _ in 0..2000 {
                seed = seed
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                u = (u + ((seed >> 33) as f64 / 2f64.powi(31) - 0.5) * 4e-7).abs();
                let intact = Intact {
                    energy: 0.5e12 * u * u,
                    traction: [-0.6e12 * u, 1e12 * u, 0.0],
                    degradation: m,
                    ..Intact::default()
                };
                let site = Site {
                    damage: d,
                    h: 1e-3,
                    ..Site::default()
                };
                let mut next = state;
                let new = law.grow(&site, &intact, &state, &mut next);
                assert!(new >= d && new <= 1.0, "{m} {u}: {new} after {d}");
                (d, state) = (new, next);
            }
            assert!(d > 0.0, "the path does damage");
        }
    }

    /// The residual traction is carried up to the limit opening and not at it.
    #[test]
    fn it_breaks_at_the_limit_opening() {
        let law = CzmLinear::default();
        for m in [1.0, 2.0] {
            let at = |u: f64| {
                let intact = Intact {
                    energy: 0.5e12 * u * u,
                    traction: [1e12 * u, 0.0, 0.0],
                    degradation: m,
                    ..Intact::default()
                };
                law.grow(&Site::default(), &intact, &[], &mut [])
            };
            let u = law.u_limit * (1.0 - 1e-9);
            let carried = (1.0 - at(u)).powf(m) * 1e12 * u;
            assert!((carried / law.p_residual - 1.0).abs() < 1e-6, "{carried}");
            assert_eq!(at(law.u_limit * (1.0 + 1e-12)), 1.0);
            assert_eq!(at(0.999 * law.p_limit / 1e12), 0.0);
        }
    }
}
