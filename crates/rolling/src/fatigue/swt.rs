//! The criterion of Smith, Watson and Topper on the critical plane (K. N. Smith, P. Watson, T. H.
//! Topper, Journal of Materials 5, 1970; D. F. Socie, Journal of Engineering Materials and
//! Technology 109, 1987): the largest normal stress times the amplitude of the normal strain, on
//! the plane on which their product is largest.

use crate::stress::Stress;
use fretwork_elastic::Elasticity;
use serde::{Deserialize, Serialize};

/// The parameter and its plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Swt {
    /// Largest stress times amplitude of strain (Pa).
    pub parameter: f64,
    /// Normal of the plane.
    pub normal: [f64; 3],
}

/// Amplitude of strain over the number of cycles N: (sigma_f/E)(2 N)^b + epsilon_f (2 N)^c.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrainLife {
    /// Strength sigma_f (Pa).
    pub strength: f64,
    /// Exponent b, negative.
    pub strength_exponent: f64,
    /// Ductility epsilon_f; 0 for many cycles, where strains are elastic.
    pub ductility: f64,
    /// Exponent c, negative.
    pub ductility_exponent: f64,
}

/// Angle between directions that are tried first, and the smallest one.
const ANGLES: (f64, f64) = (0.1, 1e-3);

/// Returns the parameter of a cycle of stresses in an elastic body. Directions are searched on a
/// half of the sphere, some six degrees apart, and about the best of them.
pub fn swt(body: &Elasticity, cycle: &[Stress]) -> Swt {
    let of = |normal: [f64; 3]| Swt {
        parameter: parameter(body, cycle, normal),
        normal,
    };
    let mut best = Swt::default();
    let rings = (std::f64::consts::FRAC_PI_2 / ANGLES.0).ceil() as usize;
    for i in 0..=rings {
        let polar = std::f64::consts::FRAC_PI_2 * i as f64 / rings as f64;
        let places = (std::f64::consts::TAU * polar.sin() / ANGLES.0)
            .ceil()
            .max(1.0) as usize;
        for j in 0..places {
            let around = std::f64::consts::TAU * j as f64 / places as f64;
            let here = of([
                polar.sin() * around.cos(),
                polar.sin() * around.sin(),
                polar.cos(),
            ]);
            if here.parameter > best.parameter {
                best = here;
            }
        }
    }
    let mut step = 0.5 * ANGLES.0;
    while best.parameter > 0.0 && step > ANGLES.1 {
        let [along, across] = tangents(best.normal);
        let moved = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(a, b)| {
            let n: [f64; 3] =
                std::array::from_fn(|k| best.normal[k] + step * (a * along[k] + b * across[k]));
            let size = n.iter().map(|n| n * n).sum::<f64>().sqrt();
            of(n.map(|n| n / size))
        });
        let next = moved
            .into_iter()
            .max_by(|a, b| a.parameter.total_cmp(&b.parameter));
        match next {
            Some(next) if next.parameter > best.parameter => best = next,
            _ => step *= 0.5,
        }
    }
    best
}

/// Returns the parameter on a plane (Pa): 0 if it is never in tension.
fn parameter(body: &Elasticity, cycle: &[Stress], [a, b, c]: [f64; 3]) -> f64 {
    let nu = body.poisson;
    let (mut most, mut low, mut high) = (0.0f64, f64::MAX, f64::MIN);
    for [x, y, z, yz, xz, xy] in cycle {
        let normal =
            a * a * x + b * b * y + c * c * z + 2.0 * (b * c * yz + a * c * xz + a * b * xy);
        let strain = (1.0 + nu) * normal - nu * (x + y + z);
        most = most.max(normal);
        (low, high) = (low.min(strain), high.max(strain));
    }
    most * 0.5 * (high - low).max(0.0) / body.young
}

/// Returns two directions perpendicular to a third one and to each other.
fn tangents(n: [f64; 3]) -> [[f64; 3]; 2] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let axis = match n[0].abs() < 0.7 {
        true => [1.0, 0.0, 0.0],
        false => [0.0, 1.0, 0.0],
    };
    let first = cross(n, axis);
    let size = first.iter().map(|f| f * f).sum::<f64>().sqrt();
    let first = first.map(|f| f / size);
    [first, cross(n, first)]
}

