//! Derjaguin, Muller and Toporov: stiff contacts whose attraction acts across the gap.
use fretwork_law::{CohesionLaw, Law, Site, Traction, parameters};

parameters! {
    /// Spheres: F = 2 pi w R in contact, decreasing as (1 + gap/z_0)^-2 with the gap; R is the
    /// reduced radius.
    pub struct Dmt {
        w: "J/m^2" = 0.1, 0.0, 1e30, "work of adhesion";
        z_0: "m" = 4e-10, 1e-12, 1.0, "range of the attraction";
        range: "m" = 1e-7, 0.0, 1e30, "largest gap over which it acts";
    }
}

impl Law for Dmt {
    const NAME: &'static str = "dmt";
    const DOC: &'static str =
        "Derjaguin-Muller-Toporov adhesion of stiff spheres, pull-off 2 pi w R";
    const REFERENCE: &'static str =
        "B. V. Derjaguin, V. M. Muller, Y. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314-326";
    const FLAGS: u64 = fretwork_law::abi::FLAG_3D_ONLY;
}

impl CohesionLaw for Dmt {
    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if !(site.gap <= self.range && site.area > 0.0) {
            return Traction::default();
        }
        let far = 1.0 + site.gap.max(0.0) / self.z_0;
        let force = std::f64::consts::TAU * self.w * site.radius.max(0.0) / (far * far);
        Traction::attraction(force, site)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pull-off force is 2 pi w R, and the work of separation of the spheres 2 pi w R z_0.
    #[test]
    fn pull_off_and_work_are_closed_forms() {
        let law = Dmt {
            range: 1.0,
            ..Dmt::default()
        };
        let r = 1e-5;
        let force = |gap| {
            let site = Site {
                gap,
                radius: r,
                area: 1e-10,
                dimension: 3,
                ..Site::default()
            };
            law.traction(&site, &[]).tension_strength * 1e-10
        };
        let pull_off = std::f64::consts::TAU * 0.1 * r;
        assert!((force(-1e-9) / pull_off - 1.0).abs() < 1e-12);
        // Substituting s = 1/(1 + gap/z_0) the work is the integral of F z_0/s^2 over s in (0, 1).
        let n = 1000;
        let work: f64 = (0..n)
            .map(|k| {
                let s = (f64::from(k) + 0.5) / f64::from(n);
                force(law.z_0 * (1.0 / s - 1.0)) * law.z_0 / (s * s) / f64::from(n)
            })
            .sum();
        assert!((work / (pull_off * law.z_0) - 1.0).abs() < 1e-9);
    }
}
