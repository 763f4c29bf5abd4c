//! The rate law of Monerie, Acary and Cangemi: b dD/dt = <Y - w>_+, Y = -d psi/d D.
use fretwork_law::{DamageLaw, Intact, Law, Site, parameters};

parameters! {
    /// With b = 0 and a cohesion of exponent m = 2 a bond that opens without limit dissipates
    /// exactly w. Its intensity of adhesion decreases as 1/u^2 and never reaches 0 by itself: below
    /// `beta_broken` the bond counts as broken (0 disables this). The host must add the energy
    /// stored at that moment, at most beta_broken w/2, to the fracture energy; the bond has then
    /// dissipated w (1 - beta_broken/2).
    pub struct MacDamage {
        w: "J/m^2" = 0.1, 0.0, 1e30, "Dupre's energy: fracture energy of the bond";
        b: "J s/m^2" = 0.0, 0.0, 1e30, "viscosity of damage";
        beta_broken: "" = 1e-3, 0.0, 1.0, "intensity of adhesion below which the bond is broken";
        opening_broken: "m" = 1e30, 1e-30, 1e30, "normal opening beyond which the bond is broken, whatever it still carries";
    }
}

/// Value of `opening_broken` with which a bond never breaks by its opening (m).
const NEVER: f64 = 1e30;

impl Law for MacDamage {
    const NAME: &'static str = "mac";
    const DOC: &'static str = "rate law b dD/dt = <Y - w>, with fracture energy w and viscosity b";
    const REFERENCE: &'static str = "Y. Monerie, V. Acary, Formulation dynamique d'un modele de zone cohesive tridimensionnel, Rev. Eur. Elements Finis 10 (2001); M. Raous, L. Cangemi, M. Cocou, Comput. Methods Appl. Mech. Engrg 177 (1999) 383-399";

    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        // Viscosity increases the energy with the speed. The cut at beta_broken reduces it by a
        // fraction that depends on m, the cut at an opening by one that depends on the stiffness.
        let tail = self.beta_broken <= 5e-3 && self.opening_broken >= NEVER;
        (self.b == 0.0 && tail).then_some(self.w)
    }
}

impl MacDamage {
    /// Returns D at the end of a step of h seconds, implicit for m >= 1: b (D - D_i)/h = Y(D) - w.
    fn damage(&self, d: f64, h: f64, intact: &Intact) -> f64 {
        if d >= 1.0 || intact.release_rate(d) <= self.w {
            return d;
        }
        let m = intact.degradation;
        if m == 2.0 {
            let beta = (h * self.w + self.b * (1.0 - d)) / (self.b + h * 2.0 * intact.energy);
            return 1.0 - beta;
        }
        if m <= 1.0 {
            // Y does not decrease as D grows, so without viscosity the bond breaks at once.
            return if self.b > 0.0 {
                d + h * (intact.release_rate(d) - self.w) / self.b
            } else {
                1.0
            };
        }
        // Y(D) - w - b (D - D_i)/h decreases from above zero at D_i to below zero at 1.
        let (mut low, mut high) = (d, 1.0);
        while high - low > f64::EPSILON {
            let mid = 0.5 * (low + high);
            if intact.release_rate(mid) - self.w > self.b * (mid - d) / h {
                low = mid;
            } else {
                high = mid;
            }
        }
        0.5 * (low + high)
    }
}

