//! Materials and parameters of interface laws: numbers with their units and sources.

mod class;
mod derived;
mod library;
mod plausible;
mod sheet;

pub use class::{Bounds, MaterialClass, any_solid};
pub use derived::{Derived, derived};
pub use library::{Listed, MaterialLibrary, MissingMaterial};
pub use plausible::doubts;
pub use sheet::{Sheet, SheetNumber};

use super::quantity::hardness_in_pascal;
use super::source::ValidationError;
use super::units::{self, UnitError};
use crate::case::slots::{BySlot, Field, FieldName, with_kinds};
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A number and its source.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sourced {
    /// Value.
    pub value: f64,
    /// Unit; that of the schema, in SI units, by default.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Smallest and largest value in the source, in the same unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<(f64, f64)>,
    /// Motion in which it was measured, of a coefficient that is not that of another motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MeasuredMotion>,
    /// Source: paper, standard or table.
    pub source: String,
}

/// Motion of a test of friction or wear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum MeasuredMotion {
    /// To and fro, by less than the width of the contact.
    Fretting,
    /// In one direction, or to and fro by far more than the width of the contact.
    Sliding,
    /// Rolling with slip.
    Rolling,
}

impl MeasuredMotion {
    /// Returns whether it goes to and fro within the contact.
    pub fn is_fretting(self) -> bool {
        self == Self::Fretting
    }

    /// Returns its name within a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fretting => "fretting",
            Self::Sliding => "sliding",
            Self::Rolling => "rolling",
        }
    }
}

impl Sourced {
    /// Converts the value to the unit of the schema.
    ///
    /// # Errors
    /// The unit is unknown or of another dimension.
    pub fn in_unit(&self, wanted: &str) -> Result<f64, UnitError> {
        units::convert(self.value, &self.unit, wanted)
    }

    /// Checks the range of the number `name` at a path.
    ///
    /// # Errors
    /// The range does not contain the value.
    fn range_contains_value(&self, name: &str, path: &str) -> Result<(), ValidationError> {
        let Some((low, high)) = self.range else {
            return Ok(());
        };
        if low <= self.value && self.value <= high {
            return Ok(());
        }
        let message = format!(
            "the range of `{name}`, {low} to {high}, does not contain its value {}",
            self.value
        );
        Err(ValidationError::new(format!("{path}.range"), message)
            .expected("the smallest, then the largest value in the source"))
    }
}

/// A number of a case: a plain number in the unit of the schema, or `(value: 5, unit: "um")`.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberSpec {
    /// Value.
    pub value: f64,
    /// Unit, if given.
    pub unit: Option<String>,
}

impl From<f64> for NumberSpec {
    /// A number in the unit of the schema.
    fn from(value: f64) -> Self {
        Self { value, unit: None }
    }
}

impl Serialize for NumberSpec {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Some(unit) = &self.unit else {
            return serializer.serialize_f64(self.value);
        };
        let mut group = serializer.serialize_struct("Given", 2)?;
        group.serialize_field("value", &self.value)?;
        group.serialize_field("unit", unit)?;
        group.end()
    }
}

impl<'de> Deserialize<'de> for NumberSpec {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct WithUnit {
            value: f64,
            #[serde(default)]
            unit: Option<String>,
            /// Accepted for human readers; not used.
            #[serde(default, rename = "source")]
            _source: Option<String>,
        }
        struct NumberOrGroup;
        impl<'de> Visitor<'de> for NumberOrGroup {
            type Value = NumberSpec;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number, or `(value: number, unit: \"...\")`")
            }
            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<NumberSpec, E> {
                Ok(NumberSpec { value, unit: None })
            }
            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<NumberSpec, E> {
                self.visit_f64(value as f64)
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<NumberSpec, E> {
                self.visit_f64(value as f64)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NumberSpec, A::Error> {
                let found = WithUnit::deserialize(MapAccessDeserializer::new(map))?;
                Ok(NumberSpec {
                    value: found.value,
                    unit: found.unit,
                })
            }
        }
        deserializer.deserialize_any(NumberOrGroup)
    }
}

/// A material.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Description.
    pub doc: String,
    /// Class, which says between which values its properties are plausible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class: Option<MaterialClass>,
    /// Other names, by which cases and commands find it too: `AISI 52100`, `SUJ2`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// Density (kg/m^3).
    pub density: Sourced,
    /// Further properties: laws use those that equal the names of their parameters without `_1` or
    /// `_2`; the others are documentation.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub properties: BTreeMap<String, Sourced>,
    /// Parameters of laws between its grains, and between them and other bodies: an interface uses
    /// them by `parameters_from: "NAME"`, with the name of the material in the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub laws: Option<InterfaceParameters>,
}

/// Properties with a known unit.
const PROPERTIES: [(&str, &str); 11] = [
    ("young", "Pa"),
    ("shear_modulus", "Pa"),
    ("bulk_modulus", "Pa"),
    ("yield_stress", "Pa"),
    ("yield_stress_hardened", "Pa"),
    ("tensile_strength", "Pa"),
    ("poisson", ""),
    ("conductivity", "W/(m K)"),
    ("heat_capacity", "J/(kg K)"),
    ("expansion", "1/K"),
    ("resistivity", "ohm m"),
];

