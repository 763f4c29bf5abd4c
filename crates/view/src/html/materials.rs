//! Materials of a run and parameters of laws from files, each number with its source.

use crate::html::folder::RunFolder;
use fretwork_scene::Case;
use fretwork_scene::case::InterfaceSpec;
use fretwork_scene::material::{InterfaceParameters, Material, Sourced};
use fretwork_scene::source::Source;
use std::collections::BTreeMap;

/// The files that a run recorded, by name.
#[derive(Debug, Default)]
pub(crate) struct Files {
    /// Materials.
    pub materials: BTreeMap<String, Material>,
    /// Parameters of laws.
    pub laws: BTreeMap<String, LawFile>,
}

/// A file of parameters.
#[derive(Debug)]
pub(crate) struct LawFile(InterfaceParameters);

impl LawFile {
    /// Returns the numbers that the file gives for a law.
    pub fn of(&self, kind: &str, law: &str) -> Vec<(String, Sourced)> {
        let slots = self.0.slots.iter().filter(|(k, _)| k.word() == kind);
        let numbers = slots.filter_map(|(_, laws)| laws.get(law)).flatten();
        numbers
            .map(|(name, number)| (name.clone(), number.clone()))
            .collect()
    }
}

impl Files {
    /// Reads the texts in `results.h5`; texts that are neither materials nor parameters are
    /// omitted.
    pub fn read(run: &RunFolder) -> Self {
        let mut out = Self::default();
        for name in run.reader.datasets_in("materials") {
            let Some(text) = run
                .reader
                .texts(&format!("materials/{name}"))
                .into_iter()
                .next()
            else {
                continue;
            };
            let source = Source::from_text(name, text);
            if let Ok(mut material) = source.parse::<Material>() {
                if let Some(laws) = material.laws.take() {
                    out.laws.insert(name.to_owned(), LawFile(laws));
                }
                out.materials.insert(name.to_owned(), material);
            } else if let Ok(parameters) = source.parse::<InterfaceParameters>() {
                out.laws.insert(name.to_owned(), LawFile(parameters));
            }
        }
        out
    }

    /// Returns the parameters of laws that an interface takes from a file, either the file of a
    /// material or a file of parameters.
    pub fn laws_of(&self, case: &Case, spec: &InterfaceSpec) -> Option<&LawFile> {
        let name = spec.parameters_from.as_ref()?;
        let material = case.materials.get(name).and_then(|f| self.laws.get(f));
        material.or_else(|| self.laws.get(name))
    }

    /// Returns the property of a material that a parameter named `young_1` or `young_2` takes, and
    /// the file of the material.
    pub fn property(
        &self,
        case: &Case,
        spec: &InterfaceSpec,
        parameter: &str,
    ) -> Option<(Sourced, String)> {
        let (property, side) = match parameter.rsplit_once('_')? {
            (property, "1") => (property, &spec.between.0),
            (property, "2") => (property, &spec.between.1),
            _ => return None,
        };
        let file = case.materials.get(side)?;
        let number = self.materials.get(file)?.properties.get(property)?;
        Some((number.clone(), file.clone()))
    }
}
