//! Fatigue by loss of stiffness at every reloading: Nguyen, Repetto, Ortiz and Radovitzky.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, export, parameters};

parameters! {
    /// While the opening grows below its envelope the stiffness K+ = (1 - D)^m K falls by
    /// dK+ = -K+ du/length; unloading goes to the origin. The envelope softens linearly from `strength` with
    /// fracture energy `energy`. (In the paper the reloading stiffness is incremental; here it is the secant
    /// one, since a bond's stored energy must follow from D.)
    pub struct Nguyen {
        strength: "Pa" = 1e6, 1e-30, 1e30, "strength of the new bond";
        energy: "J/m^2" = 5.0, 1e-30, 1e30, "fracture energy of the envelope";
        length: "m" = 1e-4, 1e-30, 1e30, "opening over which reloading loses the stiffness by a factor e";
        left: "" = 1e-3, 0.0, 0.5, "share of the stiffness below which the bond is broken";
    }
}

const VARIABLES: &[Variable] = &[Variable {
    name: c"last",
    unit: c"m",
    doc: c"opening at the end of the last step",
    initial: 0.0,
    output: false,
}];

impl Law for Nguyen {
    const NAME: &'static str = "nguyen";
    const DOC: &'static str =
        "loss of stiffness at every reloading, under a linear softening envelope";
    const REFERENCE: &'static str =
        "O. Nguyen, E. A. Repetto, M. Ortiz, R. A. Radovitzky, Int. J. Fract. 110 (2001) 351-369";
    const VARIABLES: &'static [Variable] = VARIABLES;
}

impl DamageLaw for Nguyen {
    fn grow(&self, site: &Site, intact: &Intact, state: &[f64], next: &mut [f64]) -> f64 {
        let (u, k, d) = (intact.opening(), intact.stiffness(), site.damage);
        // The host does not look whether variables are finite.
        next[0] = u.min(f64::MAX);
        if k <= 0.0 || d >= 1.0 {
            return d;
        }
        let m = intact.degradation;
        let loss = (u - state[0]).max(0.0) / self.length;
        let fatigued = 1.0 - (1.0 - d) * (-loss / m).exp();
        if (1.0 - fatigued).powf(m) <= self.left {
            return 1.0;
        }
        let (first, last) = (self.strength / k, 2.0 * self.energy / self.strength);
        if intact.traction_length() <= self.strength {
            return fatigued.max(d);
        }
        if u >= last || last <= first {
            return 1.0;
        }
        let traction = self.strength * ((last - u) / (last - first));
        intact.damage_for(traction).max(fatigued).max(d)
    }
}

export!(damage Nguyen);

#[cfg(test)]
mod tests {
    use super::*;

    /// N cycles 0 - u - 0 below the envelope leave (1 - D)^m = exp(-N u/length), whatever the step.
    #[test]
    fn cycles_lose_stiffness_exponentially() {
        let law = Nguyen::default();
        for (m, n) in [(1.0, 10), (2.0, 10), (2.0, 1000)] {
            let (k, u, cycles) = (1e12, 8e-7, 50);
            let (mut d, mut state) = (0.0f64, [0.0]);
            for step in 1..=cycles * n {
                let phase = f64::from(step) / f64::from(n) % 1.0;
                let x = u * (1.0 - (2.0 * phase - 1.0).abs());
                let intact = Intact {
                    energy: 0.5 * k * x * x,
                    traction: [0.0, k * x, 0.0],
                    degradation: m,
                    ..Intact::default()
                };
                let mut next = state;
                d = law.grow(
                    &Site {
                        damage: d,
                        ..Site::default()
                    },
                    &intact,
                    &state,
                    &mut next,
                );
                state = next;
            }
            let expected = (-f64::from(cycles) * u / law.length).exp();
            assert!(
                ((1.0 - d).powf(m) / expected - 1.0).abs() < 1e-9,
                "{m} {n} {d}"
            );
        }
    }

    /// Any finite bond, the least and the most of every parameter: D in [D_i, 1], variables finite.
    #[test]
    fn extremes_stay_in_range() {
        use fretwork_law::Parameters;
        let sizes = [0.0, 1e-300, 1e-12, 1e-3, 1.0, 1e5, 1e6, 1e30, 1e300];
        let damages = [0.0, 0.4, 1.0 - 1e-16, 1.0];
        for end in 0..3 {
            let values = Nguyen::FIELDS
                .iter()
                .map(|f| [f.default, f.minimum, f.maximum][end]);
            let law = Nguyen::read(&values.collect::<Vec<f64>>());
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
                let mut next = [s; 1];
                let d = law.grow(&site, &intact, &[s; 1], &mut next);
                assert!(d >= site.damage && d <= 1.0, "{law:?} {intact:?} {s}: {d}");
                assert!(next.iter().all(|x| x.is_finite()), "{law:?} {intact:?}");
            }
        }
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        let law = Nguyen::default();
        let (mut seed, mut u) = (1u64, 0.0f64);
        for m in [0.5, 1.0, 2.0] {
            let (mut d, mut state) = (0.0, [0.0; 1]);
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
