//! Files of a release: all name the version of the program.

use super::pages::{read, root};

/// The text after a key at the start of a line, without quotes.
fn value<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let line = text
        .lines()
        .find_map(|line| line.trim_start().strip_prefix(key))?;
    Some(line.trim().trim_end_matches(',').trim_matches('"'))
}

#[test]
fn all_files_name_the_version_of_the_program() {
    for (file, key) in [
        ("Cargo.toml", "version ="),
        ("CITATION.cff", "version:"),
        ("conda/recipe.yaml", "version:"),
        ("editors/vscode/package.json", "\"version\":"),
    ] {
        let text = read(&root().join(file));
        assert_eq!(value(&text, key), Some(env!("CARGO_PKG_VERSION")), "{file}");
    }
    let page = read(&root().join("docs/install.md"));
    let wheel = format!("pyfretwork-{}-", env!("CARGO_PKG_VERSION"));
    assert!(page.contains(&wheel), "docs/install.md has no {wheel}");
}
