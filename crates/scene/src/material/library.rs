//! Where material files are found, by their names or other names.

use super::Material;
use crate::shipped_materials::{self, FILES};
use crate::source::{InputError, Source, Tree, Wanted, nearest, read_text};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What follows the name of a file that is built in.
pub(super) const BUILT_IN: &str = " (built in)";

/// The folders searched for material files: `materials/` beside the case and in each folder above
/// it, then in the working folder, then the files built into the program.
#[derive(Clone, Debug)]
pub struct MaterialLibrary {
    folders: Vec<PathBuf>,
    /// Texts that the program supplies, which precede all files.
    own: BTreeMap<String, String>,
    /// The files of the folders, once a name was not that of a file.
    files: OnceLock<Vec<Named>>,
}

/// A file with its names.
#[derive(Clone, Debug)]
struct Named {
    /// Name of the file, without `.ron`.
    name: String,
    /// Other names of the material.
    also: Vec<String>,
    /// The file; `None` if it is built in.
    path: Option<PathBuf>,
}

impl Named {
    fn new(name: &str, text: &str, path: Option<PathBuf>) -> Self {
        let tree = Tree::of(text);
        let list = tree.find(text, &["also".to_owned()]).ok();
        let entries = list.and_then(|list| list.group()).map(|g| &g.entries);
        let names = entries.into_iter().flatten();
        Self {
            name: name.to_owned(),
            also: names.filter_map(|e| e.value.string(text)).collect(),
            path,
        }
    }

    /// All its names.
    fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.name.as_str()).chain(self.also.iter().map(String::as_str))
    }
}

/// The files built into the program.
fn shipped() -> &'static [Named] {
    static SHIPPED: OnceLock<Vec<Named>> = OnceLock::new();
    SHIPPED.get_or_init(|| {
        let files = FILES.iter();
        files
            .map(|(name, text)| Named::new(name, text, None))
            .collect()
    })
}

/// Returns letters and digits of a name in lower case: `Ti-6Al-4V` and `Ti6Al4V` are the same.
fn folded(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

/// A material that was found.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Name of the file, without `.ron`.
    pub name: String,
    /// The file; `None` if it is built in.
    pub path: Option<PathBuf>,
    /// Its content, or why it cannot be read.
    pub material: Result<Material, InputError>,
}

impl MaterialLibrary {
    /// The search path for a case file.
    pub fn beside(case: &Path) -> Self {
        let absolute = std::path::absolute(case).unwrap_or_else(|_| case.to_owned());
        let mut folders: Vec<PathBuf> = absolute
            .ancestors()
            .skip(1)
            .map(|a| a.join("materials"))
            .collect();
        folders.push(PathBuf::from("materials"));
        folders.retain(|f| f.is_dir());
        Self {
            folders,
            own: BTreeMap::new(),
            files: OnceLock::new(),
        }
    }

    /// The files built into the program alone.
    pub fn shipped() -> Self {
        Self {
            folders: Vec::new(),
            own: BTreeMap::new(),
            files: OnceLock::new(),
        }
    }

    /// Adds texts by name, which are used instead of files of the same names.
    #[must_use]
    pub fn with_own(mut self, texts: &BTreeMap<String, String>) -> Self {
        self.own.clone_from(texts);
        self
    }

    /// Reads the file `NAME.ron`, or the file of a material that has this other name, whatever its
    /// case, blanks and hyphens; files of the folders precede those of the program. A unit with a
    /// value, `value: 200 GPa`, stands beside it in the text that is returned.
    ///
    /// # Errors
    /// Returns `Err(Ok(missing))` if there is no such file, `Err(Err(error))` if it cannot be read.
    pub fn read(&self, name: &str) -> Result<Source, Result<MissingMaterial, InputError>> {
        with_units(self.find(name)?).map_err(Err)
    }

