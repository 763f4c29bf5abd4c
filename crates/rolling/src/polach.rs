//! Polach's creep curve (O. Polach, Wear 258 (2005) 992-1000): an elliptic patch with a reduced
//! slope below saturation, and friction that falls with the velocity of slip.
//!
//! ```text
//! F = 2 P mu/pi (k_A e/(1 + (k_A e)²) + arctan(k_S e)),   e = pi G a b c11 xi/(4 P mu)
//! mu = mu_0 ((1 - A) exp(-B xi V) + A)
//! ```

use fretwork_elastic::patch::{Kalker, PointPatch, Solid, like_bodies};
use serde::Serialize;
use std::f64::consts::PI;

/// Parameters of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Polach {
    /// Coefficient of friction without slip.
    pub mu_0: f64,
    /// Coefficient at high velocity over that without slip, A.
    pub a: f64,
    /// Decrease with the velocity of slip, B (s/m).
    pub b: f64,
    /// Reduction of the slope in the area of adhesion, k_A.
    pub k_a: f64,
    /// Reduction of it in the area of slip, k_S, at most k_A.
    pub k_s: f64,
}

impl Polach {
    /// A dry rail (table 2 of the paper).
    pub const DRY: Self = Self {
        mu_0: 0.55,
        a: 0.4,
        b: 0.6,
        k_a: 1.0,
        k_s: 0.4,
    };
    /// A wet rail (table 2 of the paper).
    pub const WET: Self = Self {
        mu_0: 0.3,
        a: 0.4,
        b: 0.2,
        k_a: 0.3,
        k_s: 0.1,
    };

    /// Returns the force over the load at a creepage along the rolling; `None` where Kalker's table
    /// does not have the patch. `speed` is that of rolling (m/s).
    pub fn adhesion(
        &self,
        patch: &PointPatch,
        load: f64,
        bodies: &[Solid; 2],
        creepage: f64,
        speed: f64,
    ) -> Option<f64> {
        let like = like_bodies(bodies);
        let c11 = Kalker::new(patch.along / patch.across, like.poisson)?.c11;
        let creepage = creepage.abs();
        let mu = self.mu_0 * ((1.0 - self.a) * (-self.b * creepage * speed).exp() + self.a);
        let gradient = 0.25 * PI * like.shear() * patch.along * patch.across * c11 / load;
        let e = gradient * creepage / mu;
        let adhesion = self.k_a * e / (1.0 + (self.k_a * e).powi(2));
        Some(2.0 * mu / PI * (adhesion + (self.k_s * e).atan()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_elastic::patch::{effective_modulus, point};

    const STEEL: [Solid; 2] = [Solid {
        young: 210e9,
        poisson: 0.3,
    }; 2];

    fn patch(load: f64) -> PointPatch {
        point(load, [2.0, 3.3], effective_modulus(&STEEL))
    }

    /// Without reductions small creepages give Kalker's force, G a b c11 xi, and large ones mu P.
    #[test]
    fn both_ends_of_the_curve() {
        let load = 1e5;
        let plain = Polach {
            b: 0.0,
            k_s: 1.0,
            ..Polach::DRY
        };
        let hertz = patch(load);
        let at = |xi: f64| plain.adhesion(&hertz, load, &STEEL, xi, 20.0).unwrap();
        let c11 = Kalker::new(hertz.along / hertz.across, 0.3).unwrap().c11;
        let slope = 210e9 / 2.6 * hertz.along * hertz.across * c11 / load;
        assert!((at(1e-7) / (slope * 1e-7) - 1.0).abs() < 1e-6);
        assert!((at(0.5) / 0.55 - 1.0).abs() < 0.02, "{}", at(0.5));
    }

    /// The maximum of the paper's dry curve lies below mu_0 at 1 to 3 % of creepage, and falls with
    /// the speed.
    #[test]
    fn friction_falls_with_speed() {
        let load = 1e5;
        let hertz = patch(load);
        let highest = |speed: f64| {
            let at = |k: i32| {
                let xi = 1e-3 * f64::from(k);
                let dry = Polach::DRY.adhesion(&hertz, load, &STEEL, xi, speed);
                (dry.unwrap(), xi)
            };
            let all = (1..200).map(at);
            all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
        };
        let (slow, fast) = (highest(5.0), highest(40.0));
        assert!(fast.0 < slow.0 && slow.0 < 0.55, "{slow:?} {fast:?}");
        assert!((0.005..0.06).contains(&slow.1), "{slow:?}");
    }
}
