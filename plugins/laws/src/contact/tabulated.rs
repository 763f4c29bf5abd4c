//! Friction from a table over slip, slip velocity, pressure and temperature, made by hand or from
//! the runs of a study.
use fretwork_law::{ContactLaw, Friction, Law, Site, Variable, abi, parameters};

parameters! {
    /// The coefficient is that of the table at the slip of the contact since it formed, at its
    /// slip velocity, pressure and temperature, as far as the table depends on them.
    pub struct Tabulated {
        within: "" = 0.0, -1.0, 1.0, "place in the interval of the table: -1 its lower end, 0 the value, 1 its upper end";
        scale: "" = 1.0, 0.0, 1e6, "factor on the values of the table";
    }
}

/// Friction without a table, on a bench: a case must name one.
const WITHOUT: f64 = 0.4;

impl Tabulated {
    /// Returns the coefficient, and whether the contact is outside of the table.
    fn at(&self, site: &Site, slipped: f64) -> (f64, bool) {
        let pressure = site.pressure();
        let point = [slipped, site.sliding_speed(), pressure, site.temperature];
        match site.table.at(point) {
            Some(found) => (
                self.scale * found.within(self.within).max(0.0),
                found.outside,
            ),
            None => (self.scale * WITHOUT, false),
        }
    }
}

impl Law for Tabulated {
    const NAME: &'static str = "tabulated";
    const DOC: &'static str =
        "friction from a table over slip, slip velocity, pressure and temperature";
    const REFERENCE: &'static str = "the file that the case names under `tables`";
    const FLAGS: u64 = abi::FLAG_TABLE;
    const VARIABLES: &'static [Variable] = &[
        Variable::new(c"slipped", c"m", c"slip of the contact since it formed").written(),
        Variable::new(
            c"outside_table",
            c"s",
            c"time under load outside of the table of friction",
        )
        .written(),
    ];
}

impl ContactLaw for Tabulated {
    fn friction(&self, site: &Site, state: &[f64]) -> Friction {
        Friction::coulomb(self.at(site, state[0]).0)
    }

    fn commit(&self, site: &Site, state: &mut [f64]) {
        if site.impulse[0] <= 0.0 {
            return;
        }
        state[0] = (state[0] + site.h * site.sliding_speed()).min(f64::MAX);
        if self.at(site, state[0]).1 {
            state[1] += site.h;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::Table;

    /// 0.5 up to a slip of 1 mm and 0.3 from 2 mm on, at 100 MPa; 0.1 less at 300 MPa.
    fn table() -> Table {
        let values = [0.5, 0.4, 0.3, 0.2];
        let mut numbers = vec![2.0, 1.0, 2.0, 1.0, 1e-3, 2e-3, 0.0, 1e8, 3e8, 293.0];
        for by in [0.0, -0.05, 0.1] {
            numbers.extend(values.map(|mu| mu + by));
        }
        Table::new(numbers.leak())
    }

    fn site(pressure: f64, speed: f64) -> Site {
        Site {
            area: 1e-6,
            h: 1e-3,
            impulse: [pressure * 1e-6 * 1e-3, 0.0, 0.0],
            velocity: [0.0, speed, 0.0],
            table: table(),
            ..Site::default()
        }
    }

    #[test]
    fn friction_is_that_of_the_table_at_slip_and_pressure() {
        let law = Tabulated::default();
        for (slip, pressure, mu) in [(1e-3, 1e8, 0.5), (2e-3, 3e8, 0.2), (1.5e-3, 2e8, 0.35)] {
            let got = law.friction(&site(pressure, 0.1), &[slip, 0.0]).mu;
            assert!((got - mu).abs() < 1e-12, "{got} {mu}");
        }
        for (within, mu) in [(-1.0, 0.45), (0.0, 0.5), (1.0, 0.6)] {
            let law = Tabulated { within, ..law };
            let got = law.friction(&site(1e8, 0.1), &[1e-3, 0.0]).mu;
            assert!((got - mu).abs() < 1e-12, "{got} {mu}");
        }
    }

    #[test]
    fn slip_adds_up_and_time_outside_is_counted() {
        let law = Tabulated::default();
        let mut state = [1e-3, 0.0];
        law.commit(&site(2e8, 0.5), &mut state);
        assert!((state[0] - 1.5e-3).abs() < 1e-15 && state[1] == 0.0);
        law.commit(&site(4e8, 0.1), &mut state);
        assert_eq!(state[1], 1e-3);
        // An open contact is nowhere.
        let before = state;
        law.commit(&site(0.0, 1.0), &mut state);
        assert_eq!(state, before);
    }
}
