//! Wear by dissipated energy: dV = alpha dE_d.
use fretwork_law::{Law, Site, WearLaw, parameters};

parameters! {
    /// The volume is proportional to the energy that friction dissipates.
    pub struct DissipatedEnergy {
        alpha: "m^3/J" = 1e-14, 0.0, 1.0, "energy wear coefficient";
    }
}

impl Law for DissipatedEnergy {
    const NAME: &'static str = "dissipated-energy";
    const DOC: &'static str = "volume alpha E_d, E_d the work of friction";
    const REFERENCE: &'static str = "S. Fouvry, P. Kapsa, L. Vincent, Wear 200 (1996) 186-205";
}

impl WearLaw for DissipatedEnergy {
    fn volume(&self, site: &Site, _state: &mut [f64]) -> f64 {
        self.alpha * site.friction_work.max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_is_alpha_times_the_work_that_is_lost() {
        let law = DissipatedEnergy { alpha: 5e-14 };
        let volume = |friction_work| {
            let site = Site {
                friction_work,
                ..Site::default()
            };
            law.volume(&site, &mut [])
        };
        assert!((volume(0.14) / 7e-15 - 1.0).abs() < 1e-14);
        assert_eq!(volume(-0.14), 0.0);
    }
}
