//! An intact bond conducts over its area, a broken one in proportion to its force.
use fretwork_law::{Conductance, Law, Site, TransportLaw, parameters};

parameters! {
    /// G = (1 - D) h A + g F, with the damage D, the area A and the compressive force F.
    pub struct BondConductance {
        bond_thermal: "W/(m^2 K)" = 1e6, 0.0, 1e30, "thermal conductance of an undamaged bond over its area";
        bond_electric: "S/m^2" = 1e9, 0.0, 1e30, "electrical conductance of an undamaged bond over its area";
        force_thermal: "W/(N K)" = 1e-3, 0.0, 1e30, "thermal conductance per compressive force";
        force_electric: "S/N" = 1.0, 0.0, 1e30, "electrical conductance per compressive force";
    }
}

impl Law for BondConductance {
    const NAME: &'static str = "bond-conductance";
    const DOC: &'static str = "(1 - D) over the area of a bond, and in proportion to the force";
    const REFERENCE: &'static str = "of Fretwork: the simplest law in which an intact bond conducts over its area and a broken one by its force";
}

impl TransportLaw for BondConductance {
    fn conductance(&self, site: &Site, _state: &mut [f64]) -> Conductance {
        let whole = (1.0 - site.damage).max(0.0) * site.area;
        let force = site.force();
        Conductance {
            thermal: self.bond_thermal * whole + self.force_thermal * force,
            electric: self.bond_electric * whole + self.force_electric * force,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    #[test]
    fn fades_with_damage() {
        let law = BondConductance {
            bond_thermal: 1e6,
            bond_electric: 1e9,
            force_thermal: 1e-3,
            force_electric: 2.0,
        };
        let at = |damage: f64, force: f64| {
            let site = Site {
                damage,
                area: 1e-6,
                ..compressed(force)
            };
            law.conductance(&site, &mut [])
        };
        assert_eq!(
            at(0.0, -5.0),
            Conductance {
                thermal: 1.0,
                electric: 1e3
            }
        );
        assert_eq!(at(0.25, 0.0).thermal, 0.75);
        assert_eq!(
            at(1.0, 10.0),
            Conductance {
                thermal: 1e-2,
                electric: 20.0
            }
        );
    }
}
