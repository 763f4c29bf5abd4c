//! Search for plugins by kind and name on a search path. A case cannot name a file.

use super::built_in::BuiltInLaws;
use super::error::LawError;
use super::kind::Kind;
use super::library::Plugin;
pub use super::names::{PATH_VARIABLE, name_is_valid};
use super::{loading, trust};
use std::path::{Path, PathBuf};

/// Folders in which plugins are searched, in order.
#[derive(Clone, Debug)]
pub struct SearchPath {
    folders: Vec<PathBuf>,
    /// Number of folders at the start of the list that belong to the program.
    beside: usize,
    built_in: BuiltInLaws,
    trusting: bool,
}

/// Location of a law.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LawLocation {
    /// A library, which contains the law.
    Library(PathBuf),
    /// The program itself.
    BuiltIn,
}

/// Returns the file name of a law's library: `libfretwork_KIND_NAME.so`, with `-` in the name
/// written `_`.
pub fn file_name(kind: Kind, name: &str) -> String {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    format!(
        "{DLL_PREFIX}fretwork_{kind}_{}{DLL_SUFFIX}",
        name.replace('-', "_")
    )
}

impl SearchPath {
    /// Builds the search path: the program's own folders, then `extra`, then those of the
    /// environment variable.
    pub fn new(extra: &[PathBuf]) -> Self {
        let mut folders = beside_program();
        let beside = folders.len();
        folders.extend_from_slice(extra);
        if let Some(value) = std::env::var_os(PATH_VARIABLE) {
            folders.extend(std::env::split_paths(&value).filter(|p| !p.as_os_str().is_empty()));
        }
        Self {
            folders,
            beside,
            built_in: BuiltInLaws::default(),
            trusting: false,
        }
    }

    /// Adds laws that are linked into the program, after those that were added before.
    #[must_use]
    pub fn with_built_in(self, laws: BuiltInLaws) -> Self {
        Self {
            built_in: self.built_in.and(&laws),
            ..self
        }
    }

    /// Allows libraries to be opened from locations where anybody may write.
    #[must_use]
    pub fn trusting(self) -> Self {
        Self {
            trusting: true,
            ..self
        }
    }

    /// Returns the folders, in search order.
    pub fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// Opens the law of this kind and name: a built-in one, or that of the first folder that has
    /// its library. A library therefore cannot replace a built-in law.
    ///
    /// # Errors
    /// There is no such law (the error gives the most similar name), or its library is unusable.
    pub fn find(&self, kind: Kind, name: &str) -> Result<Plugin, LawError> {
        self.find_pinned(kind, name, None)
    }

    /// Finds a law as [`Self::find`] does, in a library with a required SHA-256 (in hexadecimal).
    ///
    /// # Errors
    /// Returns the errors of [`Self::find`], and an error for a different SHA-256 before any code
    /// of the library runs.
    pub fn find_pinned(
        &self,
        kind: Kind,
        name: &str,
        pin: Option<&str>,
    ) -> Result<Plugin, LawError> {
        let path = match self.place(kind, name) {
            Some(LawLocation::Library(path)) => path,
            Some(LawLocation::BuiltIn) => return self.linked_in(kind, name, pin),
            None => return Err(self.unknown(kind, name)),
        };
        let plugin = self.open_pinned(&path, pin)?;
        if plugin.kind != kind || plugin.name != name {
            let reason = format!(
                "its file name promises the {kind} law `{name}` but it holds the {} law `{}`; rename the file",
                plugin.kind, plugin.name
            );
            return Err(LawError::Unusable { path, reason });
        }
        Ok(plugin)
    }

    /// Returns the location of the law of this kind and name, without opening it.
    fn place(&self, kind: Kind, name: &str) -> Option<LawLocation> {
        if !name_is_valid(name) {
            return None;
        }
        if self.built_in.names().any(|law| law == (kind, name)) {
            return Some(LawLocation::BuiltIn);
        }
        let mut files = self.folders.iter().map(|f| f.join(file_name(kind, name)));
        files.find(|p| p.is_file()).map(LawLocation::Library)
    }

    fn linked_in(&self, kind: Kind, name: &str, pin: Option<&str>) -> Result<Plugin, LawError> {
        let found = self.built_in.open(kind, name);
        let plugin = found.unwrap_or_else(|| Err(self.unknown(kind, name)))?;
        match pin.filter(|p| !p.eq_ignore_ascii_case(&plugin.sha256)) {
            Some(pin) => Err(LawError::HashMismatch {
                path: plugin.path,
                pin: pin.to_owned(),
                sha256: plugin.sha256,
            }),
            None => Ok(plugin),
        }
    }

    /// Opens a law listed by [`SearchPath::laws`].
    ///
    /// # Errors
    /// Returns the reason why the law cannot be used.
    pub fn open_law(
        &self,
        kind: Kind,
        name: &str,
        place: &LawLocation,
    ) -> Result<Plugin, LawError> {
        match place {
            LawLocation::Library(path) => self.open(path),
            LawLocation::BuiltIn => self.linked_in(kind, name, None),
        }
    }

