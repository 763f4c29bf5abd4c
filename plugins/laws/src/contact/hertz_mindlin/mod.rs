//! Elastic spheres in contact: Hertz' normal force, Mindlin and Deresiewicz' tangential force with
//! partial slip. In two dimensions elastic cylinders, whose normal stiffness is nearly constant.

mod profile;

use fretwork_law::{
    ContactLaw, Friction, Law, Site, Spring, Variable, abi, damping_ratio, parameters,
};
use profile::{KEPT, Pair, Profile, dot, minus, norm};
use std::f64::consts::FRAC_PI_4;
use std::ffi::CStr;

parameters! {
    /// With 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 and 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2,
    /// contact radius a = sqrt(R d): F = 4/3 E* sqrt(R) d^(3/2); tangential stiffness without slip
    /// k_0 = 8 G* a; slip from the rim inwards, annulus by annulus, for any history of load and
    /// displacement. In 2D F = pi/4 E* d and k_t/k_n = 4 G*/E*, as for spheres.
    pub struct HertzMindlin {
        young_1: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the first material";
        poisson_1: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the first material";
        young_2: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the second material";
        poisson_2: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the second material";
        restitution: "" = 1.0, 0.0, 1.0, "share of the approach velocity with which two bodies part";
        mu: "" = 0.3, 0.0, 1e6, "friction coefficient", friction;
    }
}

// Corners of the displacement profile that a contact stores, see [`profile`].
const fn overlap(name: &'static CStr) -> Variable {
    Variable::new(
        name,
        c"m",
        c"overlap, or that of a rim at a corner of the tangential displacement",
    )
}

const fn along(name: &'static CStr) -> Variable {
    Variable::new(
        name,
        c"m",
        c"tangential displacement at a corner, along the tangential force",
    )
}

const fn across(name: &'static CStr) -> Variable {
    Variable::new(
        name,
        c"m",
        c"tangential displacement at a corner, across the tangential force",
    )
}

impl Law for HertzMindlin {
    const NAME: &'static str = "hertz-mindlin";
    const DOC: &'static str = "elastic spheres (in 2D cylinders): Hertz' force, Mindlin's tangential force with partial slip, Coulomb friction";
    const REFERENCE: &'static str = "R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; K. L. Johnson, Contact Mechanics (1985) 4.2, 7.4; V. L. Popov, M. Hess, Method of Dimensionality Reduction (2015) 5.4";
    const FLAGS: u64 = abi::FLAG_COMPLIANT;
    const VARIABLES: &'static [Variable] = &[
        overlap(c"edge"),
        along(c"along_0"),
        across(c"across_0"),
        overlap(c"at_1"),
        along(c"along_1"),
        across(c"across_1"),
        overlap(c"at_2"),
        along(c"along_2"),
        across(c"across_2"),
        overlap(c"at_3"),
        along(c"along_3"),
        across(c"across_3"),
        overlap(c"at_4"),
        along(c"along_4"),
        across(c"across_4"),
        overlap(c"overlap"),
    ];
}

/// Index of the overlap among the variables.
const OVERLAP: usize = 15;
/// Smallest slope of the tangential force, as a fraction of k_0.
const MIN_SLOPE: f64 = 1e-3;
/// Fraction of the friction bound above which the whole contact is assumed to slip.
const WHOLE: f64 = 1.0 - 1e-3;

/// Factors by which the geometry of a contact of spheres turns its profile into forces.
struct Sphere {
    /// Stiffness k_0 (N/m), the factor 8 G* sqrt(R) of [`Profile::sums`] (N/m^1.5), and beta for a
    /// friction coefficient of 1.
    k_0: f64,
    scale: f64,
    beta: f64,
    force_n: f64,
}

impl HertzMindlin {
    /// Returns E* and 8 G* (Pa).
    fn moduli(&self) -> [f64; 2] {
        let sides = [
            (self.young_1, self.poisson_1),
            (self.young_2, self.poisson_2),
        ];
        let normal: f64 = sides.iter().map(|(e, nu)| (1.0 - nu * nu) / e).sum();
        let shear: f64 = sides
            .iter()
            .map(|(e, nu)| (2.0 - nu) * 2.0 * (1.0 + nu) / e)
            .sum();
        [1.0 / normal, 8.0 / shear]
    }

    fn sphere(&self, site: &Site) -> Sphere {
        let [modulus, shear] = self.moduli();
        let a = (site.radius * site.overlap).sqrt();
        Sphere {
            k_0: shear * a,
            scale: shear * site.radius.sqrt(),
            beta: 2.0 * modulus / shear,
            force_n: 4.0 / 3.0 * modulus * a * site.overlap,
        }
    }
}

