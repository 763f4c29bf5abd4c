//! Johnson, Kendall and Roberts: soft spheres that form a neck before they separate. Here they are
//! rigid in compression.
use fretwork_law::{CohesionLaw, Law, Site, Traction, Variable, parameters};
use std::f64::consts::PI;

parameters! {
    /// Once the spheres touch, the attraction follows the neck. With the pull-off P_c = 3 pi w R/2
    /// and the contact radius x = a/a_0, a_0^3 = 9 pi w R^2/(2 E): F = 4 P_c (x^(3/2) - x^3)
    /// attracts at the approach d = (a_0^2/R)(x^2 - (2/3) x^(1/2)). At d = 0 it is 8/9 of the
    /// pull-off; under imposed displacement the neck breaks at 5/9 of it, d = -(3/4)(pi^2 w^2
    /// R/E^2)^(1/3). R is the reduced radius.
    pub struct Jkr {
        w: "J/m^2" = 0.1, 0.0, 1e30, "work of adhesion";
        modulus: "Pa" = 1e11, 1.0, 1e30, "reduced modulus E*";
    }
}

/// Value of x at which the neck breaks, the turning point of the approach: d(x^2 - (2/3)
/// x^(1/2))/dx = 0.
fn tear() -> f64 {
    (1.0f64 / 6.0).powf(2.0 / 3.0)
}

impl Law for Jkr {
    const NAME: &'static str = "jkr";
    const DOC: &'static str =
        "Johnson-Kendall-Roberts adhesion: pull-off 3 pi w R/2, necks, tears at a distance";
    const REFERENCE: &'static str =
        "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301-313";
    const FLAGS: u64 = fretwork_law::abi::FLAG_3D_ONLY;
    const VARIABLES: &'static [Variable] =
        &[Variable::new(c"neck", c"", c"1 while a neck holds").written()];
}

impl Jkr {
    /// Length scale of the approach a_0^2/R (m).
    fn length(&self, r: f64) -> f64 {
        // (a_0/R)^3 is computed first, since R^2 alone over- and underflows. It must not be zero,
        // as gaps are divided by it.
        let a = (4.5 * PI * self.w / self.modulus / r).cbrt();
        (a * a * r).clamp(f64::MIN_POSITIVE, f64::MAX)
    }

    /// Gap at which the neck breaks (m).
    fn reach(&self, r: f64) -> f64 {
        let x = tear();
        self.length(r) * (2.0 / 3.0 * x.sqrt() - x * x)
    }

    /// Attractive force at a gap (N), between contact (d = 0) and the break of the neck.
    fn force(&self, gap: f64, r: f64) -> f64 {
        let pull_off = 1.5 * PI * self.w * r;
        let gap = gap.max(0.0) / self.length(r);
        // The left side of x^2 - (2/3) sqrt(x) = -gap increases with x from the break to d = 0.
        let (mut low, mut high) = (tear(), (2.0f64 / 3.0).powf(2.0 / 3.0));
        for _ in 0..60 {
            let x = 0.5 * (low + high);
            if x * x - 2.0 / 3.0 * x.sqrt() < -gap {
                low = x;
            } else {
                high = x;
            }
        }
        let x = 0.5 * (low + high);
        pull_off * 4.0 * (x * x.sqrt() - x * x * x)
    }
}

impl CohesionLaw for Jkr {
    fn traction(&self, site: &Site, state: &[f64]) -> Traction {
        let r = site.radius;
        let sized = r > 0.0 && site.area > 0.0 && self.w > 0.0;
        if !sized || !(site.gap <= 0.0 || (state[0] > 0.5 && site.gap <= self.reach(r))) {
            return Traction::default();
        }
        Traction::attraction(self.force(site.gap, r), site)
    }

    fn commit(&self, site: &Site, state: &mut [f64]) -> f64 {
        let holds = state[0] > 0.5 && site.radius > 0.0 && site.gap <= self.reach(site.radius);
        state[0] = f64::from(u8::from(site.touches() || holds));
        site.damage
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solution is compared with F(a) = 4 E a^3/(3 R) - sqrt(8 pi w E a^3), d = a^2/R - sqrt(2
    /// pi w a/E) of the paper.
    #[test]
    fn the_neck_is_the_papers_curve() {
        let law = Jkr::default();
        let (r, e, w) = (1e-5, law.modulus, law.w);
        let pull_off = 1.5 * PI * w * r;
        let f = |a: f64| 4.0 * e * a.powi(3) / (3.0 * r) - (8.0 * PI * w * e * a.powi(3)).sqrt();
        let d = |a: f64| a * a / r - (2.0 * PI * w * a / e).sqrt();
        let a0 = (4.5 * PI * w * r * r / e).cbrt();
        let highest = (2.0f64 / 3.0).powf(2.0 / 3.0);
        let mut deepest = 0.0f64;
        for k in 0..=50 {
            let x = tear() + (highest - tear()) * f64::from(k) / 50.0;
            let a = a0 * x;
            assert!((law.force(-d(a), r) + f(a)).abs() < 1e-6 * pull_off, "{x}");
            deepest = deepest.max(law.force(-d(a), r));
        }
        assert!((deepest / pull_off - 1.0).abs() < 1e-3);
        assert!((law.force(0.0, r) / pull_off - 8.0 / 9.0).abs() < 1e-9);
        let reach = law.reach(r);
        assert!((law.force(reach, r) / pull_off - 5.0 / 9.0).abs() < 1e-5);
        // The neck breaks at (3/4) (pi^2 w^2 R/E^2)^(1/3).
        let known = 0.75 * (PI * PI * w * w * r / (e * e)).cbrt();
        assert!((reach / known - 1.0).abs() < 1e-6, "{reach} {known}");
    }
}
