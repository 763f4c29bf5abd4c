//! Flash temperatures: the temperature rise of the surface of a small, moving contact above that of
//! the body.

use std::f64::consts::PI;

/// Thermal properties of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Thermal conductivity k (W/(m K)).
    pub conductivity: f64,
    /// Heat capacity of volume rho c (J/(m^3 K)).
    pub capacity: f64,
}

impl Conductor {
    /// Returns the effusivity e = sqrt(k rho c) (W s^(1/2)/(m^2 K)).
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.capacity).sqrt()
    }

    /// Returns the diffusivity k/(rho c) (m^2/s).
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / self.capacity
    }

    /// Returns the share of the heat of an interface with another solid that this one takes, e/(e +
    /// e'): both surfaces then have the same temperature as long as the heat has not reached the
    /// end of the bodies (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 1959, 2.15).
    pub fn share(&self, other: &Self) -> f64 {
        let [own, other] = [self.effusivity(), other.effusivity()];
        if own + other > 0.0 {
            own / (own + other)
        } else {
            0.5
        }
    }

    /// Returns the largest rise of temperature (K) below a circle of radius `a` (m) with a uniform
    /// flux `q` (W/m^2) that moves at a speed `v` (m/s) over a half-space: 2 q a/(k sqrt(pi
    /// (1.273 + Pe))) with the Peclet number Pe = v a/(2 kappa) (X. Tian, F. E. Kennedy, J. Tribol.
    /// 116 (1994) 167-174, eq. 27). The limits are q a/k at rest and [`Self::band`] for fast
    /// motion.
    pub fn circle(&self, q: f64, a: f64, v: f64) -> f64 {
        let peclet = v.abs() * a / (2.0 * self.diffusivity());
        2.0 * q * a / (self.conductivity * (PI * (1.273 + peclet)).sqrt())
    }

    /// Returns the largest rise of temperature (K) below a band of half-width `b` (m) with a
    /// uniform flux `q` (W/m^2) that moves fast at a speed `v` (m/s): 2 q sqrt(2 b/v)/(e sqrt(pi))
    /// (J. C. Jaeger, Proc. R. Soc. N.S.W. 76 (1942) 203-224).
    pub fn band(&self, q: f64, b: f64, v: f64) -> f64 {
        2.0 * q * (2.0 * b / (PI * v)).sqrt() / self.effusivity()
    }
}
