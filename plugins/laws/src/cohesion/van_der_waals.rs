//! Van der Waals attraction of spheres or parallel cylinders, with a cut-off distance.
use fretwork_law::{CohesionLaw, Law, Site, Traction, parameters};

parameters! {
    /// Spheres: F = A R/(6 z^2); parallel cylinders, per length: F = A sqrt(R)/(8 sqrt(2) z^(5/2)),
    /// with R the reduced radius, z = gap + z_0 (z_0 in contact).
    pub struct VanDerWaals {
        hamaker: "J" = 1e-19, 0.0, 1.0, "Hamaker's constant A";
        z_0: "m" = 4e-10, 1e-12, 1.0, "distance in contact";
        range: "m" = 1e-7, 0.0, 1e30, "largest gap over which it acts";
    }
}

impl Law for VanDerWaals {
    const NAME: &'static str = "van-der-waals";
    const DOC: &'static str = "van der Waals attraction of spheres (3D) or parallel cylinders (2D)";
    const REFERENCE: &'static str = "H. C. Hamaker, Physica 4 (1937) 1058-1072; J. N. Israelachvili, Intermolecular and Surface Forces, 3rd ed. (2011), chapter 13";
}

impl VanDerWaals {
    fn force(&self, site: &Site) -> f64 {
        let z = site.gap.max(0.0) + self.z_0;
        let r = site.radius.max(0.0);
        if site.dimension == 2 {
            self.hamaker * r.sqrt() / (8.0 * std::f64::consts::SQRT_2 * z * z * z.sqrt())
        } else {
            self.hamaker * r / (6.0 * z * z)
        }
    }
}

impl CohesionLaw for VanDerWaals {
    fn traction(&self, site: &Site, _state: &[f64]) -> Traction {
        if !(site.gap <= self.range && site.area > 0.0) {
            return Traction::default();
        }
        Traction::attraction(self.force(site), site)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force is minus the slope of the energy -A R/(6 z), or per length of -A sqrt(R)/(12
    /// sqrt(2) z^(3/2)).
    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let law = VanDerWaals::default();
        let (r, area) = (5e-6, 1e-12);
        for dimension in [2, 3] {
            for gap in [0.0, 1e-9, 1e-8] {
                let site = Site {
                    gap,
                    radius: r,
                    area,
                    dimension,
                    ..Site::default()
                };
                let z = gap + law.z_0;
                let e = |z: f64| match dimension {
                    2 => -law.hamaker * r.sqrt() / (12.0 * 2f64.sqrt() * z.powf(1.5)),
                    _ => -law.hamaker * r / (6.0 * z),
                };
                let slope = (e(z * (1.0 + 1e-5)) - e(z * (1.0 - 1e-5))) / (2e-5 * z);
                let force = law.traction(&site, &[]).tension_strength * area;
                assert!((force / slope - 1.0).abs() < 1e-6, "{dimension} {gap}");
            }
        }
    }
}
