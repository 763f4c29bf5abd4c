//! Xu and Needleman's exponential cohesion, with history: it unloads to the origin and stays
//! broken.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, bounded, parameters};

parameters! {
    /// Let x = u_n/delta_n, y = |u_t|/delta_t and phi = e strength delta_n. The potential of the
    /// paper with q = 1 is phi (1 - (1 + x) exp(-x - y^2)): the work of separation is phi in both
    /// modes, and r has no effect. The largest fraction of phi that this potential has reached is
    /// the damage D, which never decreases. The traction is t = (1 - D) d psi_0/d u with psi_0 =
    /// phi (x - ln(1 + x) + y^2). While D grows it is therefore that of the paper, t_n =
    /// (phi/delta_n) x exp(-x - y^2) and t_t = (2 phi/delta_t) y (1 + x) exp(-x - y^2), and any
    /// path to full separation dissipates phi. In compression x is 0, and the contact carries the
    /// load. Where 1 - D falls to `left` the bond is broken.
    pub struct XuNeedleman {
        strength: "Pa" = 1e6, 1e-30, 1e30, "normal strength, reached at delta_n";
        delta_n: "m" = 1e-6, 1e-30, 1e30, "normal opening at the strength";
        delta_t: "m" = 1.5e-6, 1e-30, 1e30, "tangential length; the shear strength is reached at delta_t/sqrt(2)";
        left: "" = 1e-5, 1e-300, 0.5, "1 - D at which the bond is broken, the share of phi that is cut off";
    }
}

impl Law for XuNeedleman {
    const NAME: &'static str = "xu-needleman";
    const DOC: &'static str =
        "exponential cohesion with unloading to the origin, phi = e strength delta_n on any path";
    const REFERENCE: &'static str = "X.-P. Xu, A. Needleman, Modelling Simul. Mater. Sci. Eng. 1 (1993) 111-132, with q = 1; J. Mech. Phys. Solids 42 (1994) 1397-1434";
    const FLAGS: u64 =
        abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_BREAKS | abi::FLAG_FORMS;

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        Some(self.phi() * (1.0 - self.left))
    }
}

impl XuNeedleman {
    fn phi(&self) -> f64 {
        std::f64::consts::E * self.strength * self.delta_n
    }

    /// Openings divided by their lengths, limited to finite values.
    fn shares(&self, site: &Site) -> [f64; 2] {
        [
            bounded(site.normal_opening() / self.delta_n),
            bounded(site.tangential_opening() / self.delta_t),
        ]
    }
}

/// Returns x - ln(1 + x).
fn above_log(x: f64) -> f64 {
    if x < 1e-3 {
        // The difference of the two has few digits.
        x * x * (0.5 - x * (1.0 / 3.0 - x * (0.25 - 0.2 * x)))
    } else {
        x - x.ln_1p()
    }
}

