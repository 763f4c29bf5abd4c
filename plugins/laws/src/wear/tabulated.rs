//! Archard's law with a coefficient from a table over slip, slip velocity, pressure and
//! temperature.
use fretwork_law::{Law, Site, Variable, WearLaw, abi, parameters};

parameters! {
    /// The coefficient k = K/H is that of the table at the slip of the contact since it formed, at
    /// its slip velocity, pressure and temperature, as far as the table depends on them.
    pub struct TabulatedWear {
        within: "" = 0.0, -1.0, 1.0, "place in the interval of the table: -1 its lower end, 0 the value, 1 its upper end";
        scale: "" = 1.0, 0.0, 1e6, "factor on the values of the table";
    }
}

/// The coefficient without a table (1/Pa), on a bench: a case must name one.
const WITHOUT: f64 = 1e-14;

impl Law for TabulatedWear {
    const NAME: &'static str = "tabulated";
    const DOC: &'static str = "volume k F s, with k from a table";
    const REFERENCE: &'static str = "the file that the case names under `tables`";
    const FLAGS: u64 = abi::FLAG_TABLE;
    const VARIABLES: &'static [Variable] = &[
        Variable::new(
            c"wear_slipped",
            c"m",
            c"slip of the contact since it formed",
        ),
        Variable::new(
            c"outside_wear_table",
            c"s",
            c"time under load outside of the table of wear",
        )
        .written(),
    ];
}

impl WearLaw for TabulatedWear {
    fn volume(&self, site: &Site, state: &mut [f64]) -> f64 {
        let force = site.force();
        if force <= 0.0 {
            return 0.0;
        }
        let point = [
            state[0],
            site.sliding_speed(),
            site.pressure(),
            site.temperature,
        ];
        state[0] = (state[0] + site.slip.max(0.0)).min(f64::MAX);
        let k = match site.table.at(point) {
            Some(found) => {
                state[1] += if found.outside { site.h } else { 0.0 };
                found.within(self.within).max(0.0)
            }
            None => WITHOUT,
        };
        let k = self.scale * k;
        (k * force * site.slip).clamp(0.0, f64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::Table;

    /// A coefficient of 1e-14/Pa at 10 mm/s and 3e-14/Pa at 30 mm/s.
    #[test]
    fn volume_is_k_f_s_with_the_coefficient_of_the_table() {
        let mut numbers = vec![1.0, 2.0, 1.0, 1.0, 0.0, 0.01, 0.03, 0.0, 293.0];
        for factor in [1.0, 0.5, 2.0] {
            numbers.extend([1e-14 * factor, 3e-14 * factor]);
        }
        let site = |speed: f64| Site {
            h: 1e-3,
            area: 1e-6,
            impulse: [5e-3, 0.0, 0.0],
            velocity: [0.0, 0.0, speed],
            slip: 1e-3 * speed,
            table: Table::new(numbers.clone().leak()),
            ..Site::default()
        };
        let law = TabulatedWear::default();
        let mut state = [0.0; 2];
        let got = law.volume(&site(0.02), &mut state);
        assert!((got / (2e-14 * 5.0 * 2e-5) - 1.0).abs() < 1e-12, "{got:e}");
        assert!((state[0] - 2e-5).abs() < 1e-18 && state[1] == 0.0);
        let high = TabulatedWear { within: 1.0, ..law };
        let got = high.volume(&site(0.1), &mut state);
        assert!((got / (6e-14 * 5.0 * 1e-4) - 1.0).abs() < 1e-12, "{got:e}");
        assert_eq!(state[1], 1e-3);
    }
}
