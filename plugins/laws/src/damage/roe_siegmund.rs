//! Fatigue by accumulated opening under traction: Roe and Siegmund.
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, parameters};

parameters! {
    /// dD = (|du|/length) (T/T_max - endurance)+ once the accumulated opening has passed `start`,
    /// with T the traction that the bond carries and T_max = strength (1 - D). D is never below the
    /// damage of the monotonic envelope, which is linear softening from `strength` with fracture
    /// energy `energy`; a bond that stores more than this energy at its strength breaks. Monotonic
    /// loading also accumulates cyclic damage and therefore needs less energy.
    pub struct RoeSiegmund {
        strength: "Pa" = 1e6, 1e-30, 1e30, "strength of the new bond";
        energy: "J/m^2" = 5.0, 1e-30, 1e30, "fracture energy of the envelope";
        length: "m" = 1e-5, 1e-30, 1e30, "accumulated opening over which damage grows, about 4 times the one at the strength";
        endurance: "" = 0.25, 0.0, 1.0, "share of the strength below which cycles do nothing";
        start: "m" = 0.0, 0.0, 1e30, "accumulated opening before damage begins";
    }
}

impl Law for RoeSiegmund {
    const NAME: &'static str = "roe-siegmund";
    const DOC: &'static str =
        "fatigue damage by accumulated opening under traction, with an endurance limit";
    const REFERENCE: &'static str = "K. L. Roe, T. Siegmund, Eng. Fract. Mech. 70 (2003) 209-232";
    const VARIABLES: &'static [Variable] = &[
        Variable::new(c"last", c"m", c"opening at the end of the last step"),
        Variable::new(c"travel", c"m", c"accumulated opening").written(),
    ];
}

impl DamageLaw for RoeSiegmund {
    fn grow(&self, site: &Site, intact: &Intact, state: &mut [f64]) -> f64 {
        let d = site.damage;
        // The host does not check whether variables are finite.
        let u = intact.opening().min(f64::MAX);
        let du = (u - state[0]).abs();
        let travel = (state[1] + du).min(f64::MAX);
        (state[0], state[1]) = (u, travel);
        let left = 1.0 - d;
        if left <= 0.0 {
            return d;
        }
        let load =
            intact.traction_length() * left.powf(intact.degradation) / (self.strength * left);
        let mut grown = d;
        if travel > self.start && load > self.endurance {
            grown += du / self.length * (load.min(f64::MAX) - self.endurance);
        }
        intact.soften_linearly(grown.min(1.0), self.strength, self.energy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened, pull};

    /// For m = 1 the relative load K u/s, with the strength s, does not depend on D. With the
    /// endurance C, a cycle 0 - u - 0 then gives D = 2 (K u^2/(2 s) - C u + s C^2/(2 K))/length.
    #[test]
    fn a_cycle_damages_by_its_integral() {
        let law = RoeSiegmund::default();
        let (k, u, cycles, n) = (1e12, 6e-7, 3, 20_000);
        let mut bond = Bond::new(&law, 0.0);
        for step in 1..=cycles * n {
            let phase = f64::from(step) / f64::from(n) % 1.0;
            bond.lead(&opened(k, u * (1.0 - (2.0 * phase - 1.0).abs()), 1.0));
        }
        let (s, c) = (law.strength, law.endurance);
        let half = 0.5 * k * u * u / s - c * u + 0.5 * s * c * c / k;
        let (d, expected) = (
            bond.site.damage,
            f64::from(cycles) * 2.0 * half / law.length,
        );
        assert!((d / expected - 1.0).abs() < 1e-3, "{d} {expected}");
        assert!((bond.state()[1] / (2.0 * f64::from(cycles) * u) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_happens_below_the_endurance_limit() {
        let law = RoeSiegmund::default();
        let mut bond = Bond::new(&law, 0.1);
        for step in 0..1000 {
            let u = if step % 2 == 0 { 2.4e-7 } else { 0.0 };
            bond.lead(&opened(1e12, u, 1.0));
        }
        assert_eq!(bond.site.damage, 0.1);
    }

    /// Without cyclic damage the area under monotonic loading is the energy of the envelope.
    #[test]
    fn the_envelope_holds_its_energy() {
        let law = RoeSiegmund {
            length: 1e30,
            ..RoeSiegmund::default()
        };
        for (m, k) in [(1.0, 1e12), (2.0, 1e13)] {
            pull(&law, k, m, 12e-6, 400_000).took(law.energy);
        }
    }
}
