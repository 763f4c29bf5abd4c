//! The materials of a case: names of files, and materials that the case itself describes.

use crate::material::Material;
use crate::source::InputError;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};

/// What an entry of `materials` is.
pub(crate) const TEXT_OR_MATERIAL: &str =
    "the name of a material in quotes, or a material `(density: (...), properties: {...})`";

/// Materials by their names in a case. It is a map of the names of files; a material that the case
/// describes is a file of its own name there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseMaterials {
    files: BTreeMap<String, String>,
    own: BTreeMap<String, Material>,
}

impl CaseMaterials {
    /// The materials that the case itself describes, by their names.
    pub fn own(&self) -> impl Iterator<Item = (&String, &Material)> {
        let own = self.own.iter();
        own.filter(|(name, _)| self.files.get(*name) == Some(*name))
    }

    /// Returns the texts of the files that the described materials would be, by their names.
    ///
    /// # Errors
    /// A text cannot be written.
    pub fn own_files(&self) -> Result<BTreeMap<String, String>, InputError> {
        let text = |material| super::text::write("a material", material);
        let files = self.own().map(|(name, of)| Ok((name.clone(), text(of)?)));
        files.collect()
    }
}

impl Deref for CaseMaterials {
    type Target = BTreeMap<String, String>;

    fn deref(&self) -> &Self::Target {
        &self.files
    }
}

impl DerefMut for CaseMaterials {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.files
    }
}

impl Serialize for CaseMaterials {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(untagged)]
        enum Entry<'a> {
            File(&'a str),
            Own(&'a Material),
        }
        serializer.collect_map(self.files.iter().map(|(name, file)| {
            let own = self.own.get(name).filter(|_| file == name);
            (name, own.map_or(Entry::File(file), Entry::Own))
        }))
    }
}

impl<'de> Deserialize<'de> for CaseMaterials {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let entries = BTreeMap::<String, Entry>::deserialize(deserializer)?;
        let mut out = Self::default();
        for (name, entry) in entries {
            match entry {
                Entry::File(file) => out.files.insert(name, file),
                Entry::Own(material) => {
                    out.own.insert(name.clone(), *material);
                    out.files.insert(name.clone(), name)
                }
            };
        }
        Ok(out)
    }
}

enum Entry {
    File(String),
    Own(Box<Material>),
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TextOrMaterial;
        impl<'de> Visitor<'de> for TextOrMaterial {
            type Value = Entry;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(TEXT_OR_MATERIAL)
            }
            fn visit_str<E: serde::de::Error>(self, file: &str) -> Result<Entry, E> {
                Ok(Entry::File(file.to_owned()))
            }
            /// A word without quotes.
            fn visit_unit<E: serde::de::Error>(self) -> Result<Entry, E> {
                Err(E::invalid_type(Unexpected::Unit, &self))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Entry, A::Error> {
                let material = Material::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Entry::Own(Box::new(material)))
            }
        }
        deserializer.deserialize_any(TextOrMaterial)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, load_text};

    const CASE: &str = r#"(
        name: "a", dimension: 2, time: (step: 1e-3, end: 0.1),
        materials: {
            "steel": "R260",
            "mine": (doc: "own", class: Polymer, density: (value: 1.2 g/cm^3, source: "s"),
                properties: {"young": (value: 3, unit: "GPa", source: "s")}),
        },
        interfaces: [],
        grains: [List(material: "mine", grains: [(at: [0.0, 0.0], radius: 0.01)])],
    )"#;

    fn load(text: &str, sets: &[&str]) -> Result<Case, String> {
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        let loaded = load_text("a.ron", text, "".as_ref(), &sets);
        loaded.map(|l| l.case).map_err(|e| e.to_string())
    }

    #[test]
    fn a_case_describes_its_own_material() {
        let case = load(CASE, &[]).unwrap();
        assert_eq!(case.materials["steel"], "R260");
        let (name, own) = case.materials.own().next().unwrap();
        assert_eq!(name, "mine");
        assert_eq!(own.density(), Ok(1200.0));
        assert_eq!(own.property("young"), Some(3e9));
        // Written and read, it is the same.
        let written = case.to_ron().unwrap();
        assert_eq!(load(&written, &[]).unwrap(), case);
    }

    #[test]
    fn it_is_changed_like_other_values() {
        let value = |sets: &[&str]| {
            let case = load(CASE, sets).unwrap();
            let own = case.materials.own().next().map(|own| own.1.clone());
            own.map(|own| own.property("young").unwrap())
        };
        assert_eq!(
            value(&["materials.mine.properties.young.value=4"]),
            Some(4e9)
        );
        assert_eq!(value(&["materials.mine=sand"]), None);
        let added = load(CASE, &["materials.other=sand"]).unwrap();
        assert_eq!(added.materials["other"], "sand");
    }

    #[test]
    fn errors_are_where_they_are_in_the_case() {
        for (from, to, place, words) in [
            ("g/cm^3", "g/cm3x", "a.ron:5:", "unit"),
            ("\"GPa\"", "\"mm\"", "a.ron:6:", "`mm`"),
            (
                "source: \"s\"),\n",
                "sorce: \"s\"),\n",
                "a.ron:5:",
                "did you mean `source`?",
            ),
            ("\"R260\"", "R260", "a.ron:4:", "write `\"R260\"`"),
            ("\"R260\"", "260", "a.ron:4:", "the name of a material"),
        ] {
            let said = load(&CASE.replacen(from, to, 1), &[]).unwrap_err();
            assert!(said.contains(place) && said.contains(words), "{to}: {said}");
        }
    }
}
