//! Bonds whose stiffness and strength decrease with temperature, to zero at the melting point.
use fretwork_law::{DamageLaw, Intact, Law, Site, abi, parameters, require};

parameters! {
    /// Let x = (T - T_0)/(T_m - T_0), limited to 0 and 1. The traction of a bond with damage D,
    /// (1 - D)^n t_0, is limited to (1 - x^m) t_0, so D is at least 1 - (1 - x^m)^(1/n). The bond
    /// breaks where its traction leaves the envelope of the strengths times s = 1 - x^k: t_n > s
    /// tensile_strength or |t_t| > s (cohesion + friction p). Softening is permanent: a bond that
    /// cools does not become stiffer again, so that no energy comes from heat.
    pub struct ThermalSoftening {
        tensile_strength: "Pa" = 1e8, 0.0, 1e30, "normal traction at which a cold bond breaks";
        cohesion: "Pa" = 1e8, 0.0, 1e30, "shear traction at which a cold bond breaks without pressure";
        friction: "" = 0.5, 0.0, 100.0, "growth of the shear strength with the pressure";
        cold: "K" = 293.15, 0.0, 1e6, "T_0, temperature up to which bonds are as given";
        melting: "K" = 1800.0, 0.0, 1e6, "T_m, temperature at which they are gone";
        stiffness_exponent: "" = 1.0, 1e-3, 1e3, "m";
        strength_exponent: "" = 1.0, 1e-3, 1e3, "k";
    }
}

impl Law for ThermalSoftening {
    const NAME: &'static str = "thermal-softening";
    const DOC: &'static str = "stiffness and strength of a bond fall with temperature, to 0 at melting; brittle at a Mohr-Coulomb envelope";
    const REFERENCE: &'static str = "thermal factor of G. R. Johnson, W. H. Cook, Proc. 7th Int. Symp. Ballistics (1983) 541-547; envelope of mohr-coulomb-brittle";
    const FLAGS: u64 = abi::FLAG_TEMPERATURE;

    fn validate(&self) -> Result<(), String> {
        require(self.cold < self.melting, "`melting` must be above `cold`")
    }
}

impl ThermalSoftening {
    /// Returns the fractions of stiffness and strength that remain at a temperature.
    fn left(&self, temperature: f64) -> [f64; 2] {
        let range = self.melting - self.cold;
        let x = match range > 0.0 {
            true => ((temperature - self.cold) / range).clamp(0.0, 1.0),
            false => f64::from(u8::from(temperature > self.cold)),
        };
        [self.stiffness_exponent, self.strength_exponent].map(|power| 1.0 - x.powf(power))
    }
}

impl DamageLaw for ThermalSoftening {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        let [stiffness, strength] = self.left(site.temperature);
        if stiffness <= 0.0 || strength <= 0.0 {
            return 1.0;
        }
        let power = match intact.degradation > 0.0 {
            true => intact.degradation,
            false => 1.0,
        };
        let soft = 1.0 - stiffness.powf(1.0 / power);
        // The host reports a damage that is not a number, so it is not checked here.
        let damage = soft.max(site.damage).min(1.0);
        let carried = (1.0 - damage).powf(power);
        let [n, t1, t2] = intact.traction.map(|t| carried * t);
        let sheared = t1.hypot(t2);
        let broken = n > self.tensile_strength * strength
            || sheared > (self.cohesion + self.friction * site.pressure()) * strength;
        if broken { 1.0 } else { damage }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(temperature: f64, traction: f64, damage: f64, degradation: f64) -> f64 {
        let law = ThermalSoftening {
            cold: 300.0,
            melting: 1300.0,
            ..ThermalSoftening::default()
        };
        let site = Site {
            temperature,
            damage,
            area: 1.0,
            h: 1.0,
            ..Site::default()
        };
        let intact = Intact {
            traction: [traction, 0.0, 0.0],
            degradation,
            ..Intact::default()
        };
        law.grow(&site, &intact, &mut [])
    }

    #[test]
    fn softens_and_melts() {
        assert_eq!(
            (at(250.0, 9.9e7, 0.0, 1.0), at(250.0, 1.1e8, 0.0, 1.0)),
            (0.0, 1.0)
        );
        assert_eq!(at(800.0, 4e7, 0.0, 1.0), 0.5);
        // (1 - D)^2 is one half.
        assert!((at(800.0, 4e7, 0.0, 2.0) - (1.0 - 0.5f64.sqrt())).abs() < 1e-15);
        // Stiffness and strength decrease equally, so the bond breaks at an equal opening.
        assert_eq!(
            (at(800.0, 9.9e7, 0.0, 1.0), at(800.0, 1.01e8, 0.0, 1.0)),
            (0.5, 1.0)
        );
        assert_eq!(
            (at(1300.0, 0.0, 0.0, 1.0), at(300.0, 0.0, 0.7, 1.0)),
            (1.0, 0.7)
        );
    }
}
