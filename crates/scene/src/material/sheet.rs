//! The data sheet of a material: every number in SI units, as commands and Python show it.

use super::library::BUILT_IN;
use super::{Derived, Listed, Material, MaterialLibrary, Sourced, derived};
use crate::source::InputError;
use crate::units;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A number of a material in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SheetNumber {
    /// Value; that of the file for a hardness on a scale that is no pressure.
    pub value: f64,
    /// Unit, empty for a pure number.
    pub unit: String,
    /// Smallest and largest value in the source; null without any.
    pub range: Option<[f64; 2]>,
    /// Value and unit as the file gives them.
    pub given: String,
    /// Source.
    pub source: String,
}

/// A material with all its numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sheet {
    /// Name of its file, without `.ron`.
    pub name: String,
    /// Description.
    pub doc: String,
    /// Class; null if the file gives none.
    pub class: Option<String>,
    /// Other names.
    pub also: Vec<String>,
    /// The file; null if it is built in.
    pub file: Option<String>,
    /// Density.
    pub density: SheetNumber,
    /// Properties by their names.
    pub properties: BTreeMap<String, SheetNumber>,
    /// What follows from them.
    pub derived: Vec<Derived>,
    /// Laws for which it has parameters, as `kind.law`.
    pub laws: Vec<String>,
}

impl Sheet {
    /// Returns the sheet of a material.
    pub fn of(name: &str, file: Option<String>, material: &Material) -> Self {
        let number = |name: &str, given: &Sourced| {
            let unit = match name {
                "density" => Some("kg/m^3".to_owned()),
                name => material.unit_in_si(name),
            };
            in_unit(given, unit)
        };
        let slots = material.laws.iter().flat_map(|laws| laws.slots.iter());
        let laws = slots.flat_map(|(kind, laws)| {
            let word = kind.word();
            laws.keys().map(move |law| format!("{word}.{law}"))
        });
        let properties = material.properties.iter();
        Self {
            name: name.to_owned(),
            doc: material.doc.clone(),
            class: material.class.map(|class| class.name().to_owned()),
            also: material.also.clone(),
            file,
            density: number("density", &material.density),
            properties: properties
                .map(|(name, given)| (name.clone(), number(name, given)))
                .collect(),
            derived: derived(material),
            laws: laws.collect(),
        }
    }

    /// Returns the sheet of a material by its name or another one, or of a file, `NAME.ron`.
    ///
    /// # Errors
    /// There is none of this name, or it cannot be read; units and ranges are checked.
    pub fn find(library: &MaterialLibrary, name: &str) -> Result<Self, InputError> {
        let source = match name.ends_with(".ron") {
            true => MaterialLibrary::read_file(Path::new(name))?,
            false => library.read(name).map_err(|e| {
                e.map_or_else(
                    |error| error,
                    |missing| {
                        let message = format!("there is no such material in {}", missing.searched);
                        InputError::argument(name, message)
                            .expected(format!("one of {}", missing.available))
                            .did_you_mean(missing.nearest.as_deref())
                    },
                )
            })?,
        };
        let material: Material = source.parse()?;
        material.density().map_err(|fault| source.locate(fault))?;
        let file = source.path().display().to_string();
        let built_in = file.ends_with(BUILT_IN);
        let name = source.path().file_name().unwrap_or_default();
        let name = name.to_string_lossy();
        let name = name.split(".ron").next().unwrap_or_default();
        Ok(Self::of(name, (!built_in).then_some(file), &material))
    }

    /// Returns the sheet of a material of a list.
    ///
    /// # Errors
    /// Its file cannot be read.
    pub fn listed(listed: &Listed) -> Result<Self, InputError> {
        let file = listed.path.as_ref().map(|p| p.display().to_string());
        let material = listed.material.clone()?;
        Ok(Self::of(&listed.name, file, &material))
    }

    /// Returns the value of a property in SI units, or of what is derived.
    pub fn value(&self, name: &str) -> Option<f64> {
        if name == "density" {
            return Some(self.density.value);
        }
        let given = self.properties.get(name).map(|number| number.value);
        let derived = self.derived.iter().find(|d| d.name == name);
        given.or_else(|| derived.map(|d| d.value))
    }
}

/// Converts a number to a unit, where its own can be converted to it.
fn in_unit(given: &Sourced, unit: Option<String>) -> SheetNumber {
    let convert = |x: f64, unit: &str| match unit {
        "Pa" => crate::quantity::hardness_in_pascal(x, &given.unit),
        unit => units::convert(x, &given.unit, unit).ok(),
    };
    let found = unit.and_then(|unit| Some((convert(given.value, &unit)?, unit)));
    let (value, unit) = found.unwrap_or_else(|| (given.value, given.unit.clone()));
    let range = given.range.map(|(low, high)| {
        let end = |x: f64| convert(x, &unit).unwrap_or(x);
        [end(low), end(high)]
    });
    let text = format!("{} {}", given.value, given.unit);
    SheetNumber {
        value,
        unit,
        range,
        given: text.trim_end().to_owned(),
        source: given.source.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MaterialLibrary;
    use crate::source::Source;

    #[test]
    fn numbers_are_in_si_units() {
        let source = MaterialLibrary::shipped().read("Ti-6Al-4V").unwrap();
        let sheet = Sheet::of("titanium_ti6al4v", None, &source.parse().unwrap());
        let young = &sheet.properties["young"];
        assert_eq!((young.value, young.unit.as_str()), (114e9, "Pa"));
        assert_eq!(young.range, Some([105e9, 120e9]));
        assert_eq!(young.given, "114 GPa");
        let hardness = &sheet.properties["hardness"];
        assert!((hardness.value - 349.0 * 9.80665e6).abs() < 1.0);
        assert_eq!(hardness.unit, "Pa");
        assert_eq!(sheet.value("density"), Some(4430.0));
        assert!((sheet.value("plane_strain_modulus").unwrap() / 127.9e9 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_scale_that_is_no_pressure_is_kept() {
        let text = r#"(doc: "d", density: (value: 7.8, unit: "g/cm^3", source: "s"),
            properties: {"hardness": (value: 62.0, unit: "HRC", range: (60.0, 64.0), source: "s")})"#;
        let material: Material = Source::from_text("own.ron", text).parse().unwrap();
        let sheet = Sheet::of("own", None, &material);
        let hardness = &sheet.properties["hardness"];
        assert_eq!((hardness.value, hardness.unit.as_str()), (62.0, "HRC"));
        assert_eq!(hardness.range, Some([60.0, 64.0]));
        assert_eq!(sheet.density.value, 7800.0);
    }
}