impl DamageLaw for MacDamage {
    fn grow(&self, site: &Site, intact: &Intact, _state: &mut [f64]) -> f64 {
        // `max` and `min` rather than `clamp`, so that a NaN damage reaches the host, which reports
        // it.
        let d = self.damage(site.damage, site.h, intact);
        let d = d.max(site.damage).min(1.0);
        let broken = 1.0 - d < self.beta_broken || site.opening[0] > self.opening_broken;
        if broken { 1.0 } else { d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing::{Bond, opened};

    /// A bond in steps of `h` (s).
    fn bond(law: &MacDamage, damage: f64, h: f64) -> Bond<'_, MacDamage> {
        let mut bond = Bond::new(law, damage);
        bond.site.h = h;
        bond
    }

    /// Returns an undamaged bond that stores an energy (J/m^2).
    fn stores(energy: f64, degradation: f64) -> Intact {
        Intact {
            energy,
            degradation,
            ..Intact::default()
        }
    }

    /// Opens a MAC bond (C = 1e12 Pa/m) at a speed to an opening; returns (peak, area to the end).
    fn pull(law: &MacDamage, speed: f64, h: f64, reach: f64) -> (f64, f64) {
        let (mut peak, mut area, mut last, mut u) = (0.0f64, 0.0, 0.0, 0.0);
        let mut bond = bond(law, 0.0, h);
        while u < reach {
            u += speed * h;
            let left = 1.0 - bond.lead(&opened(1e12, u, 2.0));
            let sigma = left * left * 1e12 * u;
            area += 0.5 * (sigma + last) * speed * h;
            last = sigma;
            peak = peak.max(sigma);
        }
        (peak, area)
    }

    /// Returns a law without cuts, with w of 0.1 J/m^2.
    fn uncut(b: f64) -> MacDamage {
        MacDamage {
            w: 0.1,
            b,
            beta_broken: 0.0,
            ..MacDamage::default()
        }
    }

    #[test]
    fn without_viscosity_peak_and_area_are_closed_forms() {
        let (peak, area) = pull(&uncut(0.0), 0.045, 2e-9, 3.16228e-6);
        assert!((peak / 0.316228e6 - 1.0).abs() < 1e-3, "{peak}");
        assert!((area / 0.0994998 - 1.0).abs() < 1e-3, "{area}");
    }

    /// The results approach the values of the continuum limit for du/dt = 0.045 m/s and an opening
    /// to 100 um.
    #[test]
    fn with_viscosity_it_meets_the_ode() {
        for (b, peak, area) in [
            (1e-6, 0.36159e6, 0.16741),
            (1e-5, 0.52941e6, 0.44568),
            (1e-4, 0.98853e6, 1.71835),
        ] {
            let (p, a) = pull(&uncut(b), 0.045, 5e-9, 100e-6);
            let near = (p / peak - 1.0).abs() < 1e-2 && (a / area - 1.0).abs() < 1e-2;
            assert!(near, "b {b}: {p} {a}");
        }
    }

    #[test]
    fn damage_never_falls_and_waits_for_the_threshold() {
        let law = MacDamage::default();
        let at = |damage| bond(&law, damage, 1e-6).lead(&stores(0.01, 2.0));
        assert_eq!((at(0.0), at(0.4), at(1.0)), (0.0, 0.4, 1.0));
    }

    #[test]
    fn it_breaks_beyond_an_opening() {
        let law = MacDamage {
            opening_broken: 2e-5,
            ..MacDamage::default()
        };
        let at = |opening| {
            let mut bond = bond(&law, 0.0, 1e-6);
            bond.site.opening = [opening, 1.0, 0.0];
            bond.lead(&Intact::default())
        };
        assert_eq!((at(2e-5), at(2.001e-5), at(-1.0)), (0.0, 1.0, 0.0));
        assert!(law.fracture_energy(0.0).is_none());
        assert!(MacDamage::default().fracture_energy(0.0).is_some());
    }

    #[test]
    fn a_brittle_bond_snaps_at_w() {
        let law = MacDamage::default();
        let at = |energy| bond(&law, 0.0, 1e-6).lead(&stores(energy, 1.0));
        assert_eq!((at(0.0999), at(0.1001)), (0.0, 1.0));
    }

    #[test]
    fn other_exponents_solve_the_implicit_equation() {
        // This is one step of 1 us from D = 0.2, with psi_0 = 0.3 J/m^2.
        let step = |law: &MacDamage, m: f64| bond(law, 0.2, 1e-6).lead(&stores(0.3, m));
        for (m, b) in [(1.5, 1e-6), (3.0, 1e-6), (3.0, 0.0), (2.5, 1e-7)] {
            let d = step(&uncut(b), m);
            let y = m * (1.0 - d).powf(m - 1.0) * 0.3;
            assert!((b * (d - 0.2) / 1e-6 - (y - 0.1)).abs() < 1e-12, "{m} {b}");
        }
        let law = MacDamage {
            b: 1e-6,
            ..MacDamage::default()
        };
        assert!((step(&law, 2.0) - step(&law, 2.0 + 1e-9)).abs() < 1e-8);
        // For m = 1, D = D_i + h (psi_0 - w)/b.
        assert!((step(&law, 1.0) - 0.4).abs() < 1e-12);
    }

    /// The cut at `beta_broken` reduces the energy by no more than beta_broken w/2.
    #[test]
    fn the_cut_is_where_the_doc_says() {
        let law = MacDamage::default();
        let at = |beta: f64| bond(&law, 0.0, 1e-6).lead(&stores(0.5 * law.w / beta, 2.0));
        assert!(at(0.999e-3) == 1.0 && at(1.001e-3) < 1.0);
    }
}
