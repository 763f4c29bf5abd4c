//! Fatigue by loss of stiffness at every reloading: Nguyen, Repetto, Ortiz and Radovitzky.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, export, parameters};

parameters! {
    /// While the opening grows below its envelope the stiffness K+ = (1 - D)^m K decreases by
    /// dK+ = -K+ du/length; unloading is to the origin. The envelope softens linearly from `strength` with
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
        // The host does not check whether variables are finite.
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
    use fretwork_law::testing;

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

    #[test]
    fn extremes_stay_in_range() {
        testing::damage_stays_in_range::<Nguyen>();
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        testing::damage_never_falls(&Nguyen::default());
    }
}
