//! The pages of `docs/` and the README: what they show of the program is what it prints, tables of
//! measured numbers name their version and command, and links lead somewhere.
//!
//! `FRETWORK_WRITE_PAGES=1` writes the parts that the program makes in place of comparing them;
//! `FRETWORK_WRITE_PAGES=all` also those whose commands take long.

#[cfg(unix)]
mod commands;
mod console;
mod glossary;
mod links;
mod measured;
mod unrun;

use std::path::{Path, PathBuf};

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub(crate) fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// What a test does with the parts of a page that the program makes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Compare,
    Write,
    /// Also commands that take long.
    WriteAll,
}

fn mode() -> Mode {
    match std::env::var("FRETWORK_WRITE_PAGES").as_deref() {
        Err(_) => Mode::Compare,
        Ok("all") => Mode::WriteAll,
        Ok(_) => Mode::Write,
    }
}

/// Compares a page with what the program makes of it, or writes it. `test` is the name of the test.
///
/// # Errors
/// How an old page differs.
pub(crate) fn settle(path: &Path, made: &str, test: &str) -> Result<(), String> {
    let page = read(path);
    if page == made {
        return Ok(());
    }
    if mode() != Mode::Compare {
        std::fs::write(path, made).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        return Ok(());
    }
    let missing: Vec<&str> = made.lines().filter(|l| !has_line(&page, l)).collect();
    let gone: Vec<&str> = page.lines().filter(|l| !has_line(made, l)).collect();
    Err(format!(
        "{} is old; write it with FRETWORK_WRITE_PAGES=1 cargo test --test program {test}; it lacks \
         {missing:#?} and still has {gone:#?}",
        path.display()
    ))
}

fn has_line(text: &str, line: &str) -> bool {
    text.lines().any(|l| l == line)
}

/// All pages: README and those of `docs/`.
pub(crate) fn pages() -> Vec<PathBuf> {
    let mut out = vec![root().join("README.md")];
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "md") {
                out.push(path);
            }
        }
    }
    out.sort();
    out
}

/// Pages of the outputs: `docs/outputs.md`, and those of its folder.
pub(crate) fn output_pages() -> Vec<PathBuf> {
    let (page, folder) = (root().join("docs/outputs.md"), root().join("docs/outputs"));
    let mut all = pages();
    all.retain(|path| *path == page || path.starts_with(&folder));
    all
}

/// Pages of the parts of `docs/SUMMARY.md` that are for users, and the README.
fn pages_for_users() -> Vec<PathBuf> {
    let summary = read(&root().join("docs/SUMMARY.md"));
    let (users, _) = summary.split_once("\n# For developers\n").unwrap();
    let listed = links::targets(users).map(|l| root().join("docs").join(l));
    listed.chain([root().join("README.md")]).collect()
}

/// The lines of a page, each with whether it is in a block of code; fences count as code.
fn lines_with_code(page: &str) -> impl Iterator<Item = (&str, bool)> {
    let mut open = false;
    page.lines().map(move |line| {
        let fence = line.trim_start().starts_with("```");
        let code = open || fence;
        open ^= fence;
        (line, code)
    })
}

/// Versions that the changelog names.
fn versions() -> Vec<String> {
    let text = read(&root().join("CHANGELOG.md"));
    let headings = text.lines().filter_map(|l| l.strip_prefix("## "));
    let first = headings.filter_map(|h| h.split_whitespace().next());
    let numbered = first.filter(|v| v.starts_with(|c: char| c.is_ascii_digit()));
    numbered.map(str::to_owned).collect()
}
