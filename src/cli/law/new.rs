//! `fretwork law new`: a template for a law that builds and passes certification as generated.

use super::super::Failure;
use super::super::output::inform;
use crate::laws::Kind;
use crate::laws::search::{file_name, name_is_valid};
use crate::shipped::built_in;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

pub const EXAMPLES: &str = "Examples:
  fretwork law new my-law --kind damage --lang c
  fretwork law new my-law --kind cohesion --lang rust --out laws/my-law";

#[derive(Args, Debug)]
pub struct NewArgs {
    /// Name of the law: a-z, 0-9 and -, e.g. my-law
    name: String,
    #[arg(long, help = Kind::words())]
    kind: String,
    /// Language
    #[arg(long, value_enum)]
    lang: Language,
    /// Folder to create (by default the law's name)
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Language {
    Rust,
    C,
    Fortran,
}

const HEADER: &str = include_str!("../../../plugins/abi/include/fretwork.h");
const MODULE: &str = include_str!("templates/fretwork.f90");
macro_rules! sources {
    ($($package:literal, $folder:literal: $($file:literal)*;)*) => {
        &[$($((
            concat!($package, "/", $file),
            include_str!(concat!("../../../plugins/", $folder, "/", $file)),
        )),*),*]
    };
}

/// Sources of the SDK and the ABI, with which a law builds without the repository.
const CRATES: &[(&str, &str)] = sources! {
    "fretwork-abi", "abi": "src/lib.rs";
    "fretwork-law", "sdk": "README.md" "src/lib.rs" "src/ffi.rs" "src/grid.rs" "src/intact.rs" "src/output.rs" "src/site.rs"
        "src/spring.rs" "src/table.rs" "src/testing.rs" "src/traits.rs";
};

pub fn new(args: &NewArgs) -> Result<(), Failure> {
    let Some((kind, templates)) =
        Kind::from_word(&args.kind).and_then(|kind| Some((kind, kind.spec().templates?)))
    else {
        let message = format!("--kind {}: expected {}", args.kind, Kind::words());
        return Err(Failure::Usage(message));
    };
    let name = law_name(args, kind)?;
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from(&name));
    if folder.exists() {
        return Err(Failure::Usage(format!(
            "{} exists already; choose another --out",
            folder.display()
        )));
    }
    let template = match args.lang {
        Language::Rust => templates.rust.to_owned(),
        Language::C => templates.whole_c(),
        Language::Fortran => templates.whole_fortran(),
    };
    let new_law = NewLaw { kind, name, folder };
    let (build, made) = new_law.write(args.lang, &template)?;
    let NewLaw { name, folder, .. } = &new_law;
    inform(&format!(
        "{} holds the {kind} law `{name}`; fill in the two functions marked (1) and (2)\n\
         build    {build}\n\
         certify  fretwork law certify {}\n\
         run      fretwork run CASE --plugin-path {} --set interfaces.INTERFACE.{kind}={name}",
        folder.display(),
        made.join(new_law.library()).display(),
        made.display(),
    ));
    Ok(())
}

/// Returns the name of the law in the form used in cases. Invalid and existing names are rejected.
fn law_name(args: &NewArgs, kind: Kind) -> Result<String, Failure> {
    // Cases use a dash for each underscore of a name.
    let name = args.name.replace('_', "-");
    let plain = name_is_valid(&name) && name.starts_with(|c: char| c.is_ascii_lowercase());
    if !plain || name.len() > 60 {
        return Err(Failure::Usage(format!(
            "`{}` is not a valid name for a law; use a-z, 0-9 and -, a letter first, at most 60",
            args.name
        )));
    }
    if built_in().names().any(|law| law == (kind, name.as_str())) {
        return Err(Failure::Usage(format!(
            "`{name}` is a shipped {kind} law, which is found before any other; choose another name"
        )));
    }
    Ok(name)
}

