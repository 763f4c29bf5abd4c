//! Where plugins are found: by kind and name, on a search path. A case cannot name a file.

use super::library::{Kind, LawError, Plugin};
use super::trust;
use std::path::{Path, PathBuf};

/// Environment variable with further folders.
pub const VARIABLE: &str = "FRETWORK_PLUGIN_PATH";

/// Folders in which plugins are looked for, in order.
#[derive(Clone, Debug)]
pub struct SearchPath {
    folders: Vec<PathBuf>,
    /// How many of them are the program's own.
    shipped: usize,
    trusting: bool,
}

/// Whether a law's name is made of a-z, 0-9, `-` and `_` and begins with a letter or digit.
pub fn name_is_valid(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    name.chars().next().is_some_and(plain) && name.chars().all(|c| plain(c) || c == '-' || c == '_')
}

/// The file that holds a law: `libfretwork_KIND_NAME.so`, with `-` in the name written `_`.
pub fn file_name(kind: Kind, name: &str) -> String {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    format!(
        "{DLL_PREFIX}fretwork_{kind}_{}{DLL_SUFFIX}",
        name.replace('-', "_")
    )
}

impl SearchPath {
    /// The shipped folders beside the program, then `extra`, then the environment variable's.
    pub fn new(extra: &[PathBuf]) -> Self {
        let mut folders = shipped();
        let shipped = folders.len();
        folders.extend_from_slice(extra);
        if let Some(value) = std::env::var_os(VARIABLE) {
            folders.extend(std::env::split_paths(&value).filter(|p| !p.as_os_str().is_empty()));
        }
        Self {
            folders,
            shipped,
            trusting: false,
        }
    }

    /// The same path; libraries are opened even where anybody may write.
    #[must_use]
    pub fn trusting(self) -> Self {
        Self {
            trusting: true,
            ..self
        }
    }

    /// The folders, in order.
    pub fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// Opens the law of this kind and name; the first folder that has it wins.
    ///
    /// # Errors
    /// No such law (with the nearest name), or a library that cannot be used.
    pub fn find(&self, kind: Kind, name: &str) -> Result<Plugin, LawError> {
        self.find_pinned(kind, name, None)
    }

    /// The same, where the library must have a SHA-256 (in hexadecimal).
    ///
    /// # Errors
    /// As above; and another SHA-256, before anything of the library is run.
    pub fn find_pinned(
        &self,
        kind: Kind,
        name: &str,
        pin: Option<&str>,
    ) -> Result<Plugin, LawError> {
        let files = self.folders.iter().map(|f| f.join(file_name(kind, name)));
        let mut files = files.filter(|p| p.is_file());
        let Some(path) = files.next().filter(|_| name_is_valid(name)) else {
            return Err(self.unknown(kind, name));
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

    /// Opens a library, unless anybody may write to it or to its folder.
    ///
    /// # Errors
    /// Why it is not opened, or cannot be used.
    pub fn open(&self, path: &Path) -> Result<Plugin, LawError> {
        self.open_pinned(path, None)
    }

    fn open_pinned(&self, path: &Path, pin: Option<&str>) -> Result<Plugin, LawError> {
        // Who may write beside the program may change the program.
        let own = path
            .parent()
            .is_some_and(|p| self.folders[..self.shipped].iter().any(|f| f == p));
        let doubt = (!own && !self.trusting)
            .then(|| trust::doubt(path))
            .flatten();
        if let Some(reason) = doubt {
            let path = path.to_owned();
            return Err(LawError::Unusable { path, reason });
        }
        Plugin::open_pinned(path, pin)
    }

    /// All laws on the path by their file names (with `_` as `-`), unopened, sorted.
    pub fn available(&self) -> Vec<(Kind, String, PathBuf)> {
        let mut out: Vec<(Kind, String, PathBuf)> = Vec::new();
        for folder in &self.folders {
            let Ok(entries) = std::fs::read_dir(folder) else {
                continue;
            };
            for path in entries.flatten().map(|e| e.path()) {
                if let Some((kind, name)) = parse(&path)
                    && path.is_file()
                    && !out.iter().any(|(k, n, _)| *k == kind && *n == name)
                {
                    out.push((kind, name, path));
                }
            }
        }
        out.sort();
        out
    }

    fn unknown(&self, kind: Kind, name: &str) -> LawError {
        let names: Vec<String> = self
            .available()
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
    Kind::ALL.into_iter().find_map(|kind| {
        let name = stem.strip_prefix(kind.word())?.strip_prefix('_')?;
        // No law's file has a dash: cargo's names with a hash do.
        (name_is_valid(name) && !name.contains('-')).then(|| (kind, name.replace('_', "-")))
    })
}

/// Beside the program, where cargo puts libraries, and where an installation would.
fn shipped() -> Vec<PathBuf> {
    let Some(here) = std::env::current_exe()
        .ok()
        .and_then(|p| p.parent().map(Path::to_owned))
    else {
        return Vec::new();
    };
    let mut out = vec![here.clone(), here.join("deps")];
    // Cargo's examples and tests stand beside or in the folder of the libraries.
    let of_cargo = here
        .file_name()
        .is_some_and(|n| n == "deps" || n == "examples");
    if let Some(above) = here.parent().filter(|_| of_cargo) {
        out.push(above.join("deps"));
    }
    if let Some(above) = here.parent().filter(|_| here.ends_with("bin")) {
        out.push(above.join("lib").join("fretwork"));
    }
    out
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
        let path = PathBuf::from(file_name(Kind::Damage, "mohr-coulomb-brittle"));
        assert_eq!(
            parse(&path),
            Some((Kind::Damage, "mohr-coulomb-brittle".into()))
        );
        let hashed = file_name(Kind::Damage, "mac").replace("mac", "mac-0a1b2c");
        assert_eq!(parse(&PathBuf::from(hashed)), None);
    }
}