    /// Tries the libraries of several laws in one child process before they are opened one by one.
    /// Missing or untrusted laws are skipped; opening them reports the error.
    pub fn test_loading<'a>(
        &self,
        laws: impl IntoIterator<Item = (Kind, &'a str, Option<&'a str>)>,
    ) {
        let mut libraries = Vec::new();
        for (kind, name, pin) in laws {
            if let Some(LawLocation::Library(path)) = self.place(kind, name)
                && self.reason_to_distrust(&path).is_none()
            {
                libraries.push((path, pin));
            }
        }
        loading::try_loading(&libraries);
    }

    /// Returns whether a law belongs to the program itself: whoever can change the law can then
    /// change the program anyway.
    pub fn belongs_to_program(&self, plugin: &Plugin) -> bool {
        plugin.built_in
            || (self.own(&plugin.path) && self.reason_to_distrust(&plugin.path).is_none())
    }

    fn own(&self, library: &Path) -> bool {
        let folder = library.parent();
        folder.is_some_and(|p| self.folders[..self.beside].iter().any(|f| f == p))
    }

    /// Returns the reason why a library should not be opened, if there is one.
    fn reason_to_distrust(&self, library: &Path) -> Option<String> {
        if self.trusting {
            None
        } else if self.own(library) {
            trust::reason_to_distrust_beside_program(library)
        } else {
            trust::reason_to_distrust(library)
        }
    }

    /// Opens a library, unless others may write to it or to its folder.
    ///
    /// # Errors
    /// Returns the reason why the library is not opened, or cannot be used.
    pub fn open(&self, path: &Path) -> Result<Plugin, LawError> {
        self.open_pinned(path, None)
    }

    fn open_pinned(&self, path: &Path, pin: Option<&str>) -> Result<Plugin, LawError> {
        if let Some(reason) = self.reason_to_distrust(path) {
            let path = path.to_owned();
            return Err(LawError::Unusable { path, reason });
        }
        Plugin::open_pinned(path, pin)
    }

    /// Lists all laws by the names under which they are found, sorted and without opening them:
    /// libraries by their file names (with `_` as `-`), and built-in laws.
    pub fn laws(&self) -> Vec<(Kind, String, LawLocation)> {
        let mut out: Vec<(Kind, String, LawLocation)> = Vec::new();
        let mut add = |kind: Kind, name: String, place: LawLocation| {
            if !out.iter().any(|(k, n, _)| *k == kind && *n == name) {
                out.push((kind, name, place));
            }
        };
        for (kind, name) in self.built_in.names() {
            add(kind, name.to_owned(), LawLocation::BuiltIn);
        }
        for folder in &self.folders {
            let Ok(entries) = std::fs::read_dir(folder) else {
                continue;
            };
            for path in entries.flatten().map(|e| e.path()) {
                if let Some((kind, name)) = parse(&path)
                    && path.is_file()
                {
                    add(kind, name, LawLocation::Library(path));
                }
            }
        }
        out.sort();
        out
    }

    /// Lists the laws that are libraries.
    pub fn available(&self) -> Vec<(Kind, String, PathBuf)> {
        let libraries = self.laws().into_iter().filter_map(|law| match law {
            (kind, name, LawLocation::Library(path)) => Some((kind, name, path)),
            _ => None,
        });
        libraries.collect()
    }

    /// Describes where laws are searched for, in order.
    pub fn searched(&self) -> String {
        let built_in = self
            .built_in
            .names()
            .next()
            .map(|_| "the program itself".to_owned());
        let folders = self.folders.iter().enumerate();
        let folders = folders.filter(|(number, f)| *number >= self.beside || f.is_dir());
        let places = built_in
            .into_iter()
            .chain(folders.map(|(_, f)| f.display().to_string()));
        places.collect::<Vec<_>>().join(", ")
    }

    fn unknown(&self, kind: Kind, name: &str) -> LawError {
        let names: Vec<String> = self
            .laws()
            .into_iter()
            .filter(|a| a.0 == kind)
            .map(|a| a.1)
            .collect();
        let wanted = name.to_lowercase().replace('_', "-");
        let nearest = names
            .iter()
            .map(|n| (strsim::damerau_levenshtein(n, &wanted), n))
            .min()
            .filter(|(d, n)| *d <= n.len().max(3) / 2)
            .map(|(_, n)| n.clone());
        let available = if names.is_empty() {
            "none".into()
        } else {
            names.join(", ")
        };
        LawError::Unknown {
            kind,
            name: name.into(),
            available,
            searched: self.searched(),
            nearest,
        }
    }
}

fn parse(path: &Path) -> Option<(Kind, String)> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let file = path.file_name()?.to_str()?;
    let stem = file
        .strip_prefix(DLL_PREFIX)?
        .strip_suffix(DLL_SUFFIX)?
        .strip_prefix("fretwork_")?;
    Kind::all().into_iter().find_map(|kind| {
        let name = stem.strip_prefix(kind.word())?.strip_prefix('_')?;
        // File names of laws contain no dash; the names that cargo gives with a hash do.
        (name_is_valid(name) && !name.contains('-')).then(|| (kind, name.replace('_', "-")))
    })
}

/// Returns the folders that belong to the program: the folder of its file, and the folder for laws
/// of an installation.
fn beside_program() -> Vec<PathBuf> {
    let Ok(program) = crate::program::file() else {
        return Vec::new();
    };
    let Some(here) = program.parent() else {
        return Vec::new();
    };
    let installed = here.parent().filter(|_| here.ends_with("bin"));
    let installed = installed.map(|above| above.join("lib").join("fretwork"));
    std::iter::once(here.to_owned()).chain(installed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_reach_other_folders() {
        for bad in ["../mac", "a/b", "", "Mac", ".mac", "mac\\x", "-mac"] {
            assert!(!name_is_valid(bad), "{bad}");
        }
        assert!(name_is_valid("mohr-coulomb-brittle"));
    }

    #[test]
    fn file_names_are_read_back() {
        let path = PathBuf::from(file_name(Kind::DAMAGE, "mohr-coulomb-brittle"));
        assert_eq!(
            parse(&path),
            Some((Kind::DAMAGE, "mohr-coulomb-brittle".into()))
        );
        let hashed = file_name(Kind::DAMAGE, "mac").replace("mac", "mac-0a1b2c");
        assert_eq!(parse(&PathBuf::from(hashed)), None);
    }
}
