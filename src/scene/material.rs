//! Materials and the parameters of interface laws: numbers with their source.

use super::shipped_materials;
use super::source::{InputError, Source, nearest};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A number and where it comes from.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sourced {
    /// Value, SI.
    pub value: f64,
    /// Unit, for the reader.
    #[serde(default)]
    pub unit: String,
    /// Paper, norm or table.
    pub source: String,
}

/// A material.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// What it is.
    pub doc: String,
    /// Density (kg/m^3).
    pub density: Sourced,
    /// Further properties, for the record.
    #[serde(default)]
    pub properties: BTreeMap<String, Sourced>,
}

/// Parameters of laws for a kind of interface: slot, law, parameter.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InterfaceParameters {
    /// What it describes.
    pub doc: String,
    /// Contact laws.
    pub contact: BTreeMap<String, BTreeMap<String, Sourced>>,
    /// Cohesion laws.
    pub cohesion: BTreeMap<String, BTreeMap<String, Sourced>>,
    /// Damage laws.
    pub damage: BTreeMap<String, BTreeMap<String, Sourced>>,
    /// Wear laws.
    pub wear: BTreeMap<String, BTreeMap<String, Sourced>>,
}

/// The folders in which material files are looked for: `materials/` beside the case or in a folder
/// above it, then in the working folder; a shipped one that none of them has is taken from the program.
#[derive(Clone, Debug)]
pub struct Shelf {
    folders: Vec<PathBuf>,
}

impl Shelf {
    /// For a case file.
    pub fn beside(case: &Path) -> Self {
        let absolute = std::path::absolute(case).unwrap_or_else(|_| case.to_owned());
        let mut folders: Vec<PathBuf> = absolute
            .ancestors()
            .skip(1)
            .map(|a| a.join("materials"))
            .collect();
        folders.push(PathBuf::from("materials"));
        folders.retain(|f| f.is_dir());
        Self { folders }
    }

    /// Reads `NAME.ron`.
    ///
    /// # Errors
    /// No such file (`Err(Ok(nearest, available))` as a pair of texts) or one that cannot be read.
    pub fn read(&self, name: &str) -> Result<Source, Result<Missing, InputError>> {
        let plain = !name.is_empty()
            && name
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
        let found = plain.then(|| {
            self.folders
                .iter()
                .map(|f| f.join(format!("{name}.ron")))
                .find(|p| p.is_file())
        });
        match found.flatten() {
            Some(path) => Source::read(&path).map_err(Err),
            None => match shipped_materials::text(name) {
                Some(text) => Ok(Source::from_text(
                    format!("materials/{name}.ron (built in)"),
                    text,
                )),
                None => Err(Ok(self.missing(name))),
            },
        }
    }

    fn missing(&self, name: &str) -> Missing {
        let mut names: Vec<String> = self
            .folders
            .iter()
            .filter_map(|f| std::fs::read_dir(f).ok())
            .flat_map(|entries| entries.flatten())
            .filter_map(|e| {
                e.file_name()
                    .to_str()
                    .and_then(|n| n.strip_suffix(".ron"))
                    .map(str::to_owned)
            })
            .collect();
        names.sort();
        names.dedup();
        for (shipped, _) in shipped_materials::FILES {
            if !names.iter().any(|n| n == shipped) {
                names.push(shipped.to_owned());
            }
        }
        let folders = self.folders.iter().map(|f| f.display().to_string());
        let built_in = std::iter::once("the program itself".to_owned());
        Missing {
            nearest: nearest(name, names.iter().map(String::as_str)).map(str::to_owned),
            available: names.join(", "),
            looked: folders.chain(built_in).collect::<Vec<_>>().join(", "),
        }
    }
}

/// A name that no file has.
#[derive(Clone, Debug)]
pub struct Missing {
    /// The nearest name.
    pub nearest: Option<String>,
    /// All names.
    pub available: String,
    /// Where it was looked for.
    pub looked: String,
}
