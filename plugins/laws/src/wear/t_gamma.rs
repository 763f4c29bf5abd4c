//! Wear of wheel and rail by T gamma: the regimes of the University of Sheffield for R8T on 900A
//! steel.
//!
//! Mass lost per metre rolled and per area of contact, as a function of x = T gamma/A, the energy
//! per metre and area: 5.3 x (mild, x < 10.4 N/mm^2), 55 (severe), in ug/(m mm^2). Sources differ
//! beyond 77.2 N/mm^2 (catastrophic): 55 + 61.9 (x - 77.2), which is continuous and the default;
//! 61.9 x - 4778.7, which begins at zero; 61.9 x. All have an equal slope, so `catastrophic_start`
//! selects one: 0.055, 0, or 4.7787 kg/m^3.
//!
//! A contact rolls `speed` h in a step, so T gamma is its friction work over that distance. The map
//! applies to wheel on rail: `area` should be that of the patch between the first bodies.
use fretwork_law::{Law, Site, WearLaw, parameters, require};

parameters! {
    /// In SI units: 1 ug/(m mm^2) is 1e-3 kg/m^3, over 1 N/mm^2 it is 1e-9 kg/J.
    pub struct TGamma {
        speed: "m/s" = 1.0, 1e-12, 1e6, "rolling speed, for the distance rolled in a step";
        density: "kg/m^3" = 7850.0, 1e-12, 1e12, "density of the steel";
        mild: "kg/J" = 5.3e-9, 0.0, 1.0, "mild regime: mass per energy";
        severe: "kg/m^3" = 0.055, 0.0, 1e12, "severe regime: mass per metre and area";
        catastrophic: "kg/J" = 61.9e-9, 0.0, 1.0, "catastrophic regime: growth of the mass with energy";
        catastrophic_start: "kg/m^3" = 0.055, 0.0, 1e12, "mass per metre and area at its start; sources differ";
        mild_end: "Pa" = 10.4e6, 0.0, 1e30, "T gamma/A at which the mild regime ends";
        severe_end: "Pa" = 77.2e6, 0.0, 1e30, "T gamma/A at which the severe regime ends";
    }
}

impl Law for TGamma {
    const NAME: &'static str = "t-gamma";
    const DOC: &'static str = "rail steel wear map of USFD over T gamma/A, three regimes";
    const REFERENCE: &'static str = "R. Lewis, R. S. Dwyer-Joyce, Proc. IMechE J 218 (2004) 467-478; F. Braghin et al., Wear 261 (2006) 1253-1264";

    fn validate(&self) -> Result<(), String> {
        require(
            self.mild_end <= self.severe_end,
            "`mild_end` exceeds `severe_end`",
        )
    }
}

impl WearLaw for TGamma {
    fn volume(&self, site: &Site, _state: &mut [f64]) -> f64 {
        // All terms are multiplied by A times the distance, swept, which may be zero: x =
        // work/swept.
        let distance = (self.speed * site.h.max(0.0)).min(f64::MAX);
        let swept = (site.area.max(0.0) * distance).min(f64::MAX);
        let work = site.friction_work.max(0.0);
        let mass = if work < self.mild_end * swept {
            self.mild * work
        } else if work <= self.severe_end * swept {
            self.severe * swept
        } else {
            self.catastrophic_start * swept + self.catastrophic * (work - self.severe_end * swept)
        };
        (mass / self.density).min(f64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the mass (ug) lost by a patch of 100 mm^2 that rolls 2 mm, at x in N/mm^2.
    fn mass(law: &TGamma, x: f64) -> f64 {
        let site = Site {
            area: 1e-4,
            h: 1e-4,
            // T gamma = 100 x N acts over 2e-3 m.
            friction_work: 0.2 * x,
            ..Site::default()
        };
        let law = TGamma {
            speed: 20.0,
            ..*law
        };
        law.volume(&site, &mut []) * law.density * 1e9
    }

    fn near(got: f64, expected: f64) {
        assert!((got / expected - 1.0).abs() < 1e-12, "{got} {expected}");
    }

    /// With 100 mm^2 and 2e-3 m, 1 ug/(m mm^2) is 0.2 ug.
    #[test]
    fn regimes_by_hand() {
        let law = TGamma::default();
        near(mass(&law, 5.0), 5.3); // 26.5
        near(mass(&law, 10.0), 10.6); // 53
        near(mass(&law, 10.5), 11.0); // 55
        near(mass(&law, 77.1), 11.0);
        near(mass(&law, 100.0), 293.264); // 55 + 61.9 22.8 = 1466.32
        assert_eq!(mass(&law, 0.0), 0.0);
        assert_eq!(mass(&law, -5.0), 0.0);
    }

    #[test]
    fn the_third_regime_of_each_source() {
        let starting = |catastrophic_start| TGamma {
            catastrophic_start,
            ..TGamma::default()
        };
        // At x = 100, 61.9 x - 4778.68 is 1411.32, and 61.9 x is 6190.
        near(mass(&starting(0.0), 100.0), 282.264);
        near(mass(&starting(4.77868), 100.0), 1238.0);
        // The default is continuous: at x = 77.2 + 0.01 it is 55.619.
        near(mass(&TGamma::default(), 77.21), 11.1238);
    }

    /// In the mild regime the mass follows from the work alone.
    #[test]
    fn mild_wear_does_not_know_the_distance() {
        let site = Site {
            area: 1.0,
            h: 1e-3,
            friction_work: 10.0,
            ..Site::default()
        };
        let volume = |speed| {
            let law = TGamma {
                speed,
                ..TGamma::default()
            };
            law.volume(&site, &mut [])
        };
        assert_eq!(volume(1.0), volume(30.0));
        near(volume(1.0), 5.3e-8 / 7850.0);
    }

    #[test]
    fn regimes_come_in_order() {
        let law = TGamma::default();
        let swapped = TGamma {
            mild_end: 1e8,
            ..law
        };
        assert!(law.validate().is_ok() && swapped.validate().is_err());
    }
}
