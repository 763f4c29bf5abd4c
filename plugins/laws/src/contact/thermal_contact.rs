//! Linear springs at contacts, with friction that changes with the temperature of the contact.
use fretwork_law::{
    ContactLaw, Friction, Law, Site, Spring, abi, damping_ratio, parameters, ramp, require,
};

parameters! {
    /// The springs are those of linear-contact, the friction is that of thermal-friction. Elastic
    /// cylinders (2D) have the stiffness pi/4 E*.
    pub struct ThermalContact {
        stiffness: "N/m" = 1e6, 1e-300, 1e300, "normal stiffness k; in 2D per metre of depth (N/m^2)";
        ratio: "" = 0.8, 0.0, 1e3, "tangential over normal stiffness; 0: no tangential displacement before slip";
        restitution: "" = 1.0, 0.0, 1.0, "share of the approach velocity with which two bodies part";
        cold: "" = 0.4, 0.0, 1e6, "friction coefficient up to the lower temperature", friction;
        hot: "" = 0.16, 0.0, 1e6, "friction coefficient from the upper temperature on", friction;
        from: "K" = 293.15, 0.0, 1e6, "lower temperature";
        to: "K" = 893.15, 0.0, 1e6, "upper temperature";
    }
}

impl Law for ThermalContact {
    const NAME: &'static str = "thermal-contact";
    const DOC: &'static str = "linear springs at contacts, with damping and friction that falls, or rises, between two temperatures";
    const REFERENCE: &'static str = "P. A. Cundall, O. D. L. Strack, Geotechnique 29 (1979) 47-65; M. Ertz, F. Bucher, Veh. Syst. Dyn. 37 suppl. (2002) 314-325; piecewise linear as in E. A. H. Vollebregt, User guide for CONTACT";
    const FLAGS: u64 = abi::FLAG_COMPLIANT | abi::FLAG_TEMPERATURE;

    fn validate(&self) -> Result<(), String> {
        require(
            self.from < self.to,
            "the lower temperature `from` must be below the upper one, `to`",
        )
    }
}

impl ContactLaw for ThermalContact {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let (range, values) = ([self.from, self.to], [self.cold, self.hot]);
        Friction::coulomb(ramp(site.temperature, range, values))
    }

    fn spring(&self, site: &Site, _state: &[f64], damping: f64) -> Spring {
        Spring::linear(site, self.stiffness, self.ratio, damping)
    }

    fn damping(&self) -> f64 {
        damping_ratio(self.restitution)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_stay_and_friction_falls() {
        let law = ThermalContact {
            from: 300.0,
            to: 500.0,
            ..ThermalContact::default()
        };
        let at = |temperature: f64| Site {
            temperature,
            overlap: 1e-6,
            ..Site::default()
        };
        let mu = |t: f64| law.friction(&at(t), &[]).mu;
        assert!((mu(400.0) - 0.28).abs() < 1e-15 && mu(900.0) == 0.16);
        assert_eq!(law.spring(&at(900.0), &[], 0.0).force_n, 1.0);
    }
}
