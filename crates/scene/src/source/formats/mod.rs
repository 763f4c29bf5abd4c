//! Input files as JSON and YAML: read into a tree whose values know their places, and written as
//! RON by the schema, so that everything after that is one reader.

mod item;
mod lay_out;
mod of_ron;
mod read;
mod to_ron;

use std::path::Path;

use serde::de::DeserializeOwned;

use super::{InputError, Source, read_text};

/// A format of input files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// RON, the format of the shipped files.
    Ron,
    /// JSON.
    Json,
    /// YAML 1.2.
    Yaml,
}

impl Format {
    /// Returns the format of a file by the ending of its name; RON for unknown ones.
    pub fn of(path: &Path) -> Self {
        let ending = path.extension().and_then(|e| e.to_str());
        match ending.map(str::to_lowercase).as_deref() {
            Some("json") => Self::Json,
            Some("yaml" | "yml") => Self::Yaml,
            _ => Self::Ron,
        }
    }
}

/// Returns the names of the fields of a text in the format of its file's name, as far as it is
/// well formed.
pub fn fields_of(path: &Path, text: &str) -> Vec<String> {
    let tree = |text: &str| {
        let tree = super::Tree::of(text);
        let group = tree.root.as_ref().and_then(super::Node::group);
        let keys = group.into_iter().flat_map(|g| &g.entries);
        let names = keys.filter_map(|e| Some(super::tree::unquoted(&text[e.key.clone()?])));
        names.collect()
    };
    let format = Format::of(path);
    if format == Format::Ron {
        return tree(text);
    }
    match read::read("", text, format).map(|item| item.kind) {
        Ok(item::ItemKind::Object(entries)) => {
            entries.into_iter().map(|(key, _)| key.name).collect()
        }
        Ok(_) => Vec::new(),
        // While it is being written: words at the beginnings of lines.
        Err(_) => {
            let names = text.lines().filter_map(|line| line.split_once(':'));
            let names = names.map(|(name, _)| name.trim().trim_matches('"').to_owned());
            names.collect()
        }
    }
}

impl Source {
    /// Reads the file of a `T`, as RON, JSON or YAML by the ending of its name.
    ///
    /// # Errors
    /// The errors of [`read_text`], or the text is no JSON or YAML.
    pub fn read_as<T: DeserializeOwned>(path: &Path) -> Result<Self, InputError> {
        Self::text_as::<T>(path, read_text(path)?)
    }

    /// Wraps the text of a `T` under the name of its file, by whose ending it is RON, JSON or YAML.
    ///
    /// # Errors
    /// The text is no JSON or YAML.
    pub fn text_as<T: DeserializeOwned>(
        name: impl AsRef<Path>,
        text: impl Into<String>,
    ) -> Result<Self, InputError> {
        let format = Format::of(name.as_ref());
        let mut source = Self::from_text(name, text);
        if format != Format::Ron {
            let item = read::read(&source.name, &source.original, format)?;
            let (text, source_map) = to_ron::write::<T>(&source.original, &item);
            source.tree = super::Tree::of(&text);
            source.text = text;
            source.source_map = source_map;
        }
        Ok(source)
    }

    /// Returns the text as it was written, in another format and laid out anew. Comments are lost.
    ///
    /// # Errors
    /// The text is not well formed, or has a value that the format has not.
    pub fn in_format(&self, format: Format) -> Result<String, InputError> {
        let written = Self::from_text(&self.path, self.written());
        if let Some(fault) = &written.tree.fault {
            return Err(self.error_in(&fault.span, fault.message.clone()));
        }
        match &written.tree.root {
            Some(root) if format == Format::Ron => Ok(lay_out::ron(&written.text, root)),
            Some(root) => {
                let item = of_ron::item(&written, root)?;
                Ok(lay_out::item(&item, format))
            }
            None => Err(InputError::about(&self.name, "holds no value")),
        }
    }
}
