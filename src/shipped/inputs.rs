//! The shipped cases, studies, fits and patches: inside the program, so that they run by name
//! wherever it is installed.

use crate::cache_folder::cache_folder;
use crate::scene::source::{Source, nearest};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Path in the folder of the project, with `/`, and text of each file, in order of the paths.
static FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shipped_inputs.rs"));

/// What a file is the input of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// `fretwork run`.
    Case,
    /// `fretwork study`.
    Study,
    /// `fretwork fit`.
    Fit,
    /// `fretwork patch`.
    Patch,
}

/// Size of a file (bytes) from which its kind is not looked for: only cases that list many grains
/// are as large, and they are read once.
const LARGE: u64 = 1 << 20;

impl InputKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Case, Self::Study, Self::Fit, Self::Patch];

    /// Folder of the shipped ones.
    fn folder(self) -> &'static str {
        match self {
            Self::Case => "cases",
            Self::Study => "studies",
            Self::Fit => "fits",
            Self::Patch => "patches",
        }
    }

    /// What one is called.
    pub fn word(self) -> &'static str {
        match self {
            Self::Case => "case",
            Self::Study => "study",
            Self::Fit => "fit",
            Self::Patch => "patch",
        }
    }

    /// Keys that all of its files have, and no files of other kinds together.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Case => &["dimension"],
            Self::Study => &["case", "factors"],
            Self::Fit => &["tests", "parameters"],
            Self::Patch => &["load", "motion"],
        }
    }

    /// Returns what the text of a file is the input of, if its keys tell.
    fn of(text: &str) -> Option<Self> {
        let source = Source::from_text("input", text);
        let has = |key: &&str| source.position_of(key).is_some();
        let mut kinds = Self::ALL.into_iter();
        kinds.find(|kind| kind.keys().iter().all(&has))
    }

    /// The sentence on an input of another kind, with the command that takes it.
    fn instead_of(self, wanted: Self, given: &Path) -> String {
        let file = given.display();
        format!(
            "`{file}` is a {}, and a {} is expected here; to run it: fretwork {} {file}",
            self.word(),
            wanted.word(),
            self.command()
        )
    }

    /// Words that run one.
    pub fn command(self) -> &'static str {
        match self {
            Self::Case => "run",
            Self::Study => "study run",
            Self::Fit => "fit",
            Self::Patch => "patch",
        }
    }
}

/// A shipped input.
#[derive(Clone, Copy, Debug)]
pub struct ShippedInput {
    /// What it is the input of.
    pub kind: InputKind,
    /// Path in the folder of the project, with `/`.
    pub path: &'static str,
    /// Text of the file.
    pub text: &'static str,
}

impl ShippedInput {
    /// All shipped inputs, those of a kind together.
    pub fn all() -> impl Iterator<Item = Self> {
        InputKind::ALL.into_iter().flat_map(|kind| {
            FILES.iter().filter_map(move |&(path, text)| {
                let inside = path.strip_prefix(kind.folder())?.strip_prefix('/')?;
                // Cases of fits are files of theirs.
                let own = inside.ends_with(".ron") && !inside.starts_with("cases/");
                own.then_some(Self { kind, path, text })
            })
        })
    }

