//! The rate law of Monerie, Acary and Cangemi: b dD/dt = <Y - w>_+, Y = -d psi/d D.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// With b = 0 and a cohesion of exponent m = 2 a bond that opens without limit dissipates exactly w. Its
    /// intensity of adhesion decreases as 1/u^2 and never reaches 0 by itself: below `beta_broken` the bond
    /// counts as broken (0 disables this). The energy stored at that moment, at most
    /// beta_broken w/2, must be added to the fracture energy by the host, and the bond has then dissipated
    /// w (1 - beta_broken/2).
    pub struct Mac {
        w: "J/m^2" = 0.1, 0.0, 1e30, "Dupre's energy: fracture energy of the bond";
        b: "J s/m^2" = 0.0, 0.0, 1e30, "viscosity of damage";
        beta_broken: "" = 1e-3, 0.0, 1.0, "intensity of adhesion below which the bond is broken";
        opening_broken: "m" = 1e30, 1e-30, 1e30, "normal opening beyond which the bond is broken, whatever it still carries";
    }
}

/// Value of `opening_broken` with which a bond never breaks by its opening (m).
const NEVER: f64 = 1e30;

impl Law for Mac {
    const NAME: &'static str = "mac";
    const DOC: &'static str = "rate law b dD/dt = <Y - w>, with fracture energy w and viscosity b";
    const REFERENCE: &'static str = "Y. Monerie, V. Acary, Formulation dynamique d'un modele de zone cohesive tridimensionnel, Rev. Eur. Elements Finis 10 (2001); M. Raous, L. Cangemi, M. Cocou, Comput. Methods Appl. Mech. Engrg 177 (1999) 383-399";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        // Viscosity increases it with the speed; the cut at beta_broken reduces it by a fraction that depends on m, that at an opening by one
        // that depends on the stiffness.
        let tail = self.beta_broken <= 5e-3 && self.opening_broken >= NEVER;
        (self.b == 0.0 && tail).then_some(self.w)
    }
}

impl Mac {
    /// D at the end of a step of h seconds, implicit for m >= 1: b (D - D_i)/h = Y(D) - w.
    fn damage(&self, d: f64, h: f64, intact: &Intact) -> f64 {
        if d >= 1.0 || intact.release_rate(d) <= self.w {
            return d;
        }
        let m = intact.degradation;
        if m == 2.0 {
            let beta = (h * self.w + self.b * (1.0 - d)) / (self.b + h * 2.0 * intact.energy);
            return 1.0 - beta;
        }
        if m <= 1.0 {
            // Y does not decrease as D grows: without viscosity the bond breaks at once.
            return if self.b > 0.0 {
                d + h * (intact.release_rate(d) - self.w) / self.b
            } else {
                1.0
            };
        }
        // Y(D) - w - b (D - D_i)/h decreases from above zero at D_i to below zero at 1.
        let (mut low, mut high) = (d, 1.0);
        while high - low > f64::EPSILON {
            let mid = 0.5 * (low + high);
            if intact.release_rate(mid) - self.w > self.b * (mid - d) / h {
                low = mid;
            } else {
                high = mid;
            }
        }
        0.5 * (low + high)
    }
}

impl DamageLaw for Mac {
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        // `max` and `min` rather than `clamp`, so that a NaN damage reaches the host, which reports it.
        let d = self.damage(site.damage, site.h, intact);
        let d = d.max(site.damage).min(1.0);
        let broken = 1.0 - d < self.beta_broken || site.opening[0] > self.opening_broken;
        if broken { 1.0 } else { d }
    }
}

export!(damage Mac);

#[cfg(test)]
mod tests {
    use super::*;

    /// Opens a MAC bond (C = 1e12 Pa/m) at a speed to an opening; returns (peak, area to the end).
    fn pull(law: &Mac, speed: f64, h: f64, reach: f64) -> (f64, f64) {
        let (c, mut d, mut peak, mut area, mut last, mut u) = (1e12, 0.0, 0.0f64, 0.0, 0.0, 0.0);
        while u < reach {
            u += speed * h;
            let intact = Intact {
                energy: 0.5 * c * u * u,
                traction: [c * u, 0.0, 0.0],
                degradation: 2.0,
                ..Intact::default()
            };
            d = law.grow(
                &Site {
                    damage: d,
                    h,
                    ..Site::default()
                },
                &intact,
                &[],
                &mut [],
            );
            let sigma = (1.0 - d) * (1.0 - d) * c * u;
            area += 0.5 * (sigma + last) * speed * h;
            last = sigma;
            peak = peak.max(sigma);
        }
        (peak, area)
    }

    #[test]
    fn without_viscosity_peak_and_area_are_closed_forms() {
        let law = Mac {
            w: 0.1,
            b: 0.0,
            beta_broken: 0.0,
            ..Mac::default()
        };
        let (peak, area) = pull(&law, 0.045, 2e-9, 3.16228e-6);
        assert!((peak / 0.316228e6 - 1.0).abs() < 1e-3, "{peak}");
        assert!((area / 0.0994998 - 1.0).abs() < 1e-3, "{area}");
    }

