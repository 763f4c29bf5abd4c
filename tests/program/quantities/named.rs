//! No source that presents results names a quantity, so adding one changes only its observer.
//!
//! Compared are whole string literals, also as names of files, with the paths of the results that
//! the shipped observers declare, and with their last words where these are long enough not to
//! occur for other reasons. What describes the run itself, such as its wall time, may be named.

use super::page::declared;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders of sources that present results.
const SHOWS: [&str; 6] = [
    "crates/store/src",
    "crates/view/src",
    "crates/experiments/src",
    "src",
    "python/src",
    "python/fretwork",
];

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|e| e.to_str()) {
            _ if path.is_dir() => sources(&path, out),
            _ if path.to_string_lossy().ends_with("tests.rs") => {}
            Some("rs" | "py") => out.push(path),
            _ => {}
        }
    }
}

/// Strings in the code of a source, without comments and its tests at the end, and without the
/// extension of a file.
fn literals(text: &str) -> BTreeSet<&str> {
    let code = text.split("#[cfg(test)]\nmod tests {").next();
    let code = code.unwrap_or(text);
    let lines = code.lines().filter(|l| {
        let line = l.trim_start();
        !line.starts_with("//") && !line.starts_with('#')
    });
    lines
        .flat_map(|l| l.split('"').skip(1).step_by(2))
        .map(|l| {
            l.strip_suffix(".png")
                .or(l.strip_suffix(".csv"))
                .unwrap_or(l)
        })
        .collect()
}

#[test]
fn what_shows_results_names_no_quantity() {
    let mut names = BTreeSet::new();
    for (path, ..) in declared().into_iter().filter(|d| !d.3) {
        let last = path.rsplit('.').next().unwrap().to_owned();
        // Short words occur for other reasons too.
        if last.contains('_') && last.len() > 11 {
            names.insert(format!("/{}", path.replace('.', "/")));
            names.insert(last);
        }
        if path.contains('.') {
            names.insert(path);
        }
    }
    assert!(
        names.len() > 100 && names.contains("wear.Qs"),
        "{}",
        names.len()
    );
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    SHOWS
        .iter()
        .for_each(|folder| sources(&root.join(folder), &mut all));
    let mut found = Vec::new();
    for path in all {
        let short = path.strip_prefix(root).unwrap().display().to_string();
        let text = std::fs::read_to_string(&path).unwrap();
        let named = literals(&text).into_iter().filter(|l| names.contains(*l));
        let named: Vec<&str> = named.collect();
        if !named.is_empty() {
            found.push(format!("{short}: {}", named.join(", ")));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn code_after_a_module_of_tests_is_compared() {
    let text = "#[cfg(test)]\nmod tests;\nlet a = \"one\";\nlet b = \"two.png\";\n// \"three\"\n\
                #[cfg(test)]\nmod tests {\n\"four\"\n}";
    assert_eq!(literals(text), BTreeSet::from(["one", "two"]));
}