    /// Name by which it runs.
    pub fn name(&self) -> &'static str {
        let inside = self.path.strip_prefix(self.kind.folder());
        let inside = inside.and_then(|p| p.strip_prefix('/'));
        let name = inside.and_then(|p| p.strip_suffix(".ron"));
        name.unwrap_or(self.path)
    }

    /// The value of its key `name` or `title`.
    pub fn title(&self) -> &'static str {
        let lines = self.text.lines().map(str::trim_start);
        let mut titles = lines.filter_map(|line| {
            let value = line.strip_prefix("name:").or(line.strip_prefix("title:"))?;
            value
                .trim()
                .trim_end_matches(',')
                .strip_prefix('"')?
                .strip_suffix('"')
        });
        titles.next().unwrap_or_default()
    }

    /// Paths of this file and of the shipped ones that it names, and those name, relative to
    /// itself.
    fn with_its_files(&self) -> Vec<&'static str> {
        let mut out = vec![self.path];
        let mut next = 0;
        while let Some(&path) = out.get(next) {
            next += 1;
            let text = text_of(path).unwrap_or_default();
            let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
            // Every second part is between quotation marks.
            for quoted in text.split('"').skip(1).step_by(2) {
                let named = join(folder, quoted);
                if let Some((file, _)) = FILES.iter().find(|(path, _)| *path == named)
                    && !out.contains(file)
                {
                    out.push(file);
                }
            }
        }
        out
    }

    /// Writes it and the files that it names into a folder, in folders as here. Returns the paths.
    ///
    /// # Errors
    /// A file exists with another content, or cannot be written.
    pub fn copy(&self, into: &Path) -> io::Result<Vec<PathBuf>> {
        let files = self.with_its_files();
        let paths: Vec<PathBuf> = files.iter().map(|file| into.join(file)).collect();
        for (file, path) in files.iter().zip(&paths) {
            let there = fs::read_to_string(path);
            if there.is_ok_and(|there| Some(there.as_str()) != text_of(file)) {
                return Err(io::Error::new(
                    io::ErrorKind::AlreadyExists,
                    format!(
                        "{} is there and differs: nothing was written",
                        path.display()
                    ),
                ));
            }
        }
        for (file, path) in files.iter().zip(&paths) {
            write(path, text_of(file).unwrap_or_default())?;
        }
        Ok(paths)
    }
}

/// Finds an input of a kind: a file, or a shipped one by its name or its path in the folder of the
/// project. Shipped ones are unpacked into the cache folder of the user. Returns the path as it is
/// where it is neither, for the sentence of the reader of the file.
///
/// # Errors
/// A name that is neither, an input of another kind, or the cache folder cannot be written.
pub fn find(kind: InputKind, given: &Path) -> Result<PathBuf, String> {
    if given.exists() {
        // What cannot be read is said by the reader of the file.
        let small = given.metadata().is_ok_and(|file| file.len() < LARGE);
        let read = small.then(|| Source::read(given).ok()).flatten();
        return match read.and_then(|source| InputKind::of(source.text())) {
            Some(other) if other != kind => Err(other.instead_of(kind, given)),
            _ => Ok(given.to_owned()),
        };
    }
    let Some(text) = given.to_str() else {
        return Ok(given.to_owned());
    };
    let mut shipped = ShippedInput::all().filter(|input| input.kind == kind);
    if let Some(input) = shipped.find(|input| input.name() == text || input.path == text) {
        let folder = unpacked().map_err(|e| {
            format!(
                "the shipped {} cannot be unpacked: {e}; set XDG_CACHE_HOME to a folder that can be written, or `fretwork cases copy {}`",
                kind.word(),
                input.name()
            )
        })?;
        return Ok(folder.join(input.path));
    }
    let mut others = ShippedInput::all();
    if let Some(other) = others.find(|input| input.name() == text || input.path == text) {
        return Err(other.kind.instead_of(kind, given));
    }
    let names = ShippedInput::all().filter(|i| i.kind == kind);
    let is_a_name = given.extension().is_none() && given.components().count() == 1;
    if !is_a_name {
        return Ok(given.to_owned());
    }
    let meant = match nearest(text, names.map(|input| input.name())) {
        Some(name) => format!(": did you mean `{name}`?"),
        None => String::new(),
    };
    Err(format!(
        "there is no file of this name, and no shipped {} of it{meant} (all: fretwork cases list)",
        kind.word()
    ))
}