    /// Values of the continuum limit for du/dt = 0.045 m/s, opening to 100 um.
    #[test]
    fn with_viscosity_it_meets_the_ode() {
        for (b, peak, area) in [
            (1e-6, 0.36159e6, 0.16741),
            (1e-5, 0.52941e6, 0.44568),
            (1e-4, 0.98853e6, 1.71835),
        ] {
            let law = Mac {
                w: 0.1,
                b,
                beta_broken: 0.0,
                ..Mac::default()
            };
            let (p, a) = pull(&law, 0.045, 5e-9, 100e-6);
            assert!(
                (p / peak - 1.0).abs() < 1e-2 && (a / area - 1.0).abs() < 1e-2,
                "b {b}: {p} {a}"
            );
        }
    }

    #[test]
    fn damage_never_falls_and_waits_for_the_threshold() {
        let law = Mac {
            w: 0.1,
            b: 0.0,
            beta_broken: 1e-3,
            ..Mac::default()
        };
        let weak = Intact {
            energy: 0.01,
            degradation: 2.0,
            ..Intact::default()
        };
        let at = |damage| {
            law.grow(
                &Site {
                    damage,
                    h: 1e-6,
                    ..Site::default()
                },
                &weak,
                &[],
                &mut [],
            )
        };
        assert_eq!((at(0.0), at(0.4), at(1.0)), (0.0, 0.4, 1.0));
    }

    #[test]
    fn it_breaks_beyond_an_opening() {
        let law = Mac {
            opening_broken: 2e-5,
            ..Mac::default()
        };
        let at = |opening| {
            let site = Site {
                opening: [opening, 1.0, 0.0],
                h: 1e-6,
                ..Site::default()
            };
            law.grow(&site, &Intact::default(), &[], &mut [])
        };
        assert_eq!((at(2e-5), at(2.001e-5), at(-1.0)), (0.0, 1.0, 0.0));
        assert!(
            law.fracture_energy(0.0).is_none() && Mac::default().fracture_energy(0.0).is_some()
        );
    }

    #[test]
    fn a_brittle_bond_snaps_at_w() {
        let law = Mac {
            w: 0.1,
            b: 0.0,
            beta_broken: 1e-3,
            ..Mac::default()
        };
        let at = |energy| {
            let intact = Intact {
                energy,
                degradation: 1.0,
                ..Intact::default()
            };
            law.grow(
                &Site {
                    h: 1e-6,
                    ..Site::default()
                },
                &intact,
                &[],
                &mut [],
            )
        };
        assert_eq!((at(0.0999), at(0.1001)), (0.0, 1.0));
    }

    /// Grows D over one step of 1 us from `damage`, under psi_0 = 0.3 J/m^2.
    fn step(law: &Mac, damage: f64, degradation: f64) -> f64 {
        let intact = Intact {
            energy: 0.3,
            degradation,
            ..Intact::default()
        };
        let site = Site {
            damage,
            h: 1e-6,
            ..Site::default()
        };
        law.grow(&site, &intact, &[], &mut [])
    }

    #[test]
    fn other_exponents_solve_the_implicit_equation() {
        for (m, b) in [(1.5, 1e-6), (3.0, 1e-6), (3.0, 0.0), (2.5, 1e-7)] {
            let law = Mac {
                w: 0.1,
                b,
                beta_broken: 0.0,
                ..Mac::default()
            };
            let d = step(&law, 0.2, m);
            let y = m * (1.0 - d).powf(m - 1.0) * 0.3;
            assert!((b * (d - 0.2) / 1e-6 - (y - 0.1)).abs() < 1e-12, "{m} {b}");
        }
        let law = Mac {
            b: 1e-6,
            ..Mac::default()
        };
        let (exact, near) = (step(&law, 0.2, 2.0), step(&law, 0.2, 2.0 + 1e-9));
        assert!((exact - near).abs() < 1e-8);
        // m = 1: D = D_i + h (psi_0 - w)/b.
        assert!((step(&law, 0.2, 1.0) - 0.4).abs() < 1e-12);
    }

    /// The cut at `beta_broken` reduces the energy by no more than beta_broken w/2.
    #[test]
    fn the_cut_is_where_the_doc_says() {
        let law = Mac::default();
        let broken = |beta: f64| {
            let intact = Intact {
                energy: 0.5 * law.w / beta,
                degradation: 2.0,
                ..Intact::default()
            };
            let site = Site {
                h: 1e-6,
                ..Site::default()
            };
            law.grow(&site, &intact, &[], &mut []) == 1.0
        };
        assert!(broken(0.999e-3) && !broken(1.001e-3));
    }
}
