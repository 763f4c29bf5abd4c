//! Rate-and-state friction: mu = mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c).
//!
//! The state is stored as psi = ln(V_0 theta/D_c): it starts at zero, the steady state at V_0,
//! whatever the parameters, and neither theta's range nor its logarithm can overflow. With x = V
//! theta/D_c,
//! * aging law, d theta/dt = 1 - x: theta tends to D_c/V as exp(-V t/D_c);
//! * slip law, d theta/dt = -x ln x: psi tends to ln(V_0/V) as exp(-V t/D_c).
//!
//! Both are integrated exactly over a step at its velocity u_th. The state of a contact without
//! load does not change. The direct effect a is that of the velocity at the end of the step, for
//! which the host asks again; below v_min friction is that at v_min, which holds a contact.
use fretwork_law::{ContactLaw, Friction, Law, Site, Variable, parameters, require};

parameters! {
    /// Dieterich's aging law or Ruina's slip law.
    pub struct RateAndState {
        mu_0: "" = 0.6, 0.0, 1e3, "friction coefficient of steady sliding at V_0", friction;
        a: "" = 0.010, 0.0, 1e3, "direct effect of the velocity";
        b: "" = 0.015, 0.0, 1e3, "effect of the state";
        v_0: "m/s" = 1e-6, 1e-30, 1e6, "reference velocity V_0";
        d_c: "m" = 1e-5, 1e-30, 1e6, "slip over which the state is renewed, D_c";
        v_min: "m/s" = 1e-9, 1e-30, 1e6, "smallest velocity the law sees, for rest has no logarithm";
        slip_law: "" = 0.0, 0.0, 1.0, "0 aging law (Dieterich), 1 slip law (Ruina)";
    }
}

impl RateAndState {
    /// Returns the velocity that enters the law (m/s): positive and finite.
    fn velocity(&self, site: &Site) -> f64 {
        let slip = site.sliding_speed();
        slip.clamp(self.v_min, f64::MAX)
    }

    /// Returns ln(V/V_0). The quotient itself could overflow.
    fn logarithm(&self, v: f64) -> f64 {
        v.ln() - self.v_0.ln()
    }

    /// Returns psi after a time h at the velocity v.
    fn state_after(&self, psi: f64, v: f64, h: f64) -> f64 {
        let z = v * h.max(0.0) / self.d_c;
        let steady = -self.logarithm(v);
        if self.slip_law > 0.5 {
            return steady + (psi - steady) * (-z).exp();
        }
        // exp psi' = exp(psi - z) + exp(steady) (1 - exp(-z)), summed in logarithms.
        let (old, new) = (psi - z, steady + (-(-z).exp_m1()).ln());
        let (large, small) = (old.max(new), old.min(new));
        large + (small - large).exp().ln_1p()
    }
}

impl Law for RateAndState {
    const NAME: &'static str = "rate-and-state";
    const DOC: &'static str = "mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)";
    const REFERENCE: &'static str = "J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161-2168; A. Ruina, J. Geophys. Res. 88 (1983) 10359-10370";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"psi",
        c"",
        c"state ln(V_0 theta/D_c) of rate-and-state friction",
    )
    .written()];

    fn validate(&self) -> Result<(), String> {
        require(
            self.slip_law == 0.0 || self.slip_law == 1.0,
            "`slip_law` is 0 (aging law) or 1 (slip law)",
        )
    }
}

impl ContactLaw for RateAndState {
    fn friction(&self, site: &Site, state: &[f64]) -> Friction {
        let direct = self.a * self.logarithm(self.velocity(site));
        Friction::coulomb((self.mu_0 + direct + self.b * state[0]).clamp(0.0, f64::MAX))
    }