/// Returns whether a name is that of a property with a known unit.
pub fn is_property(name: &str) -> bool {
    unit_of(name).is_some()
}

/// Returns the unit of a property, empty for a pure number; `None` if any unit is accepted.
pub fn unit_of(name: &str) -> Option<&'static str> {
    PROPERTIES.iter().find(|p| p.0 == name).map(|p| p.1)
}

impl Material {
    /// The density (kg/m^3); also checks the units of all properties.
    ///
    /// # Errors
    /// The density is not positive, or a unit is unknown or of another dimension; the error gives
    /// the path.
    pub fn density(&self) -> Result<f64, ValidationError> {
        let density = self
            .density
            .in_unit("kg/m^3")
            .map_err(|e| e.at("density.unit"))?;
        if !(density.is_finite() && density > 0.0) {
            let message = format!("a density must be positive, got {density}");
            return Err(ValidationError::new("density.value", message));
        }
        self.density.range_contains_value("density", "density")?;
        for (name, property) in &self.properties {
            let at = |field: &str| format!("properties.{name}.{field}");
            if !property.value.is_finite() {
                let message = format!("`{name}` must be finite, got {}", property.value);
                return Err(ValidationError::new(at("value"), message));
            }
            property.range_contains_value(name, &format!("properties.{name}"))?;
            let wanted = unit_of(name);
            let pressed = name == "hardness" && units::hardness(&property.unit).is_none();
            match wanted.or(pressed.then_some("Pa")) {
                Some(wanted) => property.in_unit(wanted).map(|_| ()),
                None => units::known(&property.unit),
            }
            .map_err(|e| e.at(at("unit")))?;
        }
        Ok(density)
    }

    /// Returns its class, else that which its description or the `name` of its file tells.
    pub fn class_or_described(&self, name: &str) -> Option<MaterialClass> {
        let described = format!("{name} {}", self.doc);
        let told = || MaterialClass::of_description(&described);
        self.class.or_else(told)
    }

    /// Returns a property in SI units, a hardness as a pressure; `None` if the file does not give
    /// it, or its unit is not one of this property.
    pub fn property(&self, name: &str) -> Option<f64> {
        let given = self.properties.get(name)?;
        match unit_of(name) {
            Some(wanted) => given.in_unit(wanted).ok(),
            None if name == "hardness" => hardness_in_pascal(given.value, &given.unit),
            None => units::in_si(given.value, &given.unit).ok().map(|si| si.0),
        }
    }
}

/// Parameters of laws for a kind of interface: slot, law, parameter. In the text each slot is a
/// field with the keyword of its kind.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
pub struct InterfaceParameters {
    /// Description.
    pub doc: String,
    /// Parameters by slot and law.
    #[schemars(with = "Option<String>")]
    pub slots: BySlot<BTreeMap<String, BTreeMap<String, Sourced>>>,
}

impl<'de> Deserialize<'de> for InterfaceParameters {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ParametersVisitor(&'static [&'static str]);
        impl<'de> Visitor<'de> for ParametersVisitor {
            type Value = InterfaceParameters;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("struct InterfaceParameters")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let (mut doc, mut slots) = (None, BySlot::default());
                while let Some(field) = map.next_key_seed(FieldName(self.0))? {
                    let word = match field {
                        Field::Own(_) if doc.is_none() => {
                            doc = Some(map.next_value()?);
                            continue;
                        }
                        Field::Slot(kind) if slots.get(kind).is_none() => {
                            slots.set(kind, map.next_value()?);
                            continue;
                        }
                        Field::Own(name) => name,
                        Field::Slot(kind) => kind.word(),
                    };
                    return Err(A::Error::duplicate_field(word));
                }
                let doc = doc.unwrap_or_default();
                Ok(InterfaceParameters { doc, slots })
            }
        }
        let fields = with_kinds(&["doc"], 1).map_err(D::Error::custom)?;
        deserializer.deserialize_struct("InterfaceParameters", fields, ParametersVisitor(fields))
    }
}

impl Serialize for InterfaceParameters {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = 1 + self.slots.iter().count();
        let mut fields = serializer.serialize_struct("InterfaceParameters", count)?;
        if !self.doc.is_empty() {
            fields.serialize_field("doc", &self.doc)?;
        }
        for (kind, laws) in self.slots.iter() {
            fields.serialize_field(kind.word(), laws)?;
        }
        fields.end()
    }
}

impl InterfaceParameters {
    /// Checks all units, including those of laws that the case does not use.
    ///
    /// # Errors
    /// Returns the first invalid unit, with its path.
    pub fn units(&self) -> Result<(), ValidationError> {
        for (slot, laws) in self.slots.iter() {
            for (law, parameters) in laws {
                for (name, number) in parameters {
                    let at = |field: &str| format!("{slot}.{law}.{name}.{field}");
                    units::known(&number.unit).map_err(|e| e.at(at("unit")))?;
                    number.range_contains_value(name, &format!("{slot}.{law}.{name}"))?;
                }
            }
        }
        Ok(())
    }
}