    /// Reads a file by its path, as [`MaterialLibrary::read`] does.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read_file(path: &Path) -> Result<Source, InputError> {
        with_units(Source::read(path)?)
    }

    /// Reads the text of a file, see [`MaterialLibrary::read_file`].
    ///
    /// # Errors
    /// A unit is unknown, or given twice.
    pub fn read_text(name: &str, text: &str) -> Result<Source, InputError> {
        with_units(Source::from_text(name, text))
    }

    /// Returns all materials, sorted by the names of their files; files with parameters of laws
    /// alone are none.
    pub fn list(&self) -> Vec<Listed> {
        let mut out: Vec<Listed> = Vec::new();
        for file in self.files().iter().chain(shipped()) {
            if out.iter().any(|listed| listed.name == file.name) {
                continue;
            }
            let material = match self.read(&file.name) {
                Ok(source) if is_material(&source) => source.parse(),
                Ok(_) | Err(Ok(_)) => continue,
                Err(Err(error)) => Err(error),
            };
            out.push(Listed {
                name: file.name.clone(),
                path: file.path.clone(),
                material,
            });
        }
        out.sort_by(|a, b| a.name.cmp(&b.name));
        out
    }

    /// The files of the folders, in the order of the folders.
    fn files(&self) -> &[Named] {
        self.files.get_or_init(|| {
            let mut out = Vec::new();
            for folder in &self.folders {
                let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
                let mut paths: Vec<PathBuf> = entries.map(|e| e.path()).collect();
                paths.sort();
                for path in paths {
                    let file = path.file_name().and_then(|name| name.to_str());
                    let Some(name) = file.and_then(|name| name.strip_suffix(".ron")) else {
                        continue;
                    };
                    // A file that cannot be read is reported where it is used.
                    let text = read_text(&path).unwrap_or_default();
                    out.push(Named::new(name, &text, Some(path.clone())));
                }
            }
            out
        })
    }

    /// Finds a file by another name of its material.
    fn by_other_name(&self, name: &str) -> Option<&Named> {
        // Results have the text under the name, as a path.
        if name.contains('/') {
            return None;
        }
        let wanted = folded(name);
        let mut files = self.files().iter().chain(shipped());
        files.find(|file| !wanted.is_empty() && file.names().any(|name| folded(name) == wanted))
    }

    fn find(&self, name: &str) -> Result<Source, Result<MissingMaterial, InputError>> {
        if let Some(text) = self.own.get(name) {
            return Ok(Source::from_text(
                format!("{name}.ron (built in Rust)"),
                text.as_str(),
            ));
        }
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
        if let Some(path) = found.flatten() {
            return Source::read(&path).map_err(Err);
        }
        let built_in = |name: &str| {
            let text = shipped_materials::text(name)?;
            let file = format!("materials/{name}.ron{BUILT_IN}");
            Some(Source::from_text(file, text))
        };
        if let Some(source) = built_in(name) {
            return Ok(source);
        }
        let other = self.by_other_name(name);
        match other.map(|file| (file.path.as_ref(), built_in(&file.name))) {
            Some((Some(path), _)) => Source::read(path).map_err(Err),
            Some((None, Some(source))) => Ok(source),
            _ => Err(Ok(self.missing(name))),
        }
    }

    fn missing(&self, name: &str) -> MissingMaterial {
        let files = self.files().iter().chain(shipped());
        let names = files.flat_map(Named::names);
        let names: Vec<&str> = names.chain(self.own.keys().map(String::as_str)).collect();
        let part = folded(name);
        let holds = |other: &&str| !part.is_empty() && folded(other).contains(&part);
        let near = nearest(name, names.iter().copied());
        let near = near.or_else(|| names.iter().copied().find(|n| holds(n)));

        let files = self.files().iter().map(|file| file.name.as_str());
        let own = files.filter(|name| shipped_materials::text(name).is_none());
        let mut own: Vec<&str> = own.chain(self.own.keys().map(String::as_str)).collect();
        own.sort_unstable();
        own.dedup();
        let shipped = format!("the {} of `fretwork material list`", FILES.len());
        let available = match own.as_slice() {
            [] => shipped,
            own => format!("{}, and {shipped}", own.join(", ")),
        };
        let folders = self.folders.iter().map(|f| f.display().to_string());
        let built_in = std::iter::once("the program itself".to_owned());
        MissingMaterial {
            nearest: near.map(str::to_owned),
            available,
            searched: folders.chain(built_in).collect::<Vec<_>>().join(", "),
        }
    }
}

