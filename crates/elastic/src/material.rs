//! Isotropic linear elasticity.

use serde::{Deserialize, Serialize};

/// A homogeneous isotropic linear elastic material. In two dimensions the strain is plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Elasticity {
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Poisson's ratio nu, above -1 and below 1/2.
    pub poisson: f64,
    /// Density (kg/m^3).
    pub density: f64,
}

/// Why numbers are not those of an elastic material.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ElasticityError {
    /// Young's modulus is not positive.
    #[error("Young's modulus must be positive and finite, got {0} Pa")]
    Young(f64),
    /// Poisson's ratio is out of range.
    #[error(
        "Poisson's ratio must be above -1 and below 0.5, got {0}; of an incompressible material give 0.499, for example"
    )]
    Poisson(f64),
    /// The density is not positive.
    #[error("the density must be positive and finite, got {0} kg/m^3")]
    Density(f64),
}

impl Elasticity {
    /// Checks the numbers.
    ///
    /// # Errors
    /// The first that is out of range.
    pub fn check(&self) -> Result<(), ElasticityError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !positive(self.young) {
            return Err(ElasticityError::Young(self.young));
        }
        if !(self.poisson > -1.0 && self.poisson < 0.5) {
            return Err(ElasticityError::Poisson(self.poisson));
        }
        if !positive(self.density) {
            return Err(ElasticityError::Density(self.density));
        }
        Ok(())
    }

    /// First Lamé constant, E nu/((1 + nu)(1 - 2 nu)) (Pa).
    pub fn lambda(&self) -> f64 {
        let nu = self.poisson;
        self.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Shear modulus G = E/(2 (1 + nu)) (Pa).
    pub fn shear(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    /// E/(1 - nu^2) (Pa): two bodies in contact have 1/E* as the sum of the inverses of theirs.
    pub fn plane_strain(&self) -> f64 {
        self.young / (1.0 - self.poisson * self.poisson)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_belong_together() {
        let steel = Elasticity {
            young: 210e9,
            poisson: 0.3,
            density: 7800.0,
        };
        steel.check().unwrap();
        // E = G (3 lambda + 2 G)/(lambda + G)
        let (l, g) = (steel.lambda(), steel.shear());
        assert!((g * (3.0 * l + 2.0 * g) / (l + g) / steel.young - 1.0).abs() < 1e-14);
        let wrong = |change: fn(&mut Elasticity)| {
            let mut material = steel;
            change(&mut material);
            material.check().unwrap_err().to_string()
        };
        assert!(wrong(|m| m.young = 0.0).contains("Young"));
        assert!(wrong(|m| m.poisson = 0.5).contains("0.499"));
        assert!(wrong(|m| m.density = f64::NAN).contains("density"));
    }
}
