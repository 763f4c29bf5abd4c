//! Fatigue by accumulated opening under traction: Roe and Siegmund.
#![forbid(unsafe_code)]
use fretwork_law::{DamageLaw, Intact, Law, Site, Variable, export, parameters};

parameters! {
    /// dD = (|du|/length) (T/T_max - endurance)+ once the accumulated opening has passed `start`, with T the
    /// traction that the bond carries and T_max = strength (1 - D). D is never below that of the monotonic
    /// envelope, linear softening from `strength` with fracture energy `energy`; a bond that stores more than
    /// the energy at its strength breaks. Monotonic loading also accumulates cyclic damage and so needs less energy.
    pub struct RoeSiegmund {
        strength: "Pa" = 1e6, 1e-30, 1e30, "strength of the new bond";
        energy: "J/m^2" = 5.0, 1e-30, 1e30, "fracture energy of the envelope";
        length: "m" = 1e-5, 1e-30, 1e30, "accumulated opening over which damage grows, about 4 times the one at the strength";
        endurance: "" = 0.25, 0.0, 1.0, "share of the strength below which cycles do nothing";
        start: "m" = 0.0, 0.0, 1e30, "accumulated opening before damage begins";
    }
}

const VARIABLES: &[Variable] = &[
    Variable {
        name: c"last",
        unit: c"m",
        doc: c"opening at the end of the last step",
        initial: 0.0,
        output: false,
    },
    Variable {
        name: c"travel",
        unit: c"m",
        doc: c"accumulated opening",
        initial: 0.0,
        output: true,
    },
];

impl Law for RoeSiegmund {
    const NAME: &'static str = "roe-siegmund";
    const DOC: &'static str =
        "fatigue damage by accumulated opening under traction, with an endurance limit";
    const REFERENCE: &'static str = "K. L. Roe, T. Siegmund, Eng. Fract. Mech. 70 (2003) 209-232";
    const VARIABLES: &'static [Variable] = VARIABLES;
}

impl RoeSiegmund {
    /// D of linear softening; 0 below the strength.
    fn envelope(&self, intact: &Intact) -> f64 {
        let (u, k) = (intact.opening(), intact.stiffness());
        if k <= 0.0 || intact.traction_length() <= self.strength {
            return 0.0;
        }
        let (first, last) = (self.strength / k, 2.0 * self.energy / self.strength);
        if u >= last || last <= first {
            return 1.0;
        }
        intact.damage_for(self.strength * ((last - u) / (last - first)))
    }
}

impl DamageLaw for RoeSiegmund {
    fn grow(&self, site: &Site, intact: &Intact, state: &[f64], next: &mut [f64]) -> f64 {
        let d = site.damage;
        // The host does not check whether variables are finite.
        let u = intact.opening().min(f64::MAX);
        let [last, travel] = [state[0], state[1]];
        let du = (u - last).abs();
        next[0] = u;
        next[1] = (travel + du).min(f64::MAX);
        let left = 1.0 - d;
        if left <= 0.0 {
            return d;
        }
        let load =
            intact.traction_length() * left.powf(intact.degradation) / (self.strength * left);
        let mut grown = d;
        if next[1] > self.start && load > self.endurance {
            grown += du / self.length * (load.min(f64::MAX) - self.endurance);
        }
        grown.min(1.0).max(self.envelope(intact))
    }
}

export!(damage RoeSiegmund);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    fn at(k: f64, u: f64) -> Intact {
        Intact {
            energy: 0.5 * k * u * u,
            traction: [k * u, 0.0, 0.0],
            degradation: 1.0,
            ..Intact::default()
        }
    }

    /// For m = 1 the load K u/strength does not depend on D: over a cycle 0 - u - 0 it integrates to
    /// 2 (K u^2/(2 s) - C u + s C^2/(2 K))/length.
    #[test]
    fn a_cycle_damages_by_its_integral() {
        let law = RoeSiegmund::default();
        let (k, u, cycles, n) = (1e12, 6e-7, 3, 20_000);
        let (mut d, mut state) = (0.0, [0.0; 2]);
        for step in 1..=cycles * n {
            let phase = f64::from(step) / f64::from(n) % 1.0;
            let x = u * (1.0 - (2.0 * phase - 1.0).abs());
            let mut next = state;
            d = law.grow(
                &Site {
                    damage: d,
                    ..Site::default()
                },
                &at(k, x),
                &state,
                &mut next,
            );
            state = next;
        }
        let (s, c) = (law.strength, law.endurance);
        let half = 0.5 * k * u * u / s - c * u + 0.5 * s * c * c / k;
        let expected = f64::from(cycles) * 2.0 * half / law.length;
        assert!((d / expected - 1.0).abs() < 1e-3, "{d} {expected}");
        assert!((state[1] / (2.0 * f64::from(cycles) * u) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_happens_below_the_endurance_limit() {
        let law = RoeSiegmund::default();
        let (mut d, mut state) = (0.1, [0.0; 2]);
        for step in 0..1000 {
            let mut next = state;
            let intact = at(1e12, if step % 2 == 0 { 2.4e-7 } else { 0.0 });
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
        assert_eq!(d, 0.1);
    }

    #[test]
    fn extremes_stay_in_range() {
        testing::damage_stays_in_range::<RoeSiegmund>();
    }

    #[test]
    fn damage_never_falls_over_a_random_path() {
        testing::damage_never_falls(&RoeSiegmund::default());
    }

    /// Without cyclic damage the area under monotonic loading is the envelope's energy.
    #[test]
    fn the_envelope_holds_its_energy() {
        let law = RoeSiegmund {
            length: 1e30,
            ..RoeSiegmund::default()
        };
        for (m, k) in [(1.0, 1e12), (2.0, 1e13)] {
            let pull = testing::pull(&law, k, m, 12e-6, 400_000);
            assert!((pull.area / law.energy - 1.0).abs() < 1e-4, "{m} {pull:?}");
            assert_eq!(pull.damage, 1.0);
        }
    }
}
