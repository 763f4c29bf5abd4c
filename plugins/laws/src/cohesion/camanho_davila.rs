//! Camanho and Davila's bilinear law in mixed mode, with the Benzeggagh-Kenane fracture energy.
use fretwork_law::{CohesionLaw, Law, Site, Traction, abi, parameters};

parameters! {
    /// On u = sqrt(<u_n>^2 + |u_t|^2) with B = |u_t|/u_n: onset d_0 = d_3 d_s sqrt((1 +
    /// B^2)/(d_s^2 + (B d_3)^2)), d_3 = strength_n/K, d_s = strength_t/K; G_c = g_1 + (g_2 -
    /// g_1)(B^2/(1 + B^2))^eta; end d_f = 2 G_c/(K d_0); D = d_f (u - d_0)/(u (d_f - d_0)), never
    /// decreasing. The defaults are for AS4/PEEK.
    pub struct CamanhoDavila {
        k: "Pa/m" = 1e15, 1.0, 1e30, "stiffness, the same in both directions";
        strength_n: "Pa" = 8e7, 1e-30, 1e30, "strength in mode I";
        strength_t: "Pa" = 1e8, 1e-30, 1e30, "strength in mode II";
        g_1: "J/m^2" = 969.0, 1e-30, 1e30, "fracture energy in mode I";
        g_2: "J/m^2" = 1719.0, 1e-30, 1e30, "fracture energy in mode II";
        eta: "" = 2.284, 1e-3, 100.0, "exponent of Benzeggagh and Kenane";
    }
}

impl Law for CamanhoDavila {
    const NAME: &'static str = "camanho-davila";
    const DOC: &'static str =
        "bilinear mixed-mode cohesion with the Benzeggagh-Kenane fracture energy";
    const REFERENCE: &'static str = "P. P. Camanho, C. G. Davila, M. F. de Moura, J. Compos. Mater. 37 (2003) 1415-1438; M. L. Benzeggagh, M. Kenane, Compos. Sci. Technol. 56 (1996) 439-449";
    const FLAGS: u64 =
        abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_BREAKS | abi::FLAG_FORMS;

    fn fracture_energy(&self, angle: f64) -> Option<f64> {
        Some(self.mix(angle.cos().max(0.0), angle.sin().abs()).1)
    }

    fn validate(&self) -> Result<(), String> {
        for (s, g, mode) in [
            (self.strength_n, self.g_1, "I"),
            (self.strength_t, self.g_2, "II"),
        ] {
            if s * s >= 2.0 * self.k * g {
                return Err(format!(
                    "strength^2/(2 k) must be below the fracture energy in mode {mode}: raise k"
                ));
            }
        }
        // In mixed mode the energy at onset may exceed the fracture energy, and 1 - D may round
        // to 0.
        for step in 0..=90 {
            let angle = f64::from(step).to_radians();
            let (onset, energy) = self.mix(angle.cos(), angle.sin());
            let held = 0.5 * self.k * onset * onset;
            if held >= energy {
                return Err(format!(
                    "at {step} degrees from the normal the elastic part alone holds more than the fracture energy: raise k"
                ));
            }
            if held < 1e-12 * energy {
                return Err("k is so high that 1 - D cannot be distinguished from 0: lower k, or raise the strengths".into());
            }
        }
        Ok(())
    }
}

impl CamanhoDavila {
    /// Returns onset and fracture energy for the mode mix of a normal (not negative) and a
    /// tangential opening.
    fn mix(&self, n: f64, t: f64) -> (f64, f64) {
        let u = n.hypot(t);
        let (c, s) = if u > 0.0 { (n / u, t / u) } else { (1.0, 0.0) };
        let (d3, ds) = (self.strength_n / self.k, self.strength_t / self.k);
        // The onset is computed from cosine and sine of the mixed-mode angle, which have no pole in
        // mode II.
        let onset = d3 * ds / (ds * c).hypot(d3 * s);
        // This form is used instead of g_1 + (g_2 - g_1) share, which loses digits if one energy is
        // much larger than the other.
        let share = (s * s).powf(self.eta).min(1.0);
        (onset, self.g_1 * (1.0 - share) + self.g_2 * share)
    }
}

impl CohesionLaw for CamanhoDavila {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        Traction::damaged(site, self.k)
    }

    fn energy(&self, site: &Site, _state: &[f64]) -> f64 {
        Traction::damaged_energy(site, self.k)
    }

    fn commit(&self, site: &Site, _state: &mut [f64]) -> f64 {
        let (n, t) = (site.normal_opening(), site.tangential_opening());
        let u = site.effective_opening();
        let (onset, energy) = self.mix(n, t);
        let end = 2.0 * energy / (self.k * onset);
        if u <= onset {
            return site.damage;
        }
        if u >= end {
            return 1.0;
        }
        (end * (u - onset) / (u * (end - onset))).max(site.damage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    /// For AS4/PEEK G_c is 0.98799, 1.12300 and 1.41952 N/mm at G_II/G_T of 0.2, 0.5 and 0.8, by
    /// integration of the traction at a fixed mode mix.
    #[test]
    fn mixed_modes_take_the_energy_of_benzeggagh_and_kenane() {
        let law = CamanhoDavila::default();
        for (share, expected) in [
            (0.0, 969.0),
            (0.2, 987.99),
            (0.5, 1123.00),
            (0.8, 1419.52),
            (1.0, 1719.0),
        ] {
            let (s, c) = (f64::sqrt(share), f64::sqrt(1.0 - share));
            let area = testing::pull_breaking(&law, [c, 0.0, s], 50e-6, 200_000).area;
            assert!((area / expected - 1.0).abs() < 1e-4, "{share}: {area}");
        }
    }

    #[test]
    fn the_onset_is_the_papers() {
        let law = CamanhoDavila::default();
        let (d3, ds, b) = (law.strength_n / law.k, law.strength_t / law.k, 0.7);
        let expected = d3 * ds * ((1.0 + b * b) / (ds * ds + (b * d3) * (b * d3))).sqrt();
        assert!((law.mix(1.0, b).0 / expected - 1.0).abs() < 1e-12);
        assert!((law.mix(0.0, 1.0).0 / ds - 1.0).abs() < 1e-12);
    }

    /// The stored energy at onset, K d_0^2/2, is 0.8 and 845 J/m^2 in the pure modes, below the
    /// fracture energies. At 30 degrees it exceeds its bound: 1/(c^2/0.8 + s^2/845) is 1.066, the
    /// bound 1 + 999 s^20 = 1.001.
    #[test]
    fn a_mix_that_snaps_is_refused() {
        let law = CamanhoDavila {
            strength_n: 4e7,
            strength_t: 1.3e9,
            g_1: 1.0,
            g_2: 1000.0,
            eta: 10.0,
            ..CamanhoDavila::default()
        };
        assert!(law.validate().is_err() && CamanhoDavila::default().validate().is_ok());
    }

    #[test]
    fn mode_two_keeps_its_energy_beside_a_huge_mode_one() {
        let law = CamanhoDavila {
            g_1: 1e30,
            ..CamanhoDavila::default()
        };
        assert!((law.mix(0.0, 1.0).1 / 1719.0 - 1.0).abs() < 1e-12);
    }
}