/// Returns the inputs of a name, or of a path in the folder of the project: at most one of each
/// kind.
///
/// # Errors
/// Nothing that is shipped is named so.
pub fn named(name: &str) -> Result<Vec<ShippedInput>, String> {
    let is_named = |input: &ShippedInput| input.name() == name || input.path == name;
    let found: Vec<ShippedInput> = ShippedInput::all().filter(is_named).collect();
    if found.is_empty() {
        let meant = match nearest(name, ShippedInput::all().map(|input| input.name())) {
            Some(name) => format!(": did you mean `{name}`?"),
            None => String::new(),
        };
        return Err(format!(
            "nothing that is shipped is named `{name}`{meant} (all: fretwork cases list)"
        ));
    }
    Ok(found)
}

/// Text of a shipped file.
fn text_of(path: &str) -> Option<&'static str> {
    let found = FILES.iter().find(|(name, _)| *name == path);
    found.map(|&(_, text)| text)
}

/// Joins a path with `/` and one relative to it.
fn join(folder: &str, path: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|p| !p.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Folder with all shipped files, written at the first call after an installation.
fn unpacked() -> io::Result<PathBuf> {
    let mut hasher = DefaultHasher::new();
    FILES.hash(&mut hasher);
    let folder = cache_folder()?;
    // The hash distinguishes what other versions and other builds carry.
    let name = format!("{}-{:016x}", env!("CARGO_PKG_VERSION"), hasher.finish());
    let done = folder.join(&name);
    if done.is_dir() {
        return Ok(done);
    }
    // Others may do the same at the same time: the folder appears with all files at once.
    let mine = folder.join(format!("{name}.{}", std::process::id()));
    for (path, text) in FILES {
        write(&mine.join(path), text)?;
    }
    match fs::rename(&mine, &done) {
        Err(e) if !done.is_dir() => Err(e),
        _ => {
            // What is left of the slower of two.
            let _ = fs::remove_dir_all(&mine);
            Ok(done)
        }
    }
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_has_a_name_a_title_and_its_files() {
        let all: Vec<ShippedInput> = ShippedInput::all().collect();
        for kind in InputKind::ALL {
            assert!(all.iter().any(|input| input.kind == kind), "{kind:?}");
        }
        for input in &all {
            assert!(!input.title().is_empty(), "{}", input.path);
        }
        let files_of = |name: &str| {
            let input = all.iter().find(|input| input.path == name);
            input.map(ShippedInput::with_its_files).unwrap_or_default()
        };
        assert_eq!(
            files_of("cases/fretting_scar.ron"),
            ["cases/fretting_scar.ron", "cases/fretting_scar_flat.csv"]
        );
        assert_eq!(
            files_of("studies/four_laws.ron"),
            ["studies/four_laws.ron", "cases/wheel_rail_fretting.ron"]
        );
        assert_eq!(files_of("patches/wheel_on_powder.ron").len(), 2);
    }

    #[test]
    fn every_input_is_known_by_its_keys() {
        for input in ShippedInput::all() {
            assert_eq!(
                InputKind::of(input.text),
                Some(input.kind),
                "{}",
                input.path
            );
        }
        assert_eq!(InputKind::of("(name: \"a\""), None);
    }

    #[test]
    fn a_copy_is_complete_and_replaces_nothing() {
        let folder = std::env::temp_dir().join(format!("fretwork-copy-{}", std::process::id()));
        let scar = ShippedInput::all()
            .find(|input| input.name() == "fretting_scar")
            .unwrap();
        let written = scar.copy(&folder).unwrap();
        assert_eq!(written.len(), 2);
        assert_eq!(fs::read_to_string(&written[0]).unwrap(), scar.text);
        scar.copy(&folder).unwrap();
        fs::write(&written[0], "mine").unwrap();
        let e = scar.copy(&folder).unwrap_err().to_string();
        assert!(e.contains("fretting_scar.ron is there and differs"), "{e}");
        assert_eq!(fs::read_to_string(&written[0]).unwrap(), "mine");
        fs::remove_dir_all(folder).unwrap();
    }
}
