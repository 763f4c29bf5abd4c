//! The spring of a compliant contact, and the damping for a given restitution of impacts.

use crate::Site;

/// The unilateral spring of a compliant contact at the site's overlap (N, N/m; per metre of depth
/// in 2D).
#[derive(Clone, Copy, Debug, Default)]
pub struct Spring {
    /// Compressive force (N; N/m in 2D).
    pub force_n: f64,
    /// Slope of the normal force with the overlap (N/m).
    pub stiffness_n: f64,
    /// Normal damping (N s/m).
    pub damping_n: f64,
    /// Tangential force at the start of the step: the site's `spring_t`, unless the law changes it.
    pub force_t: [f64; 2],
    /// Slope of the tangential force (N/m); 0 for a rigid tangential contact.
    pub stiffness_t: f64,
    /// Slope of the tangential force on unloading (N/m), if it differs; 0 otherwise. Displacement
    /// beyond that of this slope is slip.
    pub unloading_t: f64,
    /// Energy stored in the tangential spring (J), if it differs from T^2/2 over the slope on
    /// unloading; 0 otherwise.
    pub energy_t: f64,
    /// Tangential damping (N s/m).
    pub damping_t: f64,
}

impl Spring {
    /// Returns a linear spring of stiffness k along the normal and `ratio` times k along the
    /// tangents, with a damping ratio ([`damping_ratio`]).
    pub fn linear(site: &Site, stiffness: f64, ratio: f64, damping: f64) -> Self {
        let k_t = (ratio * stiffness).min(f64::MAX);
        Self {
            force_n: (stiffness * site.overlap).min(f64::MAX),
            stiffness_n: stiffness,
            damping_n: 2.0 * damping * (stiffness * site.effective_mass).sqrt(),
            force_t: site.spring_t,
            stiffness_t: k_t,
            unloading_t: k_t,
            energy_t: 0.0,
            damping_t: 0.0,
        }
    }
}

/// Returns the damping ratio zeta of a linear spring, d = 2 zeta sqrt(k m), whose impacts rebound
/// with this fraction of the approach velocity. The contact ends as soon as its force is zero,
/// before its overlap is (T. Schwager, T. Poschel, Granular Matter 9 (2007) 465, eqs. 20 to 22).
/// The ratio also holds for Hertz' spring with d = 2 zeta sqrt(5/6) sqrt(k m) at each overlap, k
/// the slope.
///
/// For a restitution of 0 the ratio is infinite; the value for 1e-6 is returned instead.
pub fn damping_ratio(restitution: f64) -> f64 {
    thread_local! {
        // A law requests the same ratio in each batch, so the last one is stored.
        static LAST: std::cell::Cell<(f64, f64)> = const { std::cell::Cell::new((1.0, 0.0)) };
    }
    let (asked, ratio) = LAST.get();
    if asked == restitution {
        return ratio;
    }
    let ratio = find_damping_ratio(restitution);
    LAST.set((restitution, ratio));
    ratio
}

fn find_damping_ratio(restitution: f64) -> f64 {
    let wanted = restitution.clamp(1e-6, 1.0);
    if wanted == 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1e4);
    for _ in 0..60 {
        // The interval shrinks from 1e4 to 1e-14.
        let middle = 0.5 * (low + high);
        if rebound(middle) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Restitution of a linear spring with damping ratio zeta.
fn rebound(zeta: f64) -> f64 {
    use std::f64::consts::PI;
    let share = 2.0 * zeta * zeta;
    if zeta < 1.0 {
        let w = (1.0 - zeta * zeta).sqrt();
        let angle = (2.0 * zeta * w).atan2(1.0 - share);
        (-zeta / w * (PI - angle)).exp()
    } else if zeta == 1.0 {
        (-2.0f64).exp()
    } else {
        let w = (zeta * zeta - 1.0).sqrt();
        // (zeta + w)/(zeta - w) = (zeta + w)^2
        (-zeta / w * 2.0 * (zeta + w).ln()).exp()
    }
}
