//! Fatigue by loss of stiffness at every reloading: Nguyen, Repetto, Ortiz and Radovitzky.
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, parameters};

parameters! {
    /// While the opening grows below its envelope the stiffness K+ = (1 - D)^m K decreases by dK+ =
    /// -K+ du/length; unloading is to the origin. The envelope softens linearly from `strength`
    /// with fracture energy `energy`. (In the paper the reloading stiffness is incremental; here it
    /// is the secant one, since a bond's stored energy must follow from D.)
    pub struct Nguyen {
        strength: "Pa" = 1e6, 1e-30, 1e30, "strength of the new bond";
        energy: "J/m^2" = 5.0, 1e-30, 1e30, "fracture energy of the envelope";
        length: "m" = 1e-4, 1e-30, 1e30, "opening over which reloading loses the stiffness by a factor e";
        left: "" = 1e-3, 0.0, 0.5, "share of the stiffness below which the bond is broken";
    }
}

impl Law for Nguyen {
    const NAME: &'static str = "nguyen";
    const DOC: &'static str =
        "loss of stiffness at every reloading, under a linear softening envelope";
    const REFERENCE: &'static str =
        "O. Nguyen, E. A. Repetto, M. Ortiz, R. A. Radovitzky, Int. J. Fract. 110 (2001) 351-369";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"last",
        c"m",
        c"opening at the end of the last step",
    )];
}

impl DamageLaw for Nguyen {
    fn grow(&self, site: &Site, intact: &Intact, state: &mut [f64]) -> f64 {
        let (u, d) = (intact.opening(), site.damage);
        // The host does not check whether variables are finite.
        let last = std::mem::replace(&mut state[0], u.min(f64::MAX));
        if intact.stiffness() <= 0.0 || d >= 1.0 {
            return d;
        }
        let m = intact.degradation;
        let loss = (u - last).max(0.0) / self.length;
        let fatigued = 1.0 - (1.0 - d) * (-loss / m).exp();
        if (1.0 - fatigued).powf(m) <= self.left {
            return 1.0;
        }
        intact.soften_linearly(fatigued.max(d), self.strength, self.energy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened};

    /// N cycles 0 - u - 0 below the envelope give (1 - D)^m = exp(-N u/length) for any step.
    #[test]
    fn cycles_lose_stiffness_exponentially() {
        let law = Nguyen::default();
        for (m, n) in [(1.0, 10), (2.0, 10), (2.0, 1000)] {
            let (u, cycles) = (8e-7, 50);
            let mut bond = Bond::new(&law, 0.0);
            for step in 1..=cycles * n {
                let phase = f64::from(step) / f64::from(n) % 1.0;
                bond.lead(&opened(1e12, u * (1.0 - (2.0 * phase - 1.0).abs()), m));
            }
            let left = (1.0 - bond.site.damage).powf(m);
            let expected = (-f64::from(cycles) * u / law.length).exp();
            assert!((left / expected - 1.0).abs() < 1e-9, "{m} {n} {left}");
        }
    }
}
