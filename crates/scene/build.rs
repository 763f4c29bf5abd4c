//! Lists `materials/*.ron` for `src/shipped_materials.rs`, so that no file can be forgotten.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let variable = |name| env::var_os(name).map(PathBuf::from).unwrap_or_default();
    let folder = variable("CARGO_MANIFEST_DIR").join("../../materials");
    println!("cargo::rerun-if-changed={}", folder.display());
    let entries: io::Result<Vec<_>> = fs::read_dir(&folder)?.collect();
    let mut files: Vec<PathBuf> = entries?.into_iter().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|end| end == "ron"));
    // Folders list their files in any order, and two builds are to give the same bytes.
    files.sort();
    let mut list = "&[\n".to_owned();
    for file in files {
        let name = file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let file = file.canonicalize()?;
        let _ = writeln!(list, "    ({name:?}, include_str!({file:?})),");
    }
    list += "]\n";
    fs::write(variable("OUT_DIR").join("shipped_materials.rs"), list)
}
