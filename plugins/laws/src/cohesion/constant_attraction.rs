//! A constant attraction within a range of gaps, for wet grains, like LMGC90's IQS_WET_DS.
use fretwork_law::{CohesionLaw, Law, Site, Traction, parameters};

parameters! {
    /// Attraction c_n over the area, plus a force, while the gap is at most `range`. It has no
    /// history.
    pub struct ConstantAttraction {
        stress: "Pa" = 0.0, 0.0, 1e30, "attraction over the contact's area";
        force: "N" = 1e-6, 0.0, 1e30, "attraction whatever the area (N/m in 2D)";
        range: "m" = 1e-7, 0.0, 1e30, "largest gap over which it acts";
    }
}

impl Law for ConstantAttraction {
    const NAME: &'static str = "constant-attraction";
    const DOC: &'static str = "constant attraction within a range of gaps (wet grains)";
    const REFERENCE: &'static str = "F. Radjai, V. Richefeu, Phil. Trans. R. Soc. A 367 (2009) 5123-5138; law IQS_WET_DS of LMGC90";
}

impl CohesionLaw for ConstantAttraction {
    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if !(site.gap <= self.range && site.area > 0.0) {
            return Traction::default();
        }
        let all = self.stress + self.force / site.area;
        Traction {
            // A very small area overflows.
            tension_strength: all.min(f64::MAX),
            ..Traction::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_acts_within_the_range() {
        let law = ConstantAttraction {
            stress: 10.0,
            force: 2.0,
            range: 1e-3,
        };
        let at = |gap| {
            law.traction(
                &Site {
                    gap,
                    area: 4.0,
                    ..Site::default()
                },
                &[],
            )
            .tension_strength
                * 4.0
        };
        assert_eq!((at(-1.0), at(1e-3), at(1.1e-3)), (42.0, 42.0, 0.0));
    }
}
