//! Thermal and electrical properties of a material.

use fretwork_math::diffusion::Conductor;

/// Thermal and electrical properties of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermalMaterial {
    /// Thermal conductivity k (W/(m K)).
    pub conductivity: f64,
    /// Heat capacity c (J/(kg K)).
    pub heat_capacity: f64,
    /// Density rho without inertia scaling (kg/m^3).
    pub density: f64,
    /// Electrical resistivity (ohm m); `None` if not given.
    pub resistivity: Option<f64>,
}

impl ThermalMaterial {
    /// Returns the material as a conductor of heat.
    pub fn conductor(&self) -> Conductor {
        Conductor {
            conductivity: self.conductivity,
            capacity: self.density * self.heat_capacity,
        }
    }

    /// Returns the thermal conductivity of a pair, 2 k1 k2/(k1 + k2) (W/(m K)): that of two equal
    /// halves in series.
    pub fn pair_conductivity(&self, other: &Self) -> f64 {
        let [a, b] = [self.conductivity, other.conductivity];
        if a + b > 0.0 {
            2.0 * a * b / (a + b)
        } else {
            0.0
        }
    }

    /// Returns the electrical resistivity of a pair, (rho1 + rho2)/2 (ohm m); 0 where one of them
    /// is not given.
    pub fn pair_resistivity(&self, other: &Self) -> f64 {
        match (self.resistivity, other.resistivity) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            _ => 0.0,
        }
    }
}