/// Name, kind and folder of a new law.
struct NewLaw {
    kind: Kind,
    name: String,
    folder: PathBuf,
}

impl NewLaw {
    /// File name of the built library.
    fn library(&self) -> String {
        file_name(self.kind, &self.name)
    }

    /// Fills the place-holders of a template.
    fn fill(&self, text: &str) -> String {
        text.replace("@NAME@", &self.name)
            .replace("@TYPE@", &camel(&self.name))
            .replace("@KINDUP@", &self.kind.word().to_uppercase())
            .replace("@KIND@", self.kind.word())
            .replace("@VERSION@", env!("CARGO_PKG_VERSION"))
    }

    /// Writes the files of the law. Returns the command that builds it, and the folder of the built
    /// library.
    fn write(&self, language: Language, template: &str) -> Result<(String, PathBuf), Failure> {
        let (folder, here) = (&self.folder, self.folder.display());
        let (source, library) = (self.fill(template), self.library());
        let snake = self.name.replace('-', "_");
        match language {
            Language::C => {
                write(folder, "fretwork.h", HEADER)?;
                write(folder, &format!("{snake}.c"), &source)?;
                let build = format!(
                    "cc -O2 -std=c11 -Wall -shared -fPIC -o {here}/{library} {here}/{snake}.c -lm"
                );
                Ok((build, folder.clone()))
            }
            Language::Fortran => {
                write(folder, "fretwork.f90", MODULE)?;
                write(folder, "fretwork.h", HEADER)?;
                write(folder, &format!("{snake}.f90"), &source)?;
                let build = format!(
                    "gfortran -O2 -std=f2018 -Wall -shared -fPIC -J {here} -o {here}/{library} {here}/fretwork.f90 {here}/{snake}.f90"
                );
                Ok((build, folder.clone()))
            }
            Language::Rust => {
                self.write_crates(&source)?;
                let build = format!("cargo build --release --manifest-path {here}/Cargo.toml");
                Ok((build, folder.join("target/release")))
            }
        }
    }

    /// Writes the law as a crate, beside the crates of the SDK and the ABI.
    fn write_crates(&self, source: &str) -> Result<(), Failure> {
        let folder = &self.folder;
        for (file, text) in CRATES {
            write(folder, file, &self.fill(text))?;
        }
        let package = |name: &str, rest: &str| {
            format!(
                "[package]\nname = \"{name}\"\nversion = \"{}\"\nedition = \"2024\"\nlicense = \"MIT OR Apache-2.0\"\n\n{rest}",
                env!("CARGO_PKG_VERSION")
            )
        };
        write(
            folder,
            "fretwork-abi/Cargo.toml",
            &package("fretwork-abi", ""),
        )?;
        let uses_abi = "[dependencies]\nfretwork-abi = { path = \"../fretwork-abi\" }\n";
        let sdk = package("fretwork-law", uses_abi);
        write(folder, "fretwork-law/Cargo.toml", &sdk)?;
        let own = "[workspace]\n\n[lib]\ncrate-type = [\"cdylib\", \"rlib\"]\n\n[dependencies]\nfretwork-law = { path = \"fretwork-law\" }\n";
        let law = package(&format!("fretwork-{}-{}", self.kind, self.name), own);
        write(folder, "Cargo.toml", &law)?;
        write(folder, "src/lib.rs", source)
    }
}

fn camel(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters
            .next()
            .map(|c| c.to_ascii_uppercase().to_string() + letters.as_str())
            .unwrap_or_default()
    };
    name.split('-').map(capital).collect()
}

fn write(folder: &Path, file: &str, text: &str) -> Result<(), Failure> {
    let path = folder.join(file);
    let fail = |e: std::io::Error| {
        Failure::Failed(format!(
            "cannot write {}: {e}; choose another --out",
            path.display()
        ))
    };
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(fail)?;
    }
    std::fs::write(&path, text).map_err(fail)
}
