//! The glossary explains terms that other pages use.

use super::{pages_for_users, read, root};

/// The terms of the rows of the tables of a page: what is between commas in the first column,
/// without what is in parentheses.
fn terms(page: &str) -> Vec<String> {
    let rows = page.lines().filter_map(|l| l.strip_prefix("| "));
    let first = rows.filter_map(|row| row.split(" |").next());
    let first = first.filter(|cell| *cell != "term");
    let split = first.flat_map(|cell| cell.split(" (").next().unwrap_or(cell).split(", "));
    split.map(|term| term.trim().to_lowercase()).collect()
}

/// A text in small letters, with one space between words.
fn plain(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").to_lowercase()
}

#[test]
fn every_term_of_the_glossary_is_used_on_another_page() {
    let glossary = root().join("docs/glossary.md");
    let others = pages_for_users().into_iter().filter(|p| *p != glossary);
    let others: String = others.map(|page| plain(&read(&page))).collect();
    let all = terms(&read(&glossary));
    assert!(all.len() > 80, "{}", all.len());
    let unused: Vec<&String> = all.iter().filter(|term| !others.contains(*term)).collect();
    assert!(
        unused.is_empty(),
        "no page uses these terms; use the words of the pages, or delete them: {unused:?}"
    );
}

#[test]
fn terms_are_those_of_the_first_column() {
    let page = "| term | symbol |\n|---|---|\n| Slip, stick (both) | s |\ntext\n";
    assert_eq!(terms(page), ["slip", "stick"]);
}
