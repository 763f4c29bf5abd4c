//! Elastic spheres in contact: Hertz' normal force, Mindlin and Deresiewicz' tangential force with partial slip. In two
//! dimensions elastic cylinders, whose normal stiffness is nearly constant.
#![forbid(unsafe_code)]
use fretwork_law::{
    ContactLaw, Friction, Law, Site, Spring, Variable, abi, damping_ratio, export, parameters,
};
use std::f64::consts::FRAC_PI_4;

parameters! {
    /// With 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 and 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, contact radius a = sqrt(R d):
    /// F = 4/3 E* sqrt(R) d^(3/2); tangential stiffness k_0 (1 - x)^(1/3), k_0 = 8 G* a, x the share of the contact's friction that the
    /// tangential force takes up since it last turned. In 2D F = pi/4 E* d and k_t/k_n = 4 G*/E*, as for spheres.
    pub struct HertzMindlin {
        young_1: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the first material";
        poisson_1: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the first material";
        young_2: "Pa" = 2.1e11, 1e-300, 1e300, "Young's modulus of the second material";
        poisson_2: "" = 0.3, -0.99, 0.5, "Poisson's ratio of the second material";
        restitution: "" = 1.0, 0.0, 1.0, "share of the approach velocity with which two bodies part";
        mu: "" = 0.3, 0.0, 1e6, "friction coefficient";
    }
}

const fn variable(
    name: &'static core::ffi::CStr,
    unit: &'static core::ffi::CStr,
    doc: &'static core::ffi::CStr,
) -> Variable {
    Variable {
        name,
        unit,
        doc,
        initial: 0.0,
        output: false,
    }
}

impl Law for HertzMindlin {
    const NAME: &'static str = "hertz-mindlin";
    const DOC: &'static str = "elastic spheres (in 2D cylinders): Hertz' force, Mindlin's tangential stiffness with partial slip, Coulomb friction";
    const REFERENCE: &'static str = "R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; K. L. Johnson, Contact Mechanics (1985) 4.2, 7.4";
    const FLAGS: u64 = abi::FLAG_COMPLIANT;
    const VARIABLES: &'static [Variable] = &[
        variable(c"contact_radius", c"m", c"contact radius a"),
        variable(
            c"turn_along",
            c"N",
            c"force where it last turned, along the tangential force",
        ),
        variable(
            c"turn_across",
            c"N",
            c"force where it last turned, across the tangential force",
        ),
        variable(c"turned", c"", c"1 after the tangential force has turned"),
    ];
}

/// Change of the force, over mu F, from which it turns.
const SMALL: f64 = 1e-6;

/// Slope below which a contact is taken to slip as a whole, over k_0.
const LEAST_SLOPE: f64 = 1e-3;

impl HertzMindlin {
    /// E*, 8 G* (Pa).
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

    /// The contact radius (m), and the normal force (N) with its slope (N/m).
    fn normal(&self, site: &Site, modulus: f64) -> (f64, f64, f64) {
        let d = site.overlap;
        if site.dimension == 2 {
            let k = FRAC_PI_4 * modulus;
            return (1.0, k * d, k);
        }
        let a = (site.radius * d).sqrt();
        (a, 4.0 / 3.0 * modulus * a * d, 2.0 * modulus * a)
    }

    /// The tangential force and the force where it last turned, if it did: a contact that has become smaller carries less, a larger one the
    /// same. The turning point is kept by its parts along and across the force, which the host turns with the pair.
    fn history(force: [f64; 2], state: &[f64], a: f64) -> ([f64; 2], Option<[f64; 2]>) {
        let [radius, along, across, turned] = [state[0], state[1], state[2], state[3]];
        let share = if radius > a { a / radius } else { 1.0 };
        let [x, y] = unit(force);
        let turn = [along * x - across * y, along * y + across * x];
        let turn = (turned > 0.0).then(|| turn.map(|t| t * share));
        (force.map(|t| t * share), turn)
    }

    /// The turning point after a change of the force: a change backwards by more than rounding makes one.
    fn turned(
        force: [f64; 2],
        change: [f64; 2],
        turn: Option<[f64; 2]>,
        limit: f64,
    ) -> Option<[f64; 2]> {
        let since = minus(force, turn.unwrap_or_default());
        let (length, size) = (dot(since, since).sqrt(), dot(change, change).sqrt());
        let back = dot(since, change) < 0.0 && size > SMALL * limit && length > 0.0;
        if back { Some(force) } else { turn }
    }
}

