//! Fatigue with cycles counted by time, from the largest strain of a cycle: Khoramishad and
//! co-workers.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// dD/dN = alpha (e - threshold)^beta with e = opening/reference the strain of the maximum
    /// load, which the scene applies (a cycle jump: the maximum of the load is applied steadily and
    /// N = frequency t).
    pub struct Khoramishad {
        alpha: "" = 1.5, 0.0, 1e30, "damage a cycle at unit strain above the threshold";
        beta: "" = 2.0, 1e-3, 100.0, "exponent";
        threshold: "" = 0.03, 0.0, 1e30, "strain below which cycles do nothing";
        reference: "m" = 1e-5, 1e-30, 1e30, "opening of unit strain: the thickness of the layer";
        frequency: "Hz" = 10.0, 0.0, 1e30, "cycles a second";
    }
}

impl Law for Khoramishad {
    const NAME: &'static str = "khoramishad";
    const DOC: &'static str =
        "fatigue damage a cycle from the largest strain, cycles counted in time";
    const REFERENCE: &'static str = "H. Khoramishad, A. D. Crocombe, K. B. Katnam, I. A. Ashcroft, Int. J. Fatigue 32 (2010) 1146-1158";
}

impl DamageLaw for Khoramishad {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        let strain = intact.opening() / self.reference;
        if strain <= self.threshold {
            return site.damage;
        }
        // An overflow times zero cycles must give zero, not NaN, which would count as a break.
        let finite = |x: f64| x.min(f64::MAX);
        let cycles = finite(self.frequency * site.h.max(0.0));
        let power = finite((strain - self.threshold).powf(self.beta));
        let growth = finite(self.alpha * power) * cycles;
        (site.damage + growth).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened};

    #[test]
    fn n_cycles_damage_n_times_the_rate() {
        let law = Khoramishad::default();
        let intact = opened(1e12, 0.08 * law.reference, 1.0);
        let mut bond = Bond::new(&law, 0.0);
        // These are 100 cycles at 10 Hz.
        for _ in 0..10_000 {
            bond.lead(&intact);
        }
        let (d, expected) = (bond.site.damage, 100.0 * 1.5 * 0.05f64.powi(2));
        assert!((d / expected - 1.0).abs() < 1e-9, "{d}");
    }

    #[test]
    fn below_the_threshold_nothing_grows() {
        let law = Khoramishad::default();
        let mut bond = Bond::new(&law, 0.2);
        bond.site.h = 1e3;
        assert_eq!(bond.lead(&opened(1e12, 0.0299 * law.reference, 2.0)), 0.2);
    }

    /// The power of the strain overflows; without cycles, frequency or alpha there is still no
    /// damage.
    #[test]
    fn no_rate_is_no_damage_at_any_strain() {
        let huge = Intact {
            energy: 1e300,
            traction: [1.0, 0.0, 0.0],
            degradation: 1.0,
            ..Intact::default()
        };
        let (plain, h) = (Khoramishad::default(), 1e-3);
        let still = Khoramishad {
            frequency: 0.0,
            ..plain
        };
        let dull = Khoramishad {
            alpha: 0.0,
            ..plain
        };
        for (law, h) in [(plain, 0.0), (still, h), (dull, h)] {
            let mut bond = Bond::new(&law, 0.2);
            bond.site.h = h;
            assert_eq!(bond.lead(&huge), 0.2);
        }
    }
}
