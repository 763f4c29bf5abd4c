//! A constant conductance for all contacts that touch.
use fretwork_law::{Conductance, Law, Site, TransportLaw, parameters};

parameters! {
    /// The conductances of a closed contact. They decrease linearly with the gap, to zero at
    /// `reach`.
    pub struct ConstantConductance {
        thermal: "W/K" = 1e-3, 0.0, 1e30, "thermal conductance of a closed contact (W/(m K) in 2D)";
        electric: "S" = 1.0, 0.0, 1e30, "electrical conductance of a closed contact (S/m in 2D)";
        reach: "m" = 1e-9, 1e-300, 1e30, "gap at which nothing is conducted";
    }
}

impl Law for ConstantConductance {
    const NAME: &'static str = "constant-conductance";
    const DOC: &'static str = "the same conductance for all contacts that touch";
    const REFERENCE: &'static str = "a network of equal resistances";
}

impl TransportLaw for ConstantConductance {
    fn conductance(&self, site: &Site, _state: &mut [f64]) -> Conductance {
        let closed = (1.0 - site.gap.max(0.0) / self.reach).max(0.0);
        Conductance {
            thermal: self.thermal * closed,
            electric: self.electric * closed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falls_with_the_gap() {
        let law = ConstantConductance {
            thermal: 3.0,
            electric: 5.0,
            reach: 1e-6,
        };
        let at = |gap: f64| {
            let site = Site {
                gap,
                ..Site::default()
            };
            law.conductance(&site, &mut [])
        };
        assert_eq!((at(-1.0).thermal, at(0.0).electric), (3.0, 5.0));
        assert_eq!((at(5e-7).thermal, at(2e-6).electric), (1.5, 0.0));
    }
}