impl StrainLife {
    /// Returns the parameter (Pa) at a number of cycles: (sigma_f²/E)(2 N)^(2 b) + sigma_f
    /// epsilon_f (2 N)^(b + c).
    pub fn parameter(&self, young: f64, cycles: f64) -> f64 {
        let (two, b) = (2.0 * cycles, self.strength_exponent);
        let elastic = self.strength * self.strength / young * two.powf(2.0 * b);
        elastic + self.strength * self.ductility * two.powf(b + self.ductility_exponent)
    }

    /// Returns the number of cycles to a crack under a parameter (Pa); infinite above 1e15.
    pub fn cycles(&self, young: f64, parameter: f64) -> f64 {
        let above = |log: f64| self.parameter(young, log.exp()) > parameter;
        let (mut low, mut high) = (0.5f64.ln(), 1e15f64.ln());
        if above(high) || parameter <= 0.0 {
            return f64::INFINITY;
        }
        while high - low > 1e-9 {
            let middle = 0.5 * (low + high);
            match above(middle) {
                true => low = middle,
                false => high = middle,
            }
        }
        (0.5 * (low + high)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Elasticity = Elasticity {
        young: 210e9,
        poisson: 0.3,
        density: 7800.0,
    };

    fn near(got: f64, expected: f64, relative: f64) {
        assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
    }

    /// Under reversed tension the plane lies across it, s²/E; under reversed torsion at 45 degrees,
    /// (1 + nu) t²/E.
    #[test]
    fn the_plane_is_that_of_the_largest_principal_stress() {
        let (s, t) = (300e6, 200e6);
        let tension = swt(
            &STEEL,
            &[[s, 0.0, 0.0, 0.0, 0.0, 0.0], [-s, 0.0, 0.0, 0.0, 0.0, 0.0]],
        );
        near(tension.parameter, s * s / STEEL.young, 1e-5);
        assert!(tension.normal[0].abs() > 0.999);
        let torsion = swt(
            &STEEL,
            &[[0.0, 0.0, 0.0, 0.0, 0.0, t], [0.0, 0.0, 0.0, 0.0, 0.0, -t]],
        );
        near(torsion.parameter, 1.3 * t * t / STEEL.young, 1e-5);
        assert!((torsion.normal[0].abs() - 0.5f64.sqrt()).abs() < 5e-3);
        // A direction that no axis has.
        let n = [0.48, 0.6, 0.64];
        let along = |s: f64| {
            [
                n[0] * n[0] * s,
                n[1] * n[1] * s,
                n[2] * n[2] * s,
                n[1] * n[2] * s,
                n[0] * n[2] * s,
                n[0] * n[1] * s,
            ]
        };
        let found = swt(&STEEL, &[along(s), along(-0.5 * s)]);
        near(found.parameter, 0.75 * s * s / STEEL.young, 1e-5);
        let pressed = swt(&STEEL, &[along(-s), along(-0.5 * s)]);
        assert!(pressed.parameter < 0.05 * found.parameter, "{pressed:?}");
    }

    #[test]
    fn cycles_are_those_of_the_strain_life_curve() {
        let law = StrainLife {
            strength: 1000e6,
            strength_exponent: -0.1,
            ductility: 0.5,
            ductility_exponent: -0.6,
        };
        for cycles in [1e2, 1e4, 1e7] {
            near(
                law.cycles(210e9, law.parameter(210e9, cycles)),
                cycles,
                1e-6,
            );
        }
        let elastic = StrainLife {
            ductility: 0.0,
            ..law
        };
        // s = sigma_f (2 N)^b.
        let s = 1000e6 * 2e6f64.powf(-0.1);
        near(elastic.cycles(210e9, s * s / 210e9), 1e6, 1e-6);
        assert_eq!(law.cycles(210e9, 0.0), f64::INFINITY);
    }
}
