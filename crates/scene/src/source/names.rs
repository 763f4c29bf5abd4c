//! Names that are valid at a path of a text: for completion in editors and interpreters.

use super::Source;
use super::schema::{Level, levels};
use super::tree::split_path;
use serde::de::DeserializeOwned;

/// Names that are valid at a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Names {
    /// A struct, or a variant with fields: all its fields, whether the text has them or not.
    Fields(Vec<String>),
    /// A map or a list: the keys or names in the text, indices for elements without a name.
    Entries(Vec<String>),
    /// One of several kinds, of which the text has none that has fields.
    Kinds(Vec<String>),
    /// One value.
    Value,
}

impl Source {
    /// Returns the names that are valid at a dotted path of a text of type `T`, the empty path for
    /// the text itself; `None` if `T` has no such path.
    ///
    /// ```
    /// use fretwork_scene::source::{Names, Source};
    /// use fretwork_scene::Case;
    ///
    /// let source = Source::from_text("a.ron", "(time: (step: 1e-3, end: 1), bodies: [(name: \"floor\")])");
    /// let fields = ["step", "end", "theta"].map(str::to_owned).to_vec();
    /// assert_eq!(source.names::<Case>("time"), Some(Names::Fields(fields)));
    /// assert_eq!(source.names::<Case>("bodies"), Some(Names::Entries(vec!["floor".into()])));
    /// assert_eq!(source.names::<Case>("time.stp"), None);
    /// ```
    pub fn names<T: DeserializeOwned>(&self, path: &str) -> Option<Names> {
        let parts = match path.trim() {
            "" => Vec::new(),
            path => split_path(path)?,
        };
        let root = self.tree.root.as_ref();
        // An additional component, which no type has, lists the fields of a variant in the text.
        let beyond = [parts.as_slice(), &[String::new()]].concat();
        let found = levels::<T>(&self.text, root, &beyond);
        let written = || {
            let node = self.tree.find(&self.text, &parts).ok();
            node.map_or_else(Vec::new, |node| node.choices(&self.text))
        };
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Some(match found.get(parts.len())? {
            Level::Struct(fields) => Names::Fields(owned(fields)),
            Level::Map | Level::List | Level::Tuple => Names::Entries(written()),
            Level::Enum(kinds) => Names::Kinds(owned(kinds)),
            Level::Value => Names::Value,
        })
    }
}
