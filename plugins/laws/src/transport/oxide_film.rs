//! A plastic spot covered by an oxide film, which sliding breaks and which grows again.
use crate::GAS;
use fretwork_law::{Conductance, Law, Site, TransportLaw, Variable, abi, parameters};

parameters! {
    /// The fraction c of the spot that the film covers follows dc/dt = (1 - c)/tau - c
    /// |ds/dt|/lambda, with the slip s. If an activation energy is given, tau follows Arrhenius'
    /// law, tau exp(Q/R_g (1/T - 1/T_0)). The covered part has the resistance of the film in series
    /// with Holm's constriction, the rest Holm's constriction alone, each over its fraction of the
    /// spot of area F/H. Heat passes through the whole spot.
    pub struct OxideFilm {
        hardness: "Pa" = 2.6e9, 1e-300, 1e300, "H, hardness of the softer body";
        film: "ohm m^2" = 1e-9, 0.0, 1e30, "resistance of the film over its area";
        growth_time: "s" = 10.0, 1e-300, 1e300, "tau, time in which the film grows on bare metal, at T_0";
        activation: "J/mol" = 0.0, 0.0, 1e7, "Q, activation energy of its growth; 0 for the same at all temperatures";
        reference_temperature: "K" = 293.15, 1.0, 1e5, "T_0";
        slip_length: "m" = 1e-6, 1e-300, 1e300, "lambda, slip that wears the film off";
    }
}

const COVERED: Variable = Variable::new(c"covered", c"", c"share of the spot that the film covers")
    .starting_at(1.0)
    .written();

impl Law for OxideFilm {
    const NAME: &'static str = "oxide-film";
    const DOC: &'static str = "Holm's spot under an oxide film that slip breaks and time restores";
    const REFERENCE: &'static str = "R. Holm, Electric Contacts, 4th ed. (1967), sections 26 and 34; M. Antler, IEEE Trans. Compon. Hybrids Manuf. Technol. 8 (1985) 87-104";
    const VARIABLES: &'static [Variable] = &[COVERED];
    const FLAGS: u64 = abi::FLAG_TEMPERATURE;
}

impl OxideFilm {
    /// Returns the covered fraction after a step of `h` (s) with a slip (m), by the implicit Euler
    /// scheme.
    fn covered(&self, before: f64, h: f64, slip: f64, temperature: f64) -> f64 {
        let slower = match self.activation > 0.0 {
            true => {
                let inverse = 1.0 / temperature.max(1.0) - 1.0 / self.reference_temperature;
                (self.activation / GAS * inverse).clamp(-500.0, 500.0).exp()
            }
            false => 1.0,
        };
        let grown = h / self.growth_time / slower;
        ((before + grown) / (1.0 + grown + slip / self.slip_length)).clamp(0.0, 1.0)
    }
}

impl TransportLaw for OxideFilm {
    fn conductance(&self, site: &Site, state: &mut [f64]) -> Conductance {
        let covered = self.covered(state[0], site.h, site.slip, site.temperature);
        state[0] = covered;
        let a = site.plastic_spot(self.hardness);
        let thermal = site.constriction(site.conductivity, a);
        if a <= 0.0 || site.resistivity <= 0.0 {
            return Conductance {
                thermal,
                electric: 0.0,
            };
        }
        let metal = site.electric_constriction(a);
        let area = site.force() / self.hardness;
        let filmed = 1.0 / (1.0 / metal + self.film / area);
        Conductance {
            thermal,
            electric: (1.0 - covered) * metal + covered * filmed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    #[test]
    fn slip_breaks_the_film_and_time_restores_it() {
        let law = OxideFilm::default();
        let rest = |time: f64, steps: u32, temperature: f64| {
            let h = time / f64::from(steps);
            (0..steps).fold(0.0, |c, _| law.covered(c, h, 0.0, temperature))
        };
        // The exact solution is 1 - exp(-t/tau).
        assert!((rest(10.0, 10000, 293.15) - (1.0 - (-1.0f64).exp())).abs() < 1e-4);
        assert_eq!(law.covered(1.0, 0.0, 1e-6, 293.15), 0.5);
        let faster = OxideFilm {
            activation: 1e5,
            ..law
        };
        assert!(faster.covered(0.0, 0.1, 0.0, 400.0) > 10.0 * law.covered(0.0, 0.1, 0.0, 400.0));
    }

    /// Under 1 N with H = 1 GPa the metal has 2e-7/(2 a) = 5.605 mohm; a film of 1e-9 ohm m^2 over
    /// 1e-9 m^2 adds 1 ohm.
    #[test]
    fn film_is_in_series_with_the_constriction() {
        let law = OxideFilm {
            hardness: 1e9,
            growth_time: 1e300,
            ..OxideFilm::default()
        };
        let site = Site {
            resistivity: 2e-7,
            conductivity: 50.0,
            temperature: 293.15,
            ..compressed(1.0)
        };
        let at = |covered: f64| 1.0 / law.conductance(&site, &mut [covered]).electric;
        assert!((at(0.0) / 5.605e-3 - 1.0).abs() < 1e-3);
        assert!((at(1.0) / 1.005605 - 1.0).abs() < 1e-5);
    }
}