/// Direction of a force; the first axis for none.
fn unit(force: [f64; 2]) -> [f64; 2] {
    let length = dot(force, force).sqrt();
    if length > 0.0 {
        force.map(|t| t / length)
    } else {
        [1.0, 0.0]
    }
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Whether a force that turned is past the turning point's opposite, on the curve of the first loading again.
fn is_back(force: [f64; 2], turn: [f64; 2]) -> bool {
    dot(force, turn) < 0.0 && dot(force, force) >= dot(turn, turn)
}

impl ContactLaw for HertzMindlin {
    fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
        Friction {
            mu: self.mu,
            ..Friction::default()
        }
    }

    fn spring(&self, site: &Site, state: &[f64], damping: f64) -> Spring {
        let [modulus, shear] = self.moduli();
        let (a, force_n, k) = self.normal(site, modulus);
        // sqrt(5/6) of Hertz' spring is 1 for a linear one.
        let hertz = if site.dimension == 2 {
            1.0
        } else {
            (5.0f64 / 6.0).sqrt()
        };
        let damping_n = 2.0 * damping * hertz * (k * site.effective_mass).sqrt();
        if site.dimension == 2 {
            let k_t = k * 0.5 * shear / modulus;
            return Spring {
                force_n,
                stiffness_n: k,
                damping_n,
                force_t: site.spring_t,
                stiffness_t: k_t,
                unloading_t: k_t,
                damping_t: 0.0,
            };
        }
        let k_0 = shear * a;
        let (force, turn) = Self::history(site.spring_t, state, a);
        let shift = [site.h * site.velocity[1], site.h * site.velocity[2]];
        let bound = self.mu * force_n;
        let turn = Self::turned(force, shift.map(|x| k_0 * x), turn, bound);
        // The slope to where the force would be after the displacement that is expected.
        let limit = if turn.is_some() { 2.0 } else { 1.0 } * bound;
        let since = minus(force, turn.unwrap_or_default());
        let x = if limit > 0.0 {
            dot(since, since).sqrt() / limit
        } else {
            1.0
        };
        let (from, step) = (x.min(1.0), k_0 * dot(shift, shift).sqrt());
        // 1 - x = (1 - y)^(3/2) over the displacement y in units of 3 limit/(2 k_0).
        let y = 1.0 - (1.0 - from).cbrt().powi(2);
        let share = if limit > 0.0 {
            step / (1.5 * limit)
        } else {
            0.0
        };
        let slope = if share > 1e-6 {
            let to = 1.0 - (1.0 - (y + share).min(1.0)).powf(1.5);
            (to - from) / (1.5 * share)
        } else {
            (1.0 - from).cbrt()
        };
        Spring {
            force_n,
            stiffness_n: k,
            damping_n,
            force_t: force,
            stiffness_t: k_0 * slope.clamp(LEAST_SLOPE, 1.0),
            unloading_t: k_0,
            damping_t: 0.0,
        }
    }

    fn damping(&self) -> f64 {
        damping_ratio(self.restitution)
    }

    fn commit(&self, site: &Site, state: &[f64], next: &mut [f64]) {
        if site.dimension == 2 {
            return;
        }
        let [modulus, _] = self.moduli();
        let (a, force_n, _) = self.normal(site, modulus);
        if a == 0.0 {
            next.fill(0.0);
            return;
        }
        // The force at the start of the step is the one that `spring` returned, which is scaled already.
        let (before, force) = (site.spring_before_t, site.spring_t);
        let (_, turn) = Self::history(before, state, a);
        let change = minus(force, before);
        let mut turn = Self::turned(before, change, turn, self.mu * force_n);
        if turn.is_some_and(|t| is_back(force, t)) {
            turn = None;
        }
        let ([x, y], [p, q]) = (unit(force), turn.unwrap_or_default());
        let turned = if turn.is_some() { 1.0 } else { 0.0 };
        next.copy_from_slice(&[a, p * x + q * y, q * x - p * y, turned]);
    }
}

export!(contact HertzMindlin);

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

    /// K. L. Johnson, eqs. 4.22 to 4.24: a^3 = 3 P R/(4 E*), d = a^2/R; the slope is that of the force.
    #[test]
    fn force_is_that_of_hertz() {
        let [modulus, _] = STEEL.moduli();
        assert!((modulus - 2.1e11 / (2.0 * 0.91)).abs() < 1e-3 * modulus);
        let s = STEEL.spring(&site(1e-6), &[0.0; 4], 0.0);
        let a = (0.75 * s.force_n * 0.01 / modulus).cbrt();
        assert!((a * a / 0.01 - 1e-6).abs() < 1e-15);
        let more = STEEL.spring(&site(1.0001e-6), &[0.0; 4], 0.0).force_n;
        assert!(((more - s.force_n) / 1e-10 / s.stiffness_n - 1.0).abs() < 1e-4);
    }

    /// Mindlin's ratio of stiffnesses of two like spheres, 2 (1 - nu)/(2 - nu) (K. L. Johnson, section 7.2).
    #[test]
    fn tangential_stiffness_is_that_of_mindlin() {
        for dimension in [2, 3] {
            let s = STEEL.spring(
                &Site {
                    dimension,
                    ..site(1e-6)
                },
                &[0.0; 4],
                0.0,
            );
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
                    let s = law.spring(&at, &[1e-4, 1.0, 0.5, 1.0], 0.5);
                    assert!(s.force_n.is_finite() && s.stiffness_t.is_finite(), "{s:?}");
                    assert!(s.force_t.iter().all(|t| t.is_finite()), "{s:?}");
                    let mut next = [0.0; 4];
                    law.commit(&at, &[1e-4, 1.0, 0.5, 1.0], &mut next);
                    assert!(next.iter().all(|x| x.is_finite()), "{next:?}");
                }
            }
        }
    }
}
