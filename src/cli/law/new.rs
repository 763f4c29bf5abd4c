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
    /// contact, cohesion, damage or wear
    #[arg(long)]
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
/// Sources of the SDK and the ABI, so that a law builds without the repository.
const CRATES: [(&str, &str); 7] = [
    (
        "fretwork-abi/src/lib.rs",
        include_str!("../../../plugins/abi/src/lib.rs"),
    ),
    (
        "fretwork-law/src/lib.rs",
        include_str!("../../../plugins/sdk/src/lib.rs"),
    ),
    (
        "fretwork-law/src/border.rs",
        include_str!("../../../plugins/sdk/src/border.rs"),
    ),
    (
        "fretwork-law/src/table.rs",
        include_str!("../../../plugins/sdk/src/table.rs"),
    ),
    (
        "fretwork-law/src/testing.rs",
        include_str!("../../../plugins/sdk/src/testing.rs"),
    ),
    (
        "fretwork-law/src/traits.rs",
        include_str!("../../../plugins/sdk/src/traits.rs"),
    ),
    (
        "fretwork-abi/Cargo.toml",
        "[package]\nname = \"fretwork-abi\"\nversion = \"@VERSION@\"\nedition = \"2024\"\nlicense = \"MIT OR Apache-2.0\"\n",
    ),
];

pub fn new(args: &NewArgs) -> Result<(), Failure> {
    let usage = |what: String| Err(Failure::Usage(what));
    let Some((kind, templates)) =
        Kind::from_word(&args.kind).and_then(|kind| Some((kind, kind.spec().templates?)))
    else {
        return usage(format!("--kind {}: expected {}", args.kind, Kind::words()));
    };
    // Cases write a dash where a name has an underscore.
    let name = args.name.replace('_', "-");
    let plain = name_is_valid(&name) && name.starts_with(|c: char| c.is_ascii_lowercase());
    if !plain || name.len() > 60 {
        return usage(format!(
            "`{}` is not a valid name for a law; use a-z, 0-9 and -, a letter first, at most 60",
            args.name
        ));
    }
    if built_in().names().any(|law| law == (kind, name.as_str())) {
        return usage(format!(
            "`{name}` is a shipped {kind} law, which is found before any other; choose another name"
        ));
    }
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from(&name));
    if folder.exists() {
        return usage(format!(
            "{} exists already; choose another --out",
            folder.display()
        ));
    }
    let snake = name.replace('-', "_");
    let fill = |text: &str| {
        text.replace("@NAME@", &name)
            .replace("@TYPE@", &camel(&name))
            .replace("@KINDUP@", &kind.word().to_uppercase())
            .replace("@KIND@", kind.word())
            .replace("@VERSION@", env!("CARGO_PKG_VERSION"))
    };
    let template = match args.lang {
        Language::Rust => templates.rust,
        Language::C => templates.c,
        Language::Fortran => templates.fortran,
    };
    let source = fill(template);
    let library = file_name(kind, &name);
    let here = folder.display();
    let (build, made) = match args.lang {
        Language::C => {
            write(&folder, "fretwork.h", HEADER)?;
            write(&folder, &format!("{snake}.c"), &source)?;
            let build = format!(
                "cc -O2 -std=c11 -Wall -shared -fPIC -o {here}/{library} {here}/{snake}.c -lm"
            );
            (build, folder.clone())
        }
        Language::Fortran => {
            write(&folder, "fretwork.f90", MODULE)?;
            write(&folder, "fretwork.h", HEADER)?;
            write(&folder, &format!("{snake}.f90"), &source)?;
            let build = format!(
                "gfortran -O2 -std=f2018 -Wall -shared -fPIC -J {here} -o {here}/{library} {here}/fretwork.f90 {here}/{snake}.f90"
            );
            (build, folder.clone())
        }
        Language::Rust => {
            for (file, text) in CRATES {
                write(&folder, file, &fill(text))?;
            }
            let package = |name: &str, rest: &str| {
                format!(
                    "[package]\nname = \"{name}\"\nversion = \"{}\"\nedition = \"2024\"\nlicense = \"MIT OR Apache-2.0\"\n\n{rest}",
                    env!("CARGO_PKG_VERSION")
                )
            };
            let uses_abi = "[dependencies]\nfretwork-abi = { path = \"../fretwork-abi\" }\n";
            write(
                &folder,
                "fretwork-law/Cargo.toml",
                &package("fretwork-law", uses_abi),
            )?;
            let own = "[workspace]\n\n[lib]\ncrate-type = [\"cdylib\", \"rlib\"]\n\n[dependencies]\nfretwork-law = { path = \"fretwork-law\" }\n";
            write(
                &folder,
                "Cargo.toml",
                &package(&format!("fretwork-{kind}-{name}"), own),
            )?;
            write(&folder, "src/lib.rs", &source)?;
            let build = format!("cargo build --release --manifest-path {here}/Cargo.toml");
            (build, folder.join("target/release"))
        }
    };
    inform(&format!(
        "{here} holds the {kind} law `{name}`; fill in the two functions marked (1) and (2)\n\
         build    {build}\n\
         certify  fretwork law certify {}\n\
         run      fretwork run CASE --plugin-path {} --set interfaces.INTERFACE.{kind}={name}",
        made.join(&library).display(),
        made.display(),
    ));
    Ok(())
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