    fn commit(&self, site: &Site, state: &mut [f64]) {
        if site.impulse[0] > 0.0 {
            state[0] = self.state_after(state[0], self.velocity(site), site.h);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compressed(v: f64, h: f64) -> Site {
        Site {
            velocity: [0.0, 0.6 * v, -0.8 * v],
            impulse: [1.0, 0.0, 0.0],
            h,
            ..Site::default()
        }
    }

    fn after(law: &RateAndState, v: f64, h: f64, psi: f64) -> f64 {
        let mut state = [psi];
        law.commit(&compressed(v, h), &mut state);
        state[0]
    }

    fn both() -> [RateAndState; 2] {
        [0.0, 1.0].map(|slip_law| RateAndState {
            slip_law,
            ..RateAndState::default()
        })
    }

    /// After an increase of the velocity by ten, friction changes by a ln 10 at once and by (a - b)
    /// ln 10 in the end.
    #[test]
    fn a_velocity_step_is_the_textbook_one() {
        for law in both() {
            let v = 10.0 * law.v_0;
            let mu = |psi| law.friction(&compressed(v, 1e-3), &[psi]).mu - law.mu_0;
            assert!((mu(0.0) - 0.02303).abs() < 5e-6);
            let mut psi = 0.0;
            for _ in 0..40_000 {
                psi = after(&law, v, 1e-3, psi);
            }
            assert!((mu(psi) + 0.01151).abs() < 5e-6);
            assert!((mu(psi) - (law.a - law.b) * 10f64.ln()).abs() < 1e-12);
        }
    }

    #[test]
    fn steady_state_is_kept() {
        for law in both() {
            for ratio in [1e-2f64, 1.0, 30.0, 1e7] {
                let psi = -ratio.ln();
                let v = ratio * law.v_0;
                assert!((after(&law, v, 0.37, psi) - psi).abs() < 1e-13);
                let mu = law.friction(&compressed(v, 1.0), &[psi]).mu;
                assert!((mu - (0.6 - 0.005 * ratio.ln())).abs() < 1e-13);
            }
        }
    }

    /// One step compared with the differential equation of theta, integrated by the classical
    /// Runge-Kutta scheme.
    #[test]
    fn a_step_solves_the_equation() {
        for law in both() {
            let rate = |theta: f64, v: f64| {
                let x = v * theta / law.d_c;
                if law.slip_law > 0.5 {
                    -x * x.ln()
                } else {
                    1.0 - x
                }
            };
            for (v, start) in [(1e-5, 3.0), (1e-7, 2.0), (3e-6, -1.5)] {
                let (time, n) = (0.8 * law.d_c / v, 20_000);
                let d = time / f64::from(n);
                let mut theta = law.d_c / law.v_0 * f64::exp(start);
                for _ in 0..n {
                    let k1 = rate(theta, v);
                    let k2 = rate(theta + 0.5 * d * k1, v);
                    let k3 = rate(theta + 0.5 * d * k2, v);
                    let k4 = rate(theta + d * k3, v);
                    theta += d / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                }
                let psi = (law.v_0 * theta / law.d_c).ln();
                assert!((after(&law, v, time, start) - psi).abs() < 1e-9);
                // The integration is exact if the number of steps does not matter.
                let half = after(&law, v, 0.5 * time, start);
                assert!((after(&law, v, 0.5 * time, half) - psi).abs() < 1e-9);
            }
        }
    }

    /// At rest theta grows by the hold time, under load only; theta of the slip law does not grow.
    #[test]
    fn rest_ages() {
        let [aging, slip] = both();
        let rest = |law| after(law, 0.0, 20.0, 0.0);
        // theta grows from 10 s by 20 s, less the effect of the 2e-3 D_c of slip at v_min.
        assert!((rest(&aging) - 3f64.ln()).abs() < 3e-3);
        assert!(rest(&slip) < 0.02);
        let mut state = [0.7];
        let open = Site {
            impulse: [0.0; 3],
            ..compressed(1.0, 1.0)
        };
        aging.commit(&open, &mut state);
        assert_eq!(state, [0.7]);
    }

    #[test]
    fn is_finite_everywhere() {
        for law in both() {
            for v in [0.0, 1e-320, -1e-9, 1e300, f64::MAX] {
                for h in [0.0, 1e-320, 1e-6, f64::MAX] {
                    for psi in [-1e300, -800.0, 0.0, 800.0, 1e300] {
                        let site = Site {
                            velocity: [v; 3],
                            ..compressed(0.0, h)
                        };
                        let mut state = [psi];
                        law.commit(&site, &mut state);
                        assert!(state[0].is_finite(), "{v} {h} {psi}");
                        assert!(law.friction(&site, &[psi]).mu.is_finite());
                    }
                }
            }
        }
        let between = RateAndState {
            slip_law: 0.5,
            ..RateAndState::default()
        };
        assert!(between.validate().is_err());
    }
}
