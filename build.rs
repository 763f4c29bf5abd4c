//! Lists the shipped cases, studies, fits and patches, which the program carries with it.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

/// Folders whose files are carried.
const FOLDERS: [&str; 7] = [
    "cases",
    "cases/large",
    "studies",
    "fits",
    "fits/cases",
    "patches",
    "patches/profiles",
];
/// Endings of files that are inputs.
const INPUTS: [&str; 2] = ["ron", "csv"];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let root = env::var("CARGO_MANIFEST_DIR")?;
    let mut paths = Vec::new();
    for folder in FOLDERS {
        println!("cargo::rerun-if-changed={folder}");
        for entry in fs::read_dir(Path::new(&root).join(folder))? {
            let path = entry?.path();
            let ending = path
                .extension()
                .and_then(|e| e.to_str())
                .unwrap_or_default();
            if INPUTS.contains(&ending) {
                let name = path
                    .file_name()
                    .and_then(|n| n.to_str())
                    .unwrap_or_default();
                paths.push((format!("{folder}/{name}"), path));
            }
        }
    }
    paths.sort();
    let mut list = String::from("&[\n");
    for (name, path) in paths {
        writeln!(
            list,
            "    ({name:?}, include_str!({:?})),",
            path.display().to_string()
        )?;
    }
    list += "]\n";
    let out = Path::new(&env::var("OUT_DIR")?).join("shipped_inputs.rs");
    Ok(fs::write(out, list)?)
}
