//! Wear by broken bonds: a bond that breaks releases a volume once.
//!
//! Slip and force have no effect: detachment follows from the cohesion and its damage.
use fretwork_law::{Law, Site, Variable, WearLaw, parameters};

parameters! {
    /// V = thickness A in the step in which D reaches 1.
    pub struct BrokenBonds {
        thickness: "m" = 1e-5, 0.0, 1e6, "matter behind a contact over its area; about the size of a grain";
    }
}

/// Values of the variable: never bonded; bonded; broken and counted.
const NEVER: f64 = 0.0;
const BONDED: f64 = 1.0;
const BOOKED: f64 = 2.0;

impl Law for BrokenBonds {
    const NAME: &'static str = "broken-bonds";
    const DOC: &'static str = "thickness times area, once, when the bond breaks";
    const REFERENCE: &'static str =
        "M. Champagne, M. Renouf, Y. Berthier, J. Tribol. 136 (2014) 021603";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"bond_history",
        c"",
        c"0 never bonded, 1 bonded, 2 broken and counted as wear",
    )];
}

impl WearLaw for BrokenBonds {
    fn volume(&self, site: &Site, state: &mut [f64]) -> f64 {
        // A healed bond may break again, and counts again.
        if site.damage < 1.0 {
            state[0] = BONDED;
            return 0.0;
        }
        // D is 1 without a bond too. A bond that breaks in its first step never has a smaller D
        // here, but it has an opening, unlike contacts that were never bonded.
        let opened = site.opening != [0.0; 3];
        if state[0] == BONDED || (state[0] == NEVER && opened) {
            state[0] = BOOKED;
            return (self.thickness * site.area.max(0.0)).min(f64::MAX);
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: BrokenBonds = BrokenBonds { thickness: 0.5 };

    /// Drives one contact of 3 m^2 through damages and openings, and returns the volume of each
    /// step.
    fn history(steps: &[(f64, f64)]) -> Vec<f64> {
        let mut state = [BrokenBonds::VARIABLES[0].initial];
        steps
            .iter()
            .map(|(damage, opening)| {
                let site = Site {
                    damage: *damage,
                    opening: [*opening, 0.0, 0.0],
                    area: 3.0,
                    ..Site::default()
                };
                LAW.volume(&site, &mut state)
            })
            .collect()
    }

    #[test]
    fn counts_a_bond_once() {
        let v = history(&[(0.0, 0.0), (0.4, 1.0), (1.0, 2.0), (1.0, 2.0), (1.0, 2.0)]);
        assert_eq!(v, [0.0, 0.0, 1.5, 0.0, 0.0]);
    }

    #[test]
    fn counts_no_contact_that_never_bonded() {
        assert_eq!(history(&[(1.0, 0.0); 3]), [0.0; 3]);
    }

    #[test]
    fn counts_a_bond_that_breaks_in_its_first_step() {
        assert_eq!(history(&[(1.0, 1e-9), (1.0, 1e-9)]), [1.5, 0.0]);
    }

    #[test]
    fn counts_a_healed_bond_again() {
        let v = history(&[(0.2, 0.0), (1.0, 1.0), (0.0, 0.0), (1.0, 1.0), (1.0, 1.0)]);
        assert_eq!(v, [0.0, 1.5, 0.0, 1.5, 0.0]);
    }
}
