//! Outputs of a law for a contact.

use crate::Site;

/// Output of a transport law (per metre of depth in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conductance {
    /// Thermal conductance (W/K).
    pub thermal: f64,
    /// Electrical conductance (S).
    pub electric: f64,
}

/// Output of a contact law.
#[derive(Clone, Copy, Debug, Default)]
pub struct Friction {
    /// Friction coefficient.
    pub mu: f64,
    /// Normal restitution.
    pub restitution_n: f64,
    /// Tangential restitution.
    pub restitution_t: f64,
    /// Tension strength c_n (Pa).
    pub tension_strength: f64,
    /// Shear cohesion c_t (Pa).
    pub shear_cohesion: f64,
    /// Rolling friction length (m).
    pub rolling: f64,
    /// Spinning friction length (m).
    pub spinning: f64,
}

impl Friction {
    /// Returns Coulomb friction with this coefficient, without other effects.
    pub fn coulomb(mu: f64) -> Self {
        Self {
            mu,
            ..Self::default()
        }
    }
}

/// Output of a cohesion law: traction at the current opening and damage, with its stiffness.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traction {
    /// Traction (Pa); a positive normal component is attractive.
    pub traction: [f64; 3],
    /// Normal stiffness, tangent or secant (Pa/m).
    pub stiffness_n: f64,
    /// Tangential stiffness (Pa/m).
    pub stiffness_t: f64,
    /// Normal damping (Pa s/m).
    pub damping_n: f64,
    /// Tangential damping (Pa s/m).
    pub damping_t: f64,
    /// Attraction without opening, c_n (Pa).
    pub tension_strength: f64,
    /// Shear cohesion, c_t (Pa).
    pub shear_cohesion: f64,
    /// Moment over the area (N m/m^2) against the rotation, with `FLAG_MOMENT`.
    pub moment: [f64; 3],
    /// Twisting stiffness over the area (N m/m^2 per rad).
    pub stiffness_twist: f64,
    /// Bending stiffness over the area (N m/m^2 per rad).
    pub stiffness_bend: f64,
}

impl Traction {
    /// Returns an attractive force of the contact (N; N/m in 2D) as a stress over its area.
    pub fn attraction(force: f64, site: &Site) -> Self {
        Self {
            // A very small area overflows.
            tension_strength: (force / site.area).min(f64::MAX),
            ..Self::default()
        }
    }

    /// Returns the response of a bond with one stiffness k (Pa/m) that damage reduces, (1 - D) k u;
    /// zero once it is broken.
    pub fn damaged(site: &Site, k: f64) -> Self {
        if site.damage >= 1.0 {
            return Self::default();
        }
        let k = (1.0 - site.damage) * k;
        Self::linear(site, k, k)
    }

    /// Returns the energy that the bond of [`Self::damaged`] stores (J/m^2).
    pub fn damaged_energy(site: &Site, k: f64) -> f64 {
        if site.damage >= 1.0 {
            return 0.0;
        }
        let u = site.effective_opening();
        bounded(0.5 * (1.0 - site.damage) * k * u * u)
    }

    /// Returns a response linear in the opening, with stiffnesses (Pa/m) along the normal and the
    /// tangents.
    pub fn linear(site: &Site, stiffness_n: f64, stiffness_t: f64) -> Self {
        let [n, t1, t2] = site.opening;
        Self {
            traction: [stiffness_n * n, stiffness_t * t1, stiffness_t * t2].map(bounded),
            stiffness_n,
            stiffness_t,
            ..Self::default()
        }
    }
}

/// Replaces overflows by finite numbers, since non-finite numbers stop the run.
pub fn bounded(x: f64) -> f64 {
    x.clamp(-f64::MAX, f64::MAX)
}
