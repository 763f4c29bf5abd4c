//! Archard's law: V = k F s, k = K/H.
use fretwork_law::{Law, Site, WearLaw, parameters};

parameters! {
    /// The volume is proportional to normal force and slip.
    pub struct Archard {
        k: "1/Pa" = 1e-14, 0.0, 1.0, "wear coefficient over hardness, K/H";
    }
}

impl Law for Archard {
    const NAME: &'static str = "archard";
    const DOC: &'static str = "volume k F s";
    const REFERENCE: &'static str = "J. F. Archard, J. Appl. Phys. 24 (1953) 981-988";
}

impl WearLaw for Archard {
    fn volume(&self, site: &Site, _state: &mut [f64]) -> f64 {
        self.k * (site.impulse[0] / site.h).max(0.0) * site.slip
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_is_k_f_s() {
        let site = Site {
            impulse: [2e-3, 0.0, 0.0],
            h: 1e-4,
            slip: 3e-6,
            ..Site::default()
        };
        let v = Archard { k: 1e-13 }.volume(&site, &mut []);
        assert!((v / (1e-13 * 20.0 * 3e-6) - 1.0).abs() < 1e-14);
    }
}
