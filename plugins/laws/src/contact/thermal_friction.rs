//! Friction that changes with the temperature of the contact between two temperatures.
use fretwork_law::{ContactLaw, Friction, Law, Site, abi, parameters, ramp, require};

parameters! {
    /// The coefficient mu is `cold` up to the temperature `from`, `hot` above `to`, and linear
    /// between them. It may decrease or increase.
    pub struct ThermalFriction {
        cold: "" = 0.4, 0.0, 1e6, "friction coefficient up to the lower temperature", friction;
        hot: "" = 0.16, 0.0, 1e6, "friction coefficient from the upper temperature on", friction;
        from: "K" = 293.15, 0.0, 1e6, "lower temperature";
        to: "K" = 893.15, 0.0, 1e6, "upper temperature";
    }
}

impl Law for ThermalFriction {
    const NAME: &'static str = "thermal-friction";
    const DOC: &'static str = "friction that falls, or rises, linearly between two temperatures";
    const REFERENCE: &'static str = "M. Ertz, F. Bucher, Veh. Syst. Dyn. 37 suppl. (2002) 314-325; piecewise linear as in E. A. H. Vollebregt, User guide for CONTACT";
    const FLAGS: u64 = abi::FLAG_TEMPERATURE;

    fn validate(&self) -> Result<(), String> {
        require(
            self.from < self.to,
            "the lower temperature `from` must be below the upper one, `to`",
        )
    }
}

impl ContactLaw for ThermalFriction {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let range = [self.from, self.to];
        Friction::coulomb(ramp(site.temperature, range, [self.cold, self.hot]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falls_between_the_temperatures() {
        let law = ThermalFriction {
            cold: 0.5,
            hot: 0.1,
            from: 300.0,
            to: 700.0,
        };
        let at = |temperature: f64| {
            let site = Site {
                temperature,
                ..Site::default()
            };
            law.friction(&site, &[]).mu
        };
        assert_eq!([0.0, 300.0, 700.0, 1e9].map(at), [0.5, 0.5, 0.1, 0.1]);
        assert!((at(400.0) - 0.4).abs() < 1e-15);
        assert!(ThermalFriction { from: 700.0, ..law }.validate().is_err());
    }
}
