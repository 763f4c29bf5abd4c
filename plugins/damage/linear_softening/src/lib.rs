//! Linear softening from a strength to nothing, with a given fracture energy.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, export, parameters};

parameters! {
    /// The traction along the opening u falls from `strength` at u_0 = strength/K to zero at
    /// u_f = 2 energy/strength. Where the bond is so soft that u_f <= u_0 it snaps at the strength, and
    /// dissipates the strength^2/(2K) that it holds then.
    pub struct LinearSoftening {
        strength: "Pa" = 3e5, 1e-30, 1e30, "traction at which damage begins";
        energy: "J/m^2" = 0.5, 1e-30, 1e30, "fracture energy, the area under the curve";
    }
}

impl Law for LinearSoftening {
    const NAME: &'static str = "linear-softening";
    const DOC: &'static str =
        "traction falls linearly from the strength to zero, area = fracture energy";
    const REFERENCE: &'static str = "A. Hillerborg, M. Modeer, P.-E. Petersson, Cem. Concr. Res. 6 (1976) 773-781; bilinear law of P. H. Geubelle, J. S. Baylor, Compos. B 29 (1998) 589-602";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        Some(self.energy)
    }
}

impl DamageLaw for LinearSoftening {
    fn grow(&self, site: &Site, intact: &Intact, _state: &[f64], _next: &mut [f64]) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.strength {
            return site.damage;
        }
        let (first, last) = (self.strength / k, 2.0 * self.energy / self.strength);
        if u >= last || last <= first {
            return 1.0;
        }
        let traction = self.strength * ((last - u) / (last - first));
        intact.damage_for(traction).max(site.damage)
    }
}

export!(damage LinearSoftening);

#[cfg(test)]
mod tests {
    use super::*;

    /// Area under a pull of a bond of stiffness k and exponent m.
    fn area(law: &LinearSoftening, k: f64, m: f64, reach: f64, n: u32) -> (f64, f64) {
        let (mut d, mut area, mut last) = (0.0, 0.0, 0.0);
        let du = reach / f64::from(n);
        for step in 1..=n {
            let u = du * f64::from(step);
            let intact = Intact {
                energy: 0.5 * k * u * u,
                traction: [k * u, 0.0, 0.0],
                degradation: m,
                ..Intact::default()
            };
            d = law.grow(
                &Site {
                    damage: d,
                    ..Site::default()
                },
                &intact,
                &[],
                &mut [],
            );
            let t = (1.0f64 - d).powf(m) * k * u;
            area += 0.5 * (last + t) * du;
            last = t;
        }
        (area, d)
    }

    #[test]
    fn the_area_is_the_fracture_energy_for_any_exponent_and_stiffness() {
        let law = LinearSoftening::default();
        for m in [1.0, 2.0, 3.5] {
            for k in [1e12, 1e13, 1e14] {
                let (area, d) = area(&law, k, m, 4e-6, 200_000);
                assert!((area / law.energy - 1.0).abs() < 1e-4, "{m} {k}: {area}");
                assert_eq!(d, 1.0);
            }
        }
    }

    #[test]
    fn a_soft_bond_snaps_at_the_strength() {
        let law = LinearSoftening::default();
        // K = 1e10: u_0 = 30 um is beyond u_f = 3.3 um.
        let (area, d) = area(&law, 1e10, 1.0, 40e-6, 100_000);
        assert!((area / (0.5 * 9e10 / 1e10) - 1.0).abs() < 1e-3, "{area}");
        assert_eq!(d, 1.0);
    }

    /// Over the K of real interfaces: at K = 1e10 u_0 = 10 um is half of u_f.
    #[test]
    fn the_area_holds_from_soft_to_stiff() {
        let law = LinearSoftening {
            strength: 1e5,
            energy: 1.0,
        };
        for m in [1.0, 2.0] {
            for k in [1e10, 1e11, 1e12, 1e13, 1e14] {
                let (mut d, mut area, mut last) = (0.0, 0.0, 0.0);
                let du = 25e-6 / 400_000.0;
                for step in 1..=400_000 {
                    let t = k * du * f64::from(step);
                    let intact = Intact {
                        energy: 0.5 * t * t / k,
                        traction: [0.6 * t, 0.0, 0.8 * t],
                        degradation: m,
                        ..Intact::default()
                    };
                    let site = Site {
                        damage: d,
                        ..Site::default()
                    };
                    d = law.grow(&site, &intact, &[], &mut []);
                    let carried = (1.0f64 - d).powf(m) * t;
                    area += 0.5 * (last + carried) * du;
                    last = carried;
                }
                let expected = law.energy;
                assert!((area / expected - 1.0).abs() < 1e-4, "{m} {k}: {area}");
                assert_eq!(d, 1.0);
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
            let values = LinearSoftening::FIELDS
                .iter()
                .map(|f| [f.default, f.minimum, f.maximum][end]);
            let law = LinearSoftening::read(&values.collect::<Vec<f64>>());
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
        let law = LinearSoftening::default();
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
}
