//! Tables of measured numbers name the version of the program and the command, in one form:
//!
//! ```text
//! Measured with version 0.1.0: `command`.
//! ```

use super::{lines_with_code, pages, pages_for_users, read, root, versions};

const FORM: &str = "Measured with version ";

/// Pages of `docs/`, and folders of them, whose tables have numbers that are not measured: defaults
/// and bounds of the program, and dimensions that standards give.
const GIVEN: [&str; 5] = [
    "case_format",
    "case_format.md",
    "outputs",
    "outputs.md",
    "wear/profiles.md",
];

/// The text of a line without what is between backticks.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect()
}

/// Whether a row of a table has a number with decimals or an interval.
fn has_number(row: &str) -> bool {
    let text = without_code(row);
    let bytes = text.as_bytes();
    let decimal = |w: &[u8]| w[0].is_ascii_digit() && w[1] == b'.' && w[2].is_ascii_digit();
    text.contains('±') || bytes.windows(3).any(decimal)
}

/// The rows with numbers of a page.
fn rows(page: &str) -> usize {
    let text = lines_with_code(page).filter(|(_, code)| !code);
    let rows = text.filter(|(line, _)| line.starts_with('|'));
    rows.filter(|(row, _)| has_number(row)).count()
}

/// The versions and commands that a page names as the origin of its numbers.
fn origins(page: &str) -> Vec<Result<(String, String), String>> {
    let text = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let named = text.split(FORM).skip(1).map(|rest| {
        let parts = rest.split_once(": `").and_then(|(version, rest)| {
            let (command, _) = rest.split_once('`')?;
            Some((version.to_owned(), command.to_owned()))
        });
        parts.ok_or_else(|| format!("{FORM}{}", &rest.chars().take(40).collect::<String>()))
    });
    named.collect()
}

#[test]
fn tables_of_numbers_name_their_version_and_command() {
    let mut without = Vec::new();
    for path in pages_for_users() {
        let page = read(&path);
        let shown = page.lines().any(|l| l == "```console");
        let docs = root().join("docs");
        let given = GIVEN.iter().any(|g| path.starts_with(docs.join(g)));
        if rows(&page) > 0 && origins(&page).is_empty() && !shown && !given {
            without.push(format!("{} ({} rows)", path.display(), rows(&page)));
        }
    }
    assert!(
        without.is_empty(),
        "tables with numbers, and neither a line `{FORM}...` nor a console block: {without:#?}"
    );
}

#[test]
fn versions_of_numbers_are_those_of_the_changelog() {
    let known = versions();
    let mut found = 0;
    for path in pages() {
        for origin in origins(&read(&path)) {
            let (version, command) = origin.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            assert!(known.contains(&version), "{}: {version}", path.display());
            assert!(!command.is_empty(), "{}", path.display());
            found += 1;
        }
    }
    assert!(found > 5, "{found}");
}

#[test]
fn numbers_and_their_origins_are_found() {
    assert!(has_number("| a | 0.5 |") && has_number("| 3 ± 1 |"));
    assert!(!has_number("| `0.5` | 3 | A.1 | 1. |"));
    assert_eq!(rows("| 0.5 |\n```\n| 0.5 |\n```\n| 1 |\n0.5\n"), 1);
    let named = origins("x\nMeasured with version\n0.1.0: `a\nb`.\nMeasured with version 2, c\n");
    assert_eq!(named[0], Ok(("0.1.0".to_owned(), "a b".to_owned())));
    assert!(named[1].is_err());
}
