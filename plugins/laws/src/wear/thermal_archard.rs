//! Archard's law with a hardness that decreases with the temperature of the contact, including the
//! flash temperature.
use fretwork_law::{Law, Site, WearLaw, abi, parameters, require};

parameters! {
    /// V = K F s/H(T) with H = H_0 (1 - x^m) and x = (T - T_0)/(T_m - T_0), limited to 0 and 1. H
    /// is at least `least` times H_0, so wear increases from mild wear to that of melting surfaces.
    pub struct ThermalArchard {
        k: "" = 1e-5, 0.0, 1e3, "K, wear coefficient";
        hardness: "Pa" = 2.6e9, 1.0, 1e30, "H_0, hardness of the softer body when cold";
        cold: "K" = 293.15, 0.0, 1e6, "T_0, temperature up to which the hardness is H_0";
        melting: "K" = 1800.0, 0.0, 1e6, "T_m, melting temperature";
        exponent: "" = 1.0, 1e-3, 1e3, "m";
        least: "" = 1e-2, 1e-12, 1.0, "share of H_0 that is left at melting";
    }
}

impl Law for ThermalArchard {
    const NAME: &'static str = "thermal-archard";
    const DOC: &'static str =
        "volume K F s/H(T), with a hardness that falls with the (flash) temperature of the contact";
    const REFERENCE: &'static str =
        "J. F. Archard, Wear 2 (1959) 438-455; S. C. Lim, M. F. Ashby, Acta Metall. 35 (1987) 1-24";
    const FLAGS: u64 = abi::FLAG_TEMPERATURE;

    fn validate(&self) -> Result<(), String> {
        require(self.cold < self.melting, "`melting` must be above `cold`")
    }
}

impl ThermalArchard {
    /// Hardness at a temperature (Pa).
    fn hardness(&self, temperature: f64) -> f64 {
        let share = ((temperature - self.cold) / (self.melting - self.cold)).clamp(0.0, 1.0);
        self.hardness * (1.0 - share.powf(self.exponent)).max(self.least)
    }
}

impl WearLaw for ThermalArchard {
    fn volume(&self, site: &Site, _state: &mut [f64]) -> f64 {
        self.k / self.hardness(site.temperature) * site.force() * site.slip
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::compressed;

    #[test]
    fn wears_more_when_hot() {
        let law = ThermalArchard {
            cold: 300.0,
            melting: 1300.0,
            ..ThermalArchard::default()
        };
        let at = |temperature: f64| {
            let site = Site {
                temperature,
                slip: 1e-3,
                ..compressed(20.0)
            };
            law.volume(&site, &mut [])
        };
        let cold = 1e-5 / 2.6e9 * 20.0 * 1e-3;
        for (temperature, times) in [(0.0, 1.0), (800.0, 2.0), (2000.0, 100.0)] {
            assert!((at(temperature) / (times * cold) - 1.0).abs() < 1e-12);
        }
    }
}