/// Reads the profile that a contact stores. Its components are along and across the tangential
/// force, with which the host rotates them.
fn remembered(state: &[f64], force: Pair) -> Profile {
    let [x, y] = unit(force);
    let mut corners = [(0.0, [0.0; 2]); KEPT - 1];
    for (k, corner) in corners.iter_mut().enumerate() {
        let at = if k == 0 { 0.0 } else { state[3 * k] };
        let [along, across] = [state[3 * k + 1], state[3 * k + 2]];
        *corner = (at, [along * x - across * y, along * y + across * x]);
    }
    Profile::new(&corners, state[0])
}

/// Writes the profile for [`remembered`], with the overlap.
fn remember(profile: &Profile, overlap: f64, force: Pair, next: &mut [f64]) {
    let [x, y] = unit(force);
    next.fill(0.0);
    (next[0], next[OVERLAP]) = (profile.edge(), overlap);
    for (k, (at, [u, v])) in profile.corners().iter().take(KEPT - 1).enumerate() {
        if k > 0 {
            next[3 * k] = *at;
        }
        (next[3 * k + 1], next[3 * k + 2]) = (u * x + v * y, v * x - u * y);
    }
}

/// Direction of a force; the first axis for a zero force.
fn unit(force: Pair) -> Pair {
    let length = norm(force);
    if length > 0.0 {
        force.map(|t| t / length)
    } else {
        [1.0, 0.0]
    }
}

impl Sphere {
    /// The force of a profile (N).
    fn force(&self, profile: &Profile) -> Pair {
        profile.sums().0.map(|t| t * self.scale)
    }

    /// Returns the tangential part of a spring that carries `force_n`, including damping (N).
    fn tangential(&self, law: &HertzMindlin, site: &Site, state: &[f64], force_n: f64) -> Spring {
        let (d, bound) = (site.overlap, law.mu * force_n);
        let beta = if self.force_n > 0.0 {
            self.beta * bound / self.force_n
        } else {
            0.0
        };
        let mut profile = remembered(state, site.spring_t);
        profile.slip(d, beta);
        let (sum, squares) = profile.sums();
        let before = sum.map(|t| t * self.scale);
        let by = [site.h * site.velocity[1], site.h * site.velocity[2]];
        profile.shift(by);
        profile.slip(d, beta);
        let after = self.force(&profile);
        let expected = self.k_0 * dot(by, by);
        let share = dot(minus(after, before), by) / expected;
        // Where the whole contact slips, the host holds the force at its bound, which depends on
        // the damping of the step.
        let slope = if norm(after) >= WHOLE * bound || !share.is_finite() {
            1.0
        } else {
            share
        };
        Spring {
            force_t: before,
            stiffness_t: self.k_0 * slope.clamp(MIN_SLOPE, 1.0),
            unloading_t: self.k_0,
            // The energy exceeds T^2/(2 k_0), because displacements differ within the contact.
            energy_t: 0.5 * self.scale * squares,
            ..Spring::default()
        }
    }

    /// Returns the profile after a step that ended with this force, for which the displacement by
    /// the mean velocity is a first guess.
    fn follow(&self, law: &HertzMindlin, site: &Site, state: &[f64]) -> Profile {
        /// Number of iterations, relative tolerance of the force, and smallest slope between two
        /// iterations over k_0.
        const ROUNDS: usize = 12;
        const CLOSE: f64 = 1e-6;
        const FLATTEST: f64 = 0.1;
        // If the overlap decreases, the force is that at the start of the step: the next step
        // releases the springs that part.
        let (d, bound) = (site.overlap.max(state[OVERLAP]), law.mu * self.force_n);
        let wanted = site.spring_t;
        let size = norm(wanted);
        let mut start = remembered(state, site.spring_before_t);
        let beta = law.mu * self.beta;
        if size >= WHOLE * bound {
            let beta = if bound > 0.0 {
                beta * size / bound
            } else {
                0.0
            };
            let middle = unit(wanted).map(|t| t * beta * site.overlap);
            return Profile::new(&[(0.0, middle)], site.overlap);
        }
        start.slip(d, beta);
        let mut by = [site.h * site.velocity[1], site.h * site.velocity[2]];
        let (mut slope, mut last) = (self.k_0, None::<(Pair, Pair)>);
        let mut best = (f64::INFINITY, start);
        for _ in 0..ROUNDS {
            let mut profile = start;
            profile.shift(by);
            profile.slip(d, beta);
            let force = self.force(&profile);
            let left = minus(wanted, force);
            if norm(left) < best.0 {
                best = (norm(left), profile);
            }
            if norm(left) <= CLOSE * size.max(MIN_SLOPE * bound) {
                break;
            }
            if let Some((by_last, force_last)) = last {
                let (step, change) = (minus(by, by_last), minus(force, force_last));
                let secant = dot(step, change) / dot(step, step);
                if secant.is_finite() {
                    slope = secant.clamp(FLATTEST * self.k_0, self.k_0);
                }
            }
            last = Some((by, force));
            by = [by[0] + left[0] / slope, by[1] + left[1] / slope];
        }
        best.1
    }
}