/// Moves the units of values beside them.
fn with_units(mut source: Source) -> Result<Source, InputError> {
    source.replace_quantities(|place| match place.names.last() {
        Some(name) if name == "value" => Wanted::Pair,
        _ => Wanted::NoNumber,
    })?;
    Ok(source)
}

/// Whether a text is that of a material, and not parameters of laws alone.
fn is_material(source: &Source) -> bool {
    let density = ["density".to_owned()];
    source.tree().find(source.text(), &density).is_ok()
}

/// A name without a file.
#[derive(Clone, Debug)]
pub struct MissingMaterial {
    /// The nearest name.
    pub nearest: Option<String>,
    /// The available names: those of files, and how to list those of the program.
    pub available: String,
    /// The folders that were searched.
    pub searched: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_shipped_materials_have_a_name_in_common() {
        let mut owners: BTreeMap<String, &str> = BTreeMap::new();
        for file in shipped() {
            let names: std::collections::BTreeSet<String> = file.names().map(folded).collect();
            assert_eq!(names.len(), file.names().count(), "{file:?}");
            for name in names {
                let other = owners.insert(name.clone(), &file.name);
                assert_eq!(other, None, "{name} is of {} too", file.name);
            }
        }
    }

    #[test]
    fn materials_are_found_by_their_other_names() {
        let library = MaterialLibrary::shipped();
        for (name, file) in [
            ("Ti-6Al-4V", "titanium_ti6al4v"),
            ("ti6al4v", "titanium_ti6al4v"),
            ("AISI 52100", "bearing_steel_100cr6"),
            ("60E1 R260", "rail_steel_r260"),
            ("Rail_Steel_R260", "rail_steel_r260"),
            ("PTFE", "ptfe"),
        ] {
            let source = library.read(name).unwrap();
            assert_eq!(source.text(), shipped_materials::text(file).unwrap());
        }
        let missing = |name: &str| library.read(name).unwrap_err().unwrap();
        let near = |name: &str| missing(name).nearest;
        assert_eq!(near("Ti-6Al-4W").as_deref(), Some("Ti-6Al-4V"));
        assert_eq!(near("inconel").as_deref(), Some("Inconel 718"));
        assert_eq!(near("-").as_deref(), None);
        assert_eq!(near("unobtainium").as_deref(), None);
    }

    /// The files of a folder precede those of the program, by their other names as well.
    #[test]
    fn own_files_have_other_names_too() {
        let folder = std::env::temp_dir().join(format!("fretwork-names-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("materials")).unwrap();
        let text = r#"(doc: "own", also: ["PTFE", "mine"], density: (value: 1.0, source: "s"))"#;
        std::fs::write(folder.join("materials/own_ptfe.ron"), text).unwrap();
        std::fs::write(folder.join("materials/laws.ron"), "(contact: {})").unwrap();
        let library = MaterialLibrary::beside(&folder.join("case.ron"));
        let doc = |name: &str| library.read(name).unwrap().parse::<Material>().unwrap().doc;
        assert_eq!([doc("Mine"), doc("PTFE")], ["own", "own"]);
        assert_ne!(
            doc("ptfe"),
            "own",
            "the name of a file precedes other names"
        );
        let missing = library.read("own_ptfa").unwrap_err().unwrap();
        assert_eq!(missing.nearest.as_deref(), Some("own_ptfe"));
        assert!(missing.available.starts_with("laws, own_ptfe, and the "));
        let listed = library.list();
        let own = listed.iter().find(|m| m.name == "own_ptfe").unwrap();
        assert!(own.path.is_some() && own.material.as_ref().unwrap().doc == "own");
        assert!(listed.len() > 40 && !listed.iter().any(|m| m.name == "laws"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
