//! MELODY's cohesive zone with fatigue: damage while the traction rises above a fatigue limit.
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, parameters, require};

parameters! {
    /// dD = rate (|P| - p_fatigue)/(P_max - p_fatigue) d|P| while the carried traction |P| rises
    /// above p_fatigue, with P_max = p_limit (1 - D) + p_residual D; |P| >= P_max breaks the bond.
    pub struct CzmFatigue {
        p_limit: "Pa" = 1e6, 1e-30, 1e30, "strength of the new bond";
        p_residual: "Pa" = 1e5, 0.0, 1e30, "strength as damage nears one";
        p_fatigue: "Pa" = 2e5, 0.0, 1e30, "traction below which cycles do nothing";
        rate: "1/Pa" = 1e-7, 0.0, 1e30, "damage for a rise of one pascal at the strength";
    }
}

impl Law for CzmFatigue {
    const NAME: &'static str = "czm-fatigue";
    const DOC: &'static str =
        "damage while the traction rises above a fatigue limit; breaks at a strength that falls";
    const REFERENCE: &'static str = "law CZMfatigue of MELODY: G. Mollon, Comput. Part. Mech. 5 (2018), doi:10.1007/s40571-018-0187-6";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"last",
        c"Pa",
        c"traction carried at the end of the last step",
    )];

    fn validate(&self) -> Result<(), String> {
        require(
            self.p_residual <= self.p_limit,
            "p_residual must not exceed p_limit",
        )?;
        require(
            self.p_fatigue < self.p_limit,
            "p_fatigue must be below p_limit",
        )
    }
}

impl DamageLaw for CzmFatigue {
    fn grow(&self, site: &Site, intact: &Intact, state: &mut [f64]) -> f64 {
        let d = site.damage;
        let p = intact.traction_length() * (1.0 - d).max(0.0).powf(intact.degradation);
        let last = std::mem::replace(&mut state[0], p);
        if d >= 1.0 {
            return d;
        }
        let highest = self.p_limit * (1.0 - d) + self.p_residual * d;
        if p >= highest {
            return 1.0;
        }
        let (from, span) = (last.max(self.p_fatigue), highest - self.p_fatigue);
        if p <= from || span <= 0.0 {
            return d;
        }
        // The increase is integrated exactly at this D, since one step may be the whole loading of
        // a cycle.
        let mean = 0.5 * ((p - self.p_fatigue) + (from - self.p_fatigue)) / span;
        (d + self.rate * mean * (p - from)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened};

    fn at(p: f64) -> Intact {
        Intact {
            traction: [p, 0.0, 0.0],
            ..opened(1e12, p / 1e12, 1.0)
        }
    }

    /// A monotonic increase from 0 to P at a small rate, with the fatigue limit F, gives D = rate
    /// (P - F)^2/(2 (P_max - F)) in any number of steps.
    #[test]
    fn a_rise_damages_by_its_integral() {
        let law = CzmFatigue {
            rate: 1e-12,
            ..CzmFatigue::default()
        };
        for n in [1, 10, 1000] {
            let mut bond = Bond::new(&law, 0.0);
            for step in 1..=n {
                bond.lead(&at(8e5 * f64::from(step) / f64::from(n)));
            }
            let (d, expected) = (bond.site.damage, 1e-12 * 6e5 * 6e5 / (2.0 * 8e5));
            assert!((d / expected - 1.0).abs() < 1e-5, "{n} {d}");
        }
    }

    #[test]
    fn a_fall_and_a_low_load_do_nothing_and_the_strength_breaks() {
        let law = CzmFatigue::default();
        let grow = |damage: f64, p: f64, last: f64| {
            let site = Bond::new(&law, damage).site;
            law.grow(&site, &at(p), &mut [last])
        };
        assert_eq!(grow(0.3, 1.9e5, 0.0), 0.3);
        assert_eq!(grow(0.3, 5e5, 9e5), 0.3);
        assert_eq!(grow(0.0, 1e6, 0.0), 1.0);
    }
}
