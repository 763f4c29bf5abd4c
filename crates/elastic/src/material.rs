//! Isotropic linear elasticity.

use serde::{Deserialize, Serialize};

/// Components of a strain or stress: xx, yy, zz, yz, xz, xy; shear strains are those of the tensor,
/// half of the engineering ones.
pub type Symmetric = [f64; 6];

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

/// Reason why numbers are not those of an elastic material.
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
    /// Returns the first number that is out of range.
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

    /// Returns the first Lamé constant, E nu/((1 + nu)(1 - 2 nu)) (Pa).
    pub fn lambda(&self) -> f64 {
        let nu = self.poisson;
        self.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Returns the shear modulus G = E/(2 (1 + nu)) (Pa).
    pub fn shear(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    /// Returns three times the bulk modulus, 3 lambda + 2 G (Pa): the pressure of a constrained
    /// free strain, divided by that strain.
    pub fn thermal_modulus(&self) -> f64 {
        3.0 * self.lambda() + 2.0 * self.shear()
    }

    /// Returns the stress of a strain (Pa), lambda tr(epsilon) 1 + 2 G epsilon.
    pub fn stress(&self, strain: &Symmetric) -> Symmetric {
        let pressure = self.lambda() * (strain[0] + strain[1] + strain[2]);
        let mut stress = strain.map(|e| 2.0 * self.shear() * e);
        stress[..3].iter_mut().for_each(|s| *s += pressure);
        stress
    }

    /// Returns the energy of a strain per volume (Pa), sigma : epsilon/2.
    pub fn energy(&self, strain: &Symmetric) -> f64 {
        let stress = self.stress(strain);
        let mut each = stress.iter().zip(strain).map(|(s, e)| s * e);
        let normal: f64 = each.by_ref().take(3).sum();
        0.5 * normal + each.sum::<f64>()
    }

    /// Returns a strain less a free strain along each axis.
    pub fn less(strain: &Symmetric, free: f64) -> Symmetric {
        let mut out = *strain;
        out[..3].iter_mut().for_each(|e| *e -= free);
        out
    }

    /// Returns E/(1 - nu^2) (Pa): two bodies in contact have 1/E* as the sum of the inverses of
    /// their moduli.
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
