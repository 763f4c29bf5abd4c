//! Holm's constriction resistance of a plastic spot.
use fretwork_law::{Conductance, Law, Site, TransportLaw, parameters};

parameters! {
    /// The resistance of a circular spot of area F/H is R = (rho_1 + rho_2)/(4 a), and its thermal
    /// conductance G = 2 k a. In 2D the spot is a strip of width F/H, from which the current is
    /// counted to the distance 2 R on either side, R the reduced radius: g = pi/(2 rho asinh(2
    /// R/a)) per metre of depth.
    pub struct Holm {
        hardness: "Pa" = 2.6e9, 1e-300, 1e300, "H, hardness of the softer body";
    }
}

impl Law for Holm {
    const NAME: &'static str = "holm";
    const DOC: &'static str =
        "constriction resistance (rho_1 + rho_2)/(4 a) of a plastic spot of area F/H";
    const REFERENCE: &'static str = "R. Holm, Electric Contacts, 4th ed. (1967), sections 4 and 7";
}

impl TransportLaw for Holm {
    fn conductance(&self, site: &Site, _state: &mut [f64]) -> Conductance {
        site.through_spot(site.plastic_spot(self.hardness))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Under 1 N with H = 1 GPa, a = 17.84 um; copper of 1.7e-8 ohm m has R = 2 1.7e-8/(4 a) =
    /// 0.4764 mohm.
    #[test]
    fn resistance_is_rho_over_2_a() {
        let law = Holm { hardness: 1e9 };
        let site = Site {
            impulse: [1e-3, 0.0, 0.0],
            h: 1e-3,
            radius: 1e-3,
            resistivity: 1.7e-8,
            conductivity: 400.0,
            dimension: 3,
            ..Site::default()
        };
        let g = law.conductance(&site, &mut []);
        assert!((1.0 / g.electric / 0.4764e-3 - 1.0).abs() < 1e-3, "{g:?}");
        // Wiedemann and Franz: heat and current pass through the same spot.
        assert!((g.thermal / g.electric / (400.0 * 1.7e-8) - 1.0).abs() < 1e-12);
    }
}