impl CohesionLaw for XuNeedleman {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if site.damage >= 1.0 {
            return Traction::default();
        }
        let phi = self.phi() * (1.0 - site.damage);
        let ([x, _], [n, t1, t2]) = (self.shares(site), site.opening);
        let (k_n, k_t) = (
            phi / (self.delta_n * self.delta_n),
            2.0 * phi / (self.delta_t * self.delta_t),
        );
        let over = 1.0 / (1.0 + x);
        Traction {
            traction: [k_n * over * n, k_t * t1, k_t * t2].map(bounded),
            stiffness_n: k_n * over * over,
            stiffness_t: k_t,
            ..Traction::default()
        }
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let [x, y] = self.shares(site);
        bounded(self.phi() * (1.0 - site.damage) * (above_log(x) + y * y))
    }

    fn commit(&self, site: &Site, _state: &mut [f64]) -> f64 {
        let [x, y] = self.shares(site);
        let left = (-above_log(x) - y * y).exp();
        if left <= self.left {
            1.0
        } else {
            site.damage.max(1.0 - left)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    /// In mode I the peak is s at delta_n and the area e s delta_n; in mode II the peak is sqrt(2
    /// e) s delta_n/delta_t, with an equal area.
    #[test]
    fn peaks_and_areas_are_the_papers() {
        let law = XuNeedleman::default();
        let phi = std::f64::consts::E * 1e6 * 1e-6;
        let testing::Pull { peak, area, .. } =
            testing::pull_breaking(&law, [1.0, 0.0, 0.0], 30e-6, 400_000);
        assert!((peak / 1e6 - 1.0).abs() < 1e-6 && (area / phi - 1.0).abs() < 1e-3);
        let testing::Pull { peak, area, .. } =
            testing::pull_breaking(&law, [0.0, 1.0, 0.0], 30e-6, 400_000);
        let shear = (2.0 * std::f64::consts::E).sqrt() * 1e6 / 1.5;
        assert!(
            (peak / shear - 1.0).abs() < 1e-6 && (area / phi - 1.0).abs() < 1e-3,
            "{area}"
        );
    }

    /// The potential of Xu and Needleman (1993), eq. 4, with the general q and r.
    fn potential([n, t]: [f64; 2], q: f64, r: f64) -> f64 {
        let (x, y) = (n / 1e-6, t / 1.5e-6);
        let phi = std::f64::consts::E;
        let normal = (1.0 - r + x) * (1.0 - q) / (r - 1.0);
        let shear = q + (r - q) / (r - 1.0) * x;
        phi + phi * (-x).exp() * (normal - shear * (-y * y).exp())
    }

    /// Returns damage and traction after the opening is led through these points, in `steps` steps
    /// each, and the work done.
    fn led(law: &XuNeedleman, places: &[[f64; 2]], steps: u32) -> (f64, [f64; 2], f64) {
        let at = |[n, t]: [f64; 2], damage: f64| Site {
            opening: [n, 0.6 * t, -0.8 * t],
            damage,
            ..Site::default()
        };
        let of = |place: [f64; 2], damage: f64| {
            let [n, t1, t2] = law.traction(&at(place, damage), &[]).traction;
            [n, 0.6 * t1 - 0.8 * t2]
        };
        let (mut here, mut damage, mut work) = ([0.0; 2], 0.0, 0.0);
        for place in places {
            let from = here;
            for k in 1..=steps {
                let share = f64::from(k) / f64::from(steps);
                let next = [0, 1].map(|i| from[i] + share * (place[i] - from[i]));
                let before = of(here, damage);
                damage = law.commit(&at(next, damage), &mut []);
                let after = of(next, damage);
                work += (0..2)
                    .map(|i| 0.5 * (before[i] + after[i]) * (next[i] - here[i]))
                    .sum::<f64>();
                here = next;
            }
        }
        (damage, of(here, damage), work)
    }

    #[test]
    fn tractions_are_the_gradient_of_the_papers_potential() {
        let law = XuNeedleman::default();
        for n in [0.0, 0.3e-6, 1e-6, 2.5e-6] {
            for t in [0.0, 0.4e-6, 1.1e-6, 2.0e-6] {
                let (damage, traction, work) = led(&law, &[[n, t]], 2000);
                for r in [0.0, 0.5] {
                    let d = 1e-10;
                    let slope = |a: [f64; 2], b: [f64; 2]| {
                        (potential(a, 1.0, r) - potential(b, 1.0, r)) / (2.0 * d)
                    };
                    let expected = [
                        // The potential continues into compression, where the law leaves the load
                        // to the contact.
                        slope([n + d, t], [n - d, t]),
                        slope([n, t + d], [n, t - d]),
                    ];
                    for (found, expected) in traction.iter().zip(expected) {
                        assert!(
                            (found - expected).abs() < 1e-6 * 1e6,
                            "{n} {t}: {found} {expected}"
                        );
                    }
                    let phi = std::f64::consts::E;
                    assert!((damage - potential([n, t], 1.0, r) / phi).abs() < 1e-12);
                    assert!(
                        (work - potential([n, t], 1.0, r)).abs() < 1e-5 * phi,
                        "{n} {t}: {work}"
                    );
                }
            }
        }
    }

    /// The work does not depend on the path, even if it reverses, nor on the direction in which it
    /// ends.
    #[test]
    fn any_path_to_separation_takes_phi() {
        let law = XuNeedleman::default();
        let far = 30e-6;
        for path in [
            vec![[far, far]],
            vec![[far, 0.3 * far]],
            vec![[1e-6, 0.0], [1e-6, far]],
            vec![[0.0, 1e-6], [far, 1e-6]],
            vec![
                [1e-6, 1e-6],
                [0.0, 0.0],
                [0.5e-6, 1.5e-6],
                [2e-6, 0.0],
                [far, far],
            ],
        ] {
            let (damage, _, work) = led(&law, &path, 100_000);
            let phi = law.fracture_energy(0.0).unwrap();
            assert_eq!(damage, 1.0, "{path:?}");
            assert!(
                (work / phi - 1.0).abs() < 2e-5,
                "{path:?}: {work} for {phi}"
            );
        }
    }

    /// Traction is the gradient of (1 - D) psi_0 at fixed damage, and the stiffness the slope of
    /// the traction.
    #[test]
    fn unloading_gives_back_what_is_stored() {
        let law = XuNeedleman::default();
        for x in [1e-9, 0.9e-9, 1.1e-9, 0.4e-6, 2e-6] {
            let at = |n: f64| Site {
                opening: [n, 0.7e-6, 0.0],
                damage: 0.4,
                ..Site::default()
            };
            let d = 1e-4 * x;
            let slope = (law.energy(&at(x + d), &[]) - law.energy(&at(x - d), &[])) / (2.0 * d);
            let normal = |n: f64| law.traction(&at(n), &[]).traction[0];
            assert!(
                (normal(x) / slope - 1.0).abs() < 1e-3,
                "{x}: {} {slope}",
                normal(x)
            );
            let slope = (normal(x + d) - normal(x - d)) / (2.0 * d);
            let stiffness = law.traction(&at(x), &[]).stiffness_n;
            assert!(
                (stiffness / slope - 1.0).abs() < 1e-6,
                "{x}: {stiffness} {slope}"
            );
        }
        for near in [1e-3 - 1e-9, 1e-3 + 1e-9_f64] {
            let exact = near * near * (0.5 - near / 3.0 + near * near / 4.0 - near.powi(3) / 5.0);
            assert!((above_log(near) / exact - 1.0).abs() < 1e-9);
        }
    }

    /// The area up to the cut is phi (1 - left), in any mode.
    #[test]
    fn the_declared_energy_leaves_out_the_tail() {
        let law = XuNeedleman {
            left: 0.1,
            ..XuNeedleman::default()
        };
        for direction in [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.0, 1.0, 0.0]] {
            let area = testing::pull_breaking(&law, direction, 30e-6, 400_000).area;
            let declared = law.fracture_energy(0.0).unwrap();
            assert!((area / declared - 1.0).abs() < 1e-3, "{area} {declared}");
        }
    }
}
