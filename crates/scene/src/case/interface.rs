//! The law between two materials.

use super::slots::{BySlot, Field, FieldName, with_kinds};
use crate::material::NumberSpec;
use fretwork_core::laws::{BondOpening, BondRule, Kind};
use schemars::JsonSchema;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::{Error as _, SerializeStruct};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Values by slot and parameter: numbers in the unit of the law, or `(value: 5, unit: "um")`.
pub type SlotValues = BySlot<BTreeMap<String, NumberSpec>>;

/// The law between two materials: a slot for each kind of law, each with the name of a plugin. In
/// the text each slot is a field with the keyword of its kind: `contact: "coulomb", wear:
/// "archard"`.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
pub struct InterfaceSpec {
    /// Name.
    pub name: String,
    /// The two materials, by their names in this case.
    pub between: (String, String),
    /// File in `materials/` with parameters of laws.
    pub parameters_from: Option<String>,
    /// Laws by slot; the slot [`Kind::CONTACT`] must have one.
    #[schemars(with = "Option<String>")]
    pub laws: BySlot<String>,
    /// Parameters given here, which take precedence over those of the file.
    #[schemars(with = "Option<String>")]
    pub parameters: SlotValues,
    /// Tables of the laws that read one: files relative to that of the case.
    #[schemars(with = "Option<String>")]
    pub tables: BySlot<String>,
    /// When bonds are made.
    #[schemars(default)]
    pub bonds: BondRule,
    /// Largest gap at which a bond forms (m), at most the alert distance, which is the default.
    pub bonds_within: Option<f64>,
    /// Opening at which bonds begin.
    #[schemars(default)]
    pub bond_opening: BondOpening,
    /// Time under compression (s) after which a contact forms a bond, including after an earlier
    /// bond broke.
    pub healing: Option<f64>,
    /// Factor of the contact's area, see `AreaRule`.
    #[schemars(default = "one")]
    pub area_factor: f64,
}

fn one() -> f64 {
    1.0
}

/// Names of the fields other than slots; the slots come after the first three.
const OWN: [&str; 10] = [
    "name",
    "between",
    "parameters_from",
    "parameters",
    "tables",
    "bonds",
    "bonds_within",
    "bond_opening",
    "healing",
    "area_factor",
];

impl InterfaceSpec {
    /// The law in a slot.
    pub fn law(&self, kind: Kind) -> Option<&str> {
        self.laws.get(kind).map(String::as_str)
    }

    /// Returns a parameter that the case gives for a slot.
    pub fn parameter(&self, kind: Kind, name: &str) -> Option<&NumberSpec> {
        self.parameters.get(kind)?.get(name)
    }
}

impl<'de> Deserialize<'de> for InterfaceSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = with_kinds(&OWN, 3).map_err(D::Error::custom)?;
        deserializer.deserialize_struct("InterfaceSpec", fields, SpecVisitor(fields))
    }
}

struct SpecVisitor(&'static [&'static str]);

/// Reads the next value for a field that must not have one yet.
fn once<'de, A: MapAccess<'de>, T: Deserialize<'de>>(
    map: &mut A,
    field: &mut Option<T>,
    name: &'static str,
) -> Result<(), A::Error> {
    if field.is_some() {
        return Err(A::Error::duplicate_field(name));
    }
    *field = Some(map.next_value()?);
    Ok(())
}

impl<'de> Visitor<'de> for SpecVisitor {
    type Value = InterfaceSpec;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("struct InterfaceSpec")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<InterfaceSpec, A::Error> {
        let (mut name, mut between, mut file) = (None, None, None);
        let (mut parameters, mut bonds, mut healing, mut factor) = (None, None, None, None);
        let (mut within, mut opening, mut tables) = (None, None, None);
        let (mut laws, mut seen) = (BySlot::default(), BTreeSet::new());
        while let Some(field) = map.next_key_seed(FieldName(self.0))? {
            match field {
                Field::Slot(kind) => {
                    if !seen.insert(kind) {
                        return Err(A::Error::duplicate_field(kind.word()));
                    }
                    // Every interface has a contact law.
                    let law = match kind == Kind::CONTACT {
                        true => Some(map.next_value()?),
                        false => map.next_value::<Option<String>>()?,
                    };
                    law.into_iter().for_each(|law| laws.set(kind, law));
                }
                Field::Own(own) => match own {
                    "name" => once(&mut map, &mut name, own)?,
                    "between" => once(&mut map, &mut between, own)?,
                    "parameters_from" => once(&mut map, &mut file, own)?,
                    "parameters" => once(&mut map, &mut parameters, own)?,
                    "tables" => once(&mut map, &mut tables, own)?,
                    "bonds" => once(&mut map, &mut bonds, own)?,
                    "bonds_within" => once(&mut map, &mut within, own)?,
                    "bond_opening" => once(&mut map, &mut opening, own)?,
                    "healing" => once(&mut map, &mut healing, own)?,
                    _ => once(&mut map, &mut factor, own)?,
                },
            }
        }
        let missing = A::Error::missing_field;
        let spec = InterfaceSpec {
            name: name.ok_or_else(|| missing("name"))?,
            between: between.ok_or_else(|| missing("between"))?,
            parameters_from: file.flatten(),
            laws,
            parameters: parameters.unwrap_or_default(),
            tables: tables.unwrap_or_default(),
            bonds: bonds.unwrap_or_default(),
            bonds_within: within.flatten(),
            bond_opening: opening.unwrap_or_default(),
            healing: healing.flatten(),
            area_factor: factor.unwrap_or_else(one),
        };
        match spec.law(Kind::CONTACT) {
            Some(_) => Ok(spec),
            None => Err(missing(Kind::CONTACT.word())),
        }
    }
}

impl Serialize for InterfaceSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        with_kinds(&OWN, 3).map_err(S::Error::custom)?;
        let count = OWN.len() + self.laws.iter().count();
        let mut fields = serializer.serialize_struct("InterfaceSpec", count)?;
        fields.serialize_field("name", &self.name)?;
        fields.serialize_field("between", &self.between)?;
        if self.parameters_from.is_some() {
            fields.serialize_field("parameters_from", &self.parameters_from)?;
        }
        for (kind, law) in self.laws.iter() {
            match kind == Kind::CONTACT {
                true => fields.serialize_field(kind.word(), law)?,
                false => fields.serialize_field(kind.word(), &Some(law))?,
            }
        }
        if self.parameters != SlotValues::default() {
            fields.serialize_field("parameters", &self.parameters)?;
        }
        if self.tables != BySlot::default() {
            fields.serialize_field("tables", &self.tables)?;
        }
        fields.serialize_field("bonds", &self.bonds)?;
        if self.bonds_within.is_some() {
            fields.serialize_field("bonds_within", &self.bonds_within)?;
        }
        if self.bond_opening != BondOpening::default() {
            fields.serialize_field("bond_opening", &self.bond_opening)?;
        }
        if self.healing.is_some() {
            fields.serialize_field("healing", &self.healing)?;
        }
        fields.serialize_field("area_factor", &self.area_factor)?;
        fields.end()
    }
}