impl ContactLaw for HertzMindlin {
    fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
        Friction::coulomb(self.mu)
    }

    fn spring(&self, site: &Site, state: &[f64], damping: f64) -> Spring {
        let [modulus, shear] = self.moduli();
        if site.dimension == 2 {
            let k = FRAC_PI_4 * modulus;
            let k_t = k * 0.5 * shear / modulus;
            return Spring {
                stiffness_t: k_t,
                unloading_t: k_t,
                ..Spring::linear(site, k, 0.0, damping)
            };
        }
        let sphere = self.sphere(site);
        let k = 2.0 * modulus * (site.radius * site.overlap).sqrt();
        // The factor sqrt(5/6) of Hertz' spring is 1 for a linear spring.
        let damping_n = 2.0 * damping * (5.0f64 / 6.0).sqrt() * (k * site.effective_mass).sqrt();
        let force_n = (sphere.force_n - damping_n * site.velocity[0]).max(0.0);
        Spring {
            force_n: sphere.force_n,
            stiffness_n: k,
            damping_n,
            ..sphere.tangential(self, site, state, force_n)
        }
    }

    fn damping(&self) -> f64 {
        damping_ratio(self.restitution)
    }

    fn commit(&self, site: &Site, state: &mut [f64]) {
        if site.dimension == 2 || site.overlap <= 0.0 {
            state.fill(0.0);
            return;
        }
        let profile = self.sphere(site).follow(self, site, state);
        remember(&profile, site.overlap, site.spring_t, state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: HertzMindlin = HertzMindlin {
        young_1: 2.1e11,
        poisson_1: 0.3,
        young_2: 2.1e11,
        poisson_2: 0.3,
        restitution: 1.0,
        mu: 0.4,
    };

    fn site(overlap: f64) -> Site {
        Site {
            overlap,
            radius: 0.01,
            effective_mass: 0.1,
            h: 1e-6,
            dimension: 3,
            ..Site::default()
        }
    }

    /// K. L. Johnson, eqs. 4.22 to 4.24, gives a^3 = 3 P R/(4 E*) and d = a^2/R; the stiffness must
    /// be the slope of the force.
    #[test]
    fn force_is_that_of_hertz() {
        let [modulus, _] = STEEL.moduli();
        assert!((modulus - 2.1e11 / (2.0 * 0.91)).abs() < 1e-3 * modulus);
        let s = STEEL.spring(&site(1e-6), &[0.0; 16], 0.0);
        let a = (0.75 * s.force_n * 0.01 / modulus).cbrt();
        assert!((a * a / 0.01 - 1e-6).abs() < 1e-15);
        let more = STEEL.spring(&site(1.0001e-6), &[0.0; 16], 0.0).force_n;
        assert!(((more - s.force_n) / 1e-10 / s.stiffness_n - 1.0).abs() < 1e-4);
    }

    /// Mindlin's ratio of stiffnesses of two equal spheres is 2 (1 - nu)/(2 - nu) (K. L. Johnson,
    /// section 7.2).
    #[test]
    fn tangential_stiffness_is_that_of_mindlin() {
        for dimension in [2, 3] {
            let at = Site {
                dimension,
                ..site(1e-6)
            };
            let s = STEEL.spring(&at, &[0.0; 16], 0.0);
            let ratio = s.stiffness_t / s.stiffness_n;
            assert!((ratio - 1.4 / 1.7).abs() < 1e-12, "{ratio}");
        }
    }

    #[test]
    fn is_finite_everywhere() {
        for overlap in [0.0, 1e-300, 1e-6, 1.0] {
            for velocity in [[0.0; 3], [1.0, -1e10, 1e10], [-1e-300; 3]] {
                for mu in [0.0, 0.4] {
                    let law = HertzMindlin { mu, ..STEEL };
                    let at = Site {
                        velocity,
                        spring_t: [1e3, -1e3],
                        ..site(overlap)
                    };
                    let s = law.spring(&at, &[1e-4; 16], 0.5);
                    assert!(s.force_n.is_finite() && s.stiffness_t.is_finite(), "{s:?}");
                    assert!(s.force_t.iter().all(|t| t.is_finite()), "{s:?}");
                    let mut state = [1e-4; 16];
                    law.commit(&at, &mut state);
                    assert!(state.iter().all(|x| x.is_finite()), "{state:?}");
                }
            }
        }
    }
}
