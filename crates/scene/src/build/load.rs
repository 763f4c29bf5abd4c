//! Loading of a case from text, a reader or a value, with all checks.

use super::LoadedCase;
use crate::case::Case;
use crate::material::{InterfaceParameters, Material, MaterialLibrary};
use crate::recorded::RecordReader;
use crate::source::{self, InputError, Source, ValidationError, join_path};
use serde::Serialize;
use std::io::Read;
use std::path::Path;

/// Reads a case file, RON, JSON or YAML by the ending of its name, and applies `--set`s.
///
/// # Errors
/// Returns an error with file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<LoadedCase, InputError> {
    read(Case::source(path)?, path, sets)
}

/// Loads a case from a text. `name` stands for the file in errors, and says by its ending whether
/// the text is JSON or YAML; the files that the case names, and `materials/`, are searched relative
/// to `folder` (an empty path for the working folder).
///
/// # Errors
/// Returns an error with name, line and column.
///
/// # Examples
/// ```
/// let text = r#"(
///     name: "a ball in the air", dimension: 2, time: (step: 1e-3, end: 0.1), gravity: [0.0, -9.81],
///     materials: {"steel": "rail_steel_r260"}, interfaces: [],
///     grains: [List(material: "steel", grains: [(at: [0.0, 0.0], radius: 0.01)])],
/// )"#;
/// let loaded = fretwork_scene::load_text("ball.ron", text, "".as_ref(), &["time.end=0.2".into()])?;
/// assert_eq!(loaded.case.time.end, 0.2);
/// // A mistake is an error with its place, as in a file.
/// let wrong = fretwork_scene::load_text("ball.ron", &text.replace("radius", "radus"), "".as_ref(), &[]);
/// let sentence = wrong.map(|_| ()).unwrap_err().to_string();
/// assert!(sentence.contains("ball.ron:4:") && sentence.contains("did you mean `radius`?"), "{sentence}");
/// # Ok::<(), fretwork_scene::InputError>(())
/// ```
pub fn load_text(
    name: &str,
    text: &str,
    folder: &Path,
    sets: &[String],
) -> Result<LoadedCase, InputError> {
    read(Case::source_of_text(name, text)?, &folder.join(name), sets)
}

/// Loads a case from a stream, which is read to its end: at most 64 MiB of UTF-8.
///
/// # Errors
/// The errors of [`load_text`], or the stream cannot be read.
pub fn load_reader(
    name: &str,
    mut from: impl Read,
    folder: &Path,
    sets: &[String],
) -> Result<LoadedCase, InputError> {
    let text = source::read_text_from(Path::new(name), &mut from)?;
    load_text(name, &text, folder, sets)
}

fn read(mut source: Source, path: &Path, sets: &[String]) -> Result<LoadedCase, InputError> {
    for set in sets {
        Case::set(&mut source, set)?;
    }
    Case::convert_units(&mut source)?;
    let case = Case::read(&source)?;
    LoadedCase::checked(source, case, path)
}

impl LoadedCase {
    /// Checks a case made in Rust, for instance by a [`CaseBuilder`](crate::CaseBuilder). Errors
    /// give positions in the text from [`Case::to_ron`]. Files are searched as in [`load_text`].
    ///
    /// # Errors
    /// Returns the errors of a case file with the same content.
    pub fn from_case(case: Case, folder: &Path) -> Result<Self, InputError> {
        let name = "case.ron (built in Rust)";
        let text = case.to_ron()?;
        Self::checked(Source::from_text(name, text), case, &folder.join(name))
    }

    fn checked(source: Source, case: Case, path: &Path) -> Result<Self, InputError> {
        crate::check::numbers(&case).map_err(|f| source.locate(f))?;
        for (name, material) in case.materials.own() {
            let within = |fault: ValidationError| {
                let parts = ["materials".to_owned(), name.clone()];
                source.locate(fault.under(&join_path(&parts)))
            };
            material.density().map_err(within)?;
            if let Some(laws) = &material.laws {
                laws.units().map_err(|fault| within(fault.under("laws")))?;
            }
        }
        let own_files = case.materials.own_files()?;
        Ok(Self {
            source,
            case,
            path: path.to_owned(),
            records: None,
            own_files,
        })
    }

    /// Sets the reader of grains of other runs.
    #[must_use]
    pub fn reading_records(self, reader: RecordReader) -> Self {
        Self {
            records: Some(reader),
            ..self
        }
    }

    /// Adds a material under a file name, which precedes any file with that name when `materials`
    /// of the case refers to it.
    ///
    /// # Errors
    /// The material cannot be written as text.
    pub fn with_material(self, file: &str, material: &Material) -> Result<Self, InputError> {
        self.with_file(file, material)
    }

    /// Adds parameters of laws under a file name, to which `parameters_from` of an interface
    /// refers.
    ///
    /// # Errors
    /// The parameters cannot be written as text.
    pub fn with_parameters(
        self,
        file: &str,
        parameters: &InterfaceParameters,
    ) -> Result<Self, InputError> {
        self.with_file(file, parameters)
    }

    fn with_file(mut self, file: &str, content: &impl Serialize) -> Result<Self, InputError> {
        let text = crate::case::text::write(file, content)?;
        self.own_files.insert(file.to_owned(), text);
        Ok(self)
    }

    /// Returns the library in which material files are searched.
    pub(crate) fn material_library(&self) -> MaterialLibrary {
        MaterialLibrary::beside(&self.path).with_own(&self.own_files)
    }
}
