//! Quantities that follow from the properties of a material.

use super::{Material, unit_of};
use crate::units;
use serde::Serialize;

/// A quantity that follows from properties.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Derived {
    /// Name.
    pub name: &'static str,
    /// Value in its unit.
    pub value: f64,
    /// Unit in SI.
    pub unit: &'static str,
    /// How it follows, with E, nu, rho, k and c for the properties.
    pub formula: &'static str,
}

/// Returns the quantities for which a material has the properties: plane strain modulus, shear
/// modulus and hardness as a pressure where the file gives none, and the diffusivity and the
/// effusivity of heat (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 1959, 1.6, 2.9).
pub fn derived(material: &Material) -> Vec<Derived> {
    let mut out = Vec::new();
    let mut add = |name, value: f64, unit, formula| {
        if value.is_finite() {
            out.push(Derived {
                name,
                value,
                unit,
                formula,
            });
        }
    };
    let elastic = (material.property("young"), material.property("poisson"));
    if let (Some(young), Some(poisson)) = elastic {
        let plane_strain = young / (1.0 - poisson * poisson);
        add("plane_strain_modulus", plane_strain, "Pa", "E/(1 - nu^2)");
        if !material.properties.contains_key("shear_modulus") {
            let shear = 0.5 * young / (1.0 + poisson);
            add("shear_modulus", shear, "Pa", "E/(2 (1 + nu))");
        }
    }
    let hardness = material.properties.get("hardness");
    if let (Some(given), Some(pascal)) = (hardness, material.property("hardness"))
        && units::hardness(&given.unit).is_some()
    {
        add("hardness_pressure", pascal, "Pa", "H in kgf/mm^2");
    }
    let heat = (
        material.property("conductivity"),
        material.density.in_unit("kg/m^3").ok(),
        material.property("heat_capacity"),
    );
    if let (Some(k), Some(rho), Some(c)) = heat {
        add("thermal_diffusivity", k / (rho * c), "m^2/s", "k/(rho c)");
        let effusivity = (k * rho * c).sqrt();
        add(
            "thermal_effusivity",
            effusivity,
            "J/(m^2 K s^0.5)",
            "sqrt(k rho c)",
        );
    }
    out
}

impl Material {
    /// Returns the unit in which [`Material::property`] gives a property.
    pub fn unit_in_si(&self, name: &str) -> Option<String> {
        match unit_of(name) {
            Some(unit) => Some(unit.to_owned()),
            None if name == "hardness" => Some("Pa".to_owned()),
            None => {
                let given = self.properties.get(name)?;
                units::in_si(given.value, &given.unit).ok().map(|si| si.1)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MaterialLibrary;

    fn of(name: &str) -> impl Fn(&str) -> f64 {
        let source = MaterialLibrary::shipped().read(name).unwrap();
        let all = derived(&source.parse().unwrap());
        move |wanted| all.iter().find(|d| d.name == wanted).unwrap().value
    }

    /// M. Ertz, K. Knothe, Wear 253 (2002) 498-508: effusivity 13,290 W s^(1/2)/(m^2 K) of steel
    /// with 50 W/(m K), of which the diffusivity is (k/e)^2.
    #[test]
    fn heat_of_steel_is_as_published() {
        let steel = of("verification_steel");
        let published: f64 = 13_290.0;
        assert!((steel("thermal_effusivity") - published).abs() < 2.0);
        let diffusivity = (50.0 / published).powi(2);
        assert!((steel("thermal_diffusivity") / diffusivity - 1.0).abs() < 3e-4);
    }

    /// The shear modulus of the steel of CONTACT is 82 GPa, from which its file has E; that of
    /// titanium is measured, and is that of E and nu within the scatter of the sheets.
    #[test]
    fn moduli_belong_together() {
        assert!((of("contact_steel")("shear_modulus") / 82e9 - 1.0).abs() < 1e-12);
        let source = MaterialLibrary::shipped().read("titanium_ti6al4v").unwrap();
        let titanium: Material = source.parse().unwrap();
        assert!(!derived(&titanium).iter().any(|d| d.name == "shear_modulus"));
        let value = |name| titanium.property(name).unwrap();
        let from_young = 0.5 * value("young") / (1.0 + value("poisson"));
        assert!((value("shear_modulus") / from_young - 1.0).abs() < 0.04);
    }

    #[test]
    fn hardness_on_a_scale_is_a_pressure() {
        let rail = of("rail_steel_r260")("hardness_pressure");
        assert!((rail - 260.0 * 9.80665e6).abs() < 1.0);
    }
}
