//! Lines of comments and of documentation end at 100 columns, in the folders that are listed here.
//!
//! Code is formatted by rustfmt. Code blocks, tables, headings and lines without a space to break
//! at may be longer.

use std::path::{Path, PathBuf};

const COLUMNS: usize = 100;

/// Folders and files, from the root of the repository.
const CHECKED: [&str; 17] = [
    "docs",
    "crates",
    "src",
    "python",
    "plugins",
    "tests",
    "benches",
    "cases",
    "examples",
    "fits",
    "validation",
    ".github",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "README.md",
    "SECURITY.md",
];

fn files(path: &Path, out: &mut Vec<PathBuf>) {
    if path.is_dir() {
        for entry in std::fs::read_dir(path).unwrap() {
            files(&entry.unwrap().path(), out);
        }
    } else if matches!(path.extension().and_then(|e| e.to_str()), Some("rs" | "md")) {
        out.push(path.to_owned());
    }
}

/// Returns the text of a comment, if a line of Rust is one.
fn comment(line: &str) -> Option<&str> {
    let text = line.trim_start().strip_prefix("//")?;
    Some(text.trim_start_matches(['/', '!']))
}

/// Returns the numbers of the lines that are too long and could be broken.
fn long_lines(text: &str, rust: bool) -> Vec<usize> {
    let (mut out, mut in_code) = (Vec::new(), false);
    for (number, line) in text.lines().enumerate() {
        let said = if rust { comment(line) } else { Some(line) };
        let Some(said) = said else {
            in_code = false;
            continue;
        };
        let fence = said.trim_start().starts_with("```");
        in_code ^= fence;
        let in_code = in_code || (!rust && line.starts_with("    "));
        let whole = ["| ", "|-", "#", "<", "[", "!["]
            .iter()
            .any(|s| said.trim_start().starts_with(s));
        // A line with a single word after its marker cannot be broken.
        let words = said.trim_start_matches(['-', '*', '>', ' ']);
        let breaks = words.trim_end().contains(' ');
        if line.chars().count() > COLUMNS && !in_code && !fence && !whole && breaks {
            out.push(number + 1);
        }
    }
    out
}

#[test]
fn comments_and_pages_end_at_100_columns() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    for place in CHECKED {
        files(&root.join(place), &mut all);
    }
    assert!(all.len() > 100, "{}", all.len());
    let mut wrong = Vec::new();
    for file in all {
        let text = std::fs::read_to_string(&file).unwrap();
        let rust = file.extension().is_some_and(|e| e == "rs");
        let name = file.strip_prefix(root).unwrap().display();
        wrong.extend(
            long_lines(&text, rust)
                .iter()
                .map(|line| format!("{name}:{line}")),
        );
    }
    assert!(
        wrong.is_empty(),
        "longer than 100 columns: {}",
        wrong.join(", ")
    );
}

#[test]
fn what_can_be_broken_is_found() {
    let long = "word ".repeat(21);
    let url = format!("- <https://{}>", "x".repeat(120));
    assert_eq!(
        long_lines(&format!("short\n{long}\n{url}\n| {long} |"), false),
        [2]
    );
    assert_eq!(long_lines(&format!("```\n{long}\n```\n{long}"), false), [4]);
    let rust = format!("    // {long}\nlet a = \"{long}\";\n/// {long}");
    assert_eq!(long_lines(&rust, true), [1, 3]);
}
