//! Lines of comments and of documentation end at 100 columns, in the folders that are listed here.
//!
//! Code is formatted by rustfmt. Code blocks, tables, headings, comments beside code and lines
//! without a space to break at may be longer.

use std::path::{Path, PathBuf};

const COLUMNS: usize = 100;

/// Folders and files, from the root of the repository.
const CHECKED: [&str; 20] = [
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
    "studies",
    "validation",
    ".ci",
    ".github",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "Cargo.toml",
    "README.md",
    "SECURITY.md",
];

/// Files whose lines stay as they are.
const EXEMPT: [(&str, &str); 2] = [
    ("tests/certify/1.0/fretwork.h", "a published version"),
    (
        "crates/view/assets/uPlot.min.js",
        "the file of another project",
    ),
];

/// How comments are written, or that all lines are text.
#[derive(Clone, Copy, PartialEq)]
enum Text {
    Page,
    Rust,
    /// Comments begin with two slashes.
    Slashes,
    /// Comments begin with a hash sign.
    Hash,
    /// Comments begin with a hash sign, except between triple quotes.
    Python,
    /// Comments begin with `/*`, and their further lines with a star.
    Stars,
    /// Comments begin with an exclamation mark.
    Fortran,
}

impl Text {
    fn of(path: &Path) -> Option<Self> {
        Some(match path.extension().and_then(|e| e.to_str()) {
            Some("md") => Self::Page,
            Some("rs") => Self::Rust,
            Some("ron" | "js" | "mjs") => Self::Slashes,
            Some("toml" | "sh" | "yml") => Self::Hash,
            Some("py" | "pyi") => Self::Python,
            Some("h" | "c") => Self::Stars,
            Some("f90") => Self::Fortran,
            None if path.parent()?.file_name()? == ".ci" => {
                let text = std::fs::read_to_string(path).ok()?;
                let first = text.lines().next()?;
                if first.contains("python") {
                    Self::Python
                } else {
                    Self::Hash
                }
            }
            _ => return None,
        })
    }

    /// Returns the text of a line, if it is a comment or one of a page.
    fn said(self, line: &str) -> Option<&str> {
        let start = line.trim_start();
        match self {
            Self::Page => Some(line),
            Self::Rust | Self::Slashes => {
                let text = start.strip_prefix("//")?;
                Some(text.trim_start_matches(['/', '!']))
            }
            Self::Hash | Self::Python => Some(start.strip_prefix('#')?.trim_start_matches(':')),
            Self::Stars => start.strip_prefix("/*").or(start.strip_prefix("* ")),
            Self::Fortran => start.strip_prefix('!'),
        }
    }

    /// Returns whether a text is code, or a table, in a comment or a page.
    fn is_indented(self, line: &str, said: &str) -> bool {
        match self {
            Self::Page => line.starts_with("    "),
            Self::Rust | Self::Stars => false,
            _ => said.starts_with("   "),
        }
    }
}

fn files(path: &Path, out: &mut Vec<(PathBuf, Text)>) {
    if path.is_dir() && !path.is_symlink() {
        for entry in std::fs::read_dir(path).unwrap() {
            files(&entry.unwrap().path(), out);
        }
    } else if let Some(kind) = Text::of(path) {
        out.push((path.to_owned(), kind));
    }
}

/// Returns the numbers of the lines that are too long and could be broken.
fn long_lines(text: &str, kind: Text) -> Vec<usize> {
    let (mut out, mut in_code, mut in_quotes) = (Vec::new(), false, false);
    for (number, line) in text.lines().enumerate() {
        let quotes = line.matches("\"\"\"").count() + line.matches("'''").count();
        let quoted = kind == Text::Python && (in_quotes || quotes > 0);
        in_quotes ^= quotes % 2 == 1;
        let Some(said) = kind.said(line).filter(|_| !quoted) else {
            in_code = false;
            continue;
        };
        let fence = said.trim_start().starts_with("```");
        in_code ^= fence;
        let in_code = in_code || kind.is_indented(line, said);
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
    for (file, kind) in all {
        let name = file.strip_prefix(root).unwrap();
        if EXEMPT.iter().any(|(exempt, _)| name == Path::new(exempt)) {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        wrong.extend(
            long_lines(&text, kind)
                .iter()
                .map(|line| format!("{}:{line}", name.display())),
        );
    }
    for (name, _) in EXEMPT {
        assert!(root.join(name).is_file(), "{name} is missing");
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
    let found = |text: String, kind| long_lines(&text, kind);
    let page = format!("short\n{long}\n{url}\n| {long} |");
    assert_eq!(found(page, Text::Page), [2]);
    let code = format!("```\n{long}\n```\n{long}");
    assert_eq!(found(code, Text::Page), [4]);
    let rust = format!("    // {long}\nlet a = \"{long}\";\n/// {long}");
    assert_eq!(found(rust, Text::Rust), [1, 3]);
    let case = format!("// {long}\n//   {long}\na: \"{long}\", // {long}");
    assert_eq!(found(case, Text::Slashes), [1]);
    let python = format!("#: {long}\n\"\"\"\n# {long}\n\"\"\"\n# {long}");
    assert_eq!(found(python, Text::Python), [1, 5]);
    let header = format!("/* {long}\n * {long} */\nint a; /* {long} */");
    assert_eq!(found(header, Text::Stars), [1, 2]);
}
