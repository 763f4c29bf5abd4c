//! Linear irreversible adhesion: no force before contact, then a force that decreases with the gap.
use fretwork_law::{CohesionLaw, Law, Site, Traction, Variable, parameters};

parameters! {
    /// Attraction f_max in contact, and f_max - k_c gap up to the gap f_max/k_c once the grains
    /// have touched. After separation they must touch again.
    pub struct LinearAdhesion {
        f_max: "N" = 1e-6, 0.0, 1e30, "attraction in contact (N/m in 2D)";
        k_c: "N/m" = 1.0, 1e-30, 1e30, "how fast it fades with the gap (N/m^2 in 2D)";
    }
}

impl Law for LinearAdhesion {
    const NAME: &'static str = "linear-adhesion";
    const DOC: &'static str = "linear adhesion that acts only after contact";
    const REFERENCE: &'static str = "S. Luding, Granul. Matter 10 (2008) 235-246; LinearIrreversibleAdhesiveSpecies of MercuryDPM";
    const VARIABLES: &'static [Variable] = &[Variable::new(
        c"touched",
        c"",
        c"1 once the grains have touched and while the attraction reaches",
    )
    .written()];
}

impl LinearAdhesion {
    fn force(&self, gap: f64) -> f64 {
        (self.f_max - self.k_c * gap.max(0.0)).max(0.0)
    }
}

impl CohesionLaw for LinearAdhesion {
    fn traction(&self, site: &Site, state: &[f64]) -> Traction {
        let acts = state[0] > 0.5 || site.gap <= 0.0;
        if !(acts && site.area > 0.0) {
            return Traction::default();
        }
        Traction::attraction(self.force(site.gap), site)
    }

    fn commit(&self, site: &Site, state: &mut [f64]) -> f64 {
        let reaches = state[0] > 0.5 && self.force(site.gap) > 0.0;
        state[0] = f64::from(u8::from(site.touches() || reaches));
        site.damage
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_acts_after_contact_and_until_its_range() {
        let law = LinearAdhesion {
            f_max: 2.0,
            k_c: 4.0,
        };
        let (mut state, mut seen) = ([0.0], Vec::new());
        for gap in [0.1, 0.0, 0.1, 0.4, 0.6, 0.1, -0.1] {
            let site = Site {
                gap,
                area: 1.0,
                ..Site::default()
            };
            seen.push(law.traction(&site, &state).tension_strength);
            law.commit(&site, &mut state);
        }
        let expected = [0.0, 2.0, 1.6, 0.4, 0.0, 0.0, 2.0];
        assert!(
            seen.iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-12),
            "{seen:?}"
        );
    }
}
