//! Links between pages, and pages that sources and cases name.

use super::{lines_with_code, pages, pages_for_users, read, root};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The targets of the links of a text.
pub(super) fn targets(text: &str) -> impl Iterator<Item = &str> {
    let rest = text.split("](").skip(1);
    rest.filter_map(|rest| rest.split([')', '"']).next())
        .map(str::trim)
}

/// The text of a page without its blocks of code, and without what is between backticks.
fn without_code(page: &str) -> String {
    let lines = lines_with_code(page).filter(|(_, code)| !code);
    let text = lines.map(|(line, _)| line).collect::<Vec<_>>().join("\n");
    text.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// The pages to which a page links.
fn linked(page: &Path) -> Vec<PathBuf> {
    let text = without_code(&read(page));
    let files = targets(&text).filter_map(|link| link.split('#').next());
    let files = files.filter(|f| f.ends_with(".md") && !f.contains("://"));
    let files = files.filter_map(|f| page.parent()?.join(f).canonicalize().ok());
    files.collect()
}

/// The anchors of the headings of a page, as GitHub and the book make them.
fn anchors(page: &str) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let headings = lines_with_code(page).filter(|(line, code)| !code && line.starts_with('#'));
    let made = headings.map(|(line, _)| {
        let text = line.trim_start_matches('#').trim().to_lowercase();
        let kept = text
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let anchor = kept.collect::<String>().replace(' ', "-");
        let count = seen.entry(anchor.clone()).or_default();
        *count += 1;
        match *count {
            1 => anchor,
            n => format!("{anchor}-{}", n - 1),
        }
    });
    made.collect()
}

/// Files of a folder whose names end so.
fn files(folder: &Path, endings: &[&str], out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        let name = entry.file_name().into_string().unwrap_or_default();
        if path.is_dir() && !path.is_symlink() && name != "target" {
            files(&path, endings, out);
        } else if endings.iter().any(|e| name.ends_with(e)) {
            out.push(path);
        }
    }
}

/// Why a link of a page leads nowhere.
fn broken(page: &Path, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = match file {
        "" => page.to_owned(),
        _ => page.parent()?.join(file),
    };
    if !target.exists() {
        return Some(format!("{}: {link}: no such file", page.display()));
    }
    let known = anchor.is_empty() || anchors(&read(&target)).iter().any(|a| a == anchor);
    (!known).then(|| format!("{}: {link}: no such heading", page.display()))
}

#[test]
fn links_lead_somewhere() {
    let mut all = pages();
    all.push(root().join("CHANGELOG.md"));
    for folder in ["cases", "validation", "python"] {
        files(&root().join(folder), &["README.md"], &mut all);
    }
    let (mut wrong, mut found) = (Vec::new(), 0);
    for page in all {
        for link in targets(&without_code(&read(&page))) {
            found += 1;
            wrong.extend(broken(&page, link));
        }
    }
    assert!(found > 300, "{found}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_summary_lists_every_page_once() {
    let docs = root().join("docs");
    let summary = read(&docs.join("SUMMARY.md"));
    let listed: Vec<&str> = targets(&summary).collect();
    let in_docs = pages().into_iter().filter(|p| p.starts_with(&docs));
    for page in in_docs.filter(|p| !p.ends_with("SUMMARY.md")) {
        let name = page.strip_prefix(&docs).unwrap().to_str().unwrap();
        let times = listed.iter().filter(|l| **l == name).count();
        assert_eq!(times, 1, "docs/SUMMARY.md has {name} {times} times");
    }
}

#[test]
fn every_page_for_users_is_two_clicks_from_the_index() {
    let docs = root().join("docs");
    let index = docs.join("index.md");
    let near = linked(&index);
    let mut reached: BTreeSet<PathBuf> = near.iter().flat_map(|page| linked(page)).collect();
    reached.extend(near);
    let listed = pages_for_users().into_iter();
    let listed = listed.filter(|page| page.starts_with(&docs) && *page != index);
    let far: Vec<PathBuf> = listed
        .filter(|page| !reached.contains(&page.canonicalize().unwrap()))
        .collect();
    assert!(reached.len() > 50, "{}", reached.len());
    assert!(
        far.is_empty(),
        "docs/index.md, and the pages that it links to, have no link to {far:#?}"
    );
}

/// The README and the index send a reader with one question to the same page.
#[test]
fn the_index_has_the_pages_of_the_readme() {
    let users = pages_for_users().into_iter();
    let users: Vec<PathBuf> = users.map(|page| page.canonicalize().unwrap()).collect();
    let index = linked(&root().join("docs/index.md"));
    let mut readme = linked(&root().join("README.md"));
    readme.retain(|page| users.contains(page) && !page.ends_with("index.md"));
    assert!(readme.len() > 20, "{}", readme.len());
    readme.retain(|page| !index.contains(page));
    assert!(
        readme.is_empty(),
        "docs/index.md has no link to {readme:#?}"
    );
}

/// Code and tables count as words, so that a page can be looked through.
#[test]
fn no_page_for_users_has_more_than_2500_words() {
    let mut long = Vec::new();
    for page in pages_for_users() {
        let words = read(&page).split_whitespace().count();
        if words > 2500 {
            long.push(format!("{}: {words}", page.display()));
        }
    }
    assert!(long.is_empty(), "divide these pages by question: {long:#?}");
}

/// The book has the files outside `docs` to which its pages link.
#[test]
fn the_book_copies_what_its_pages_link_to() {
    let root = root().canonicalize().unwrap();
    let script = read(&root.join("docs/book.sh"));
    let (_, list) = script.split_once("for folder in ").unwrap();
    let (list, _) = list.split_once(';').unwrap();
    let copied = list.split_whitespace().chain(["docs"]);
    let copied: Vec<PathBuf> = copied.map(|folder| root.join(folder)).collect();
    for page in pages()
        .into_iter()
        .filter(|page| !page.ends_with("README.md"))
    {
        for link in targets(&without_code(&read(&page))) {
            let file = link.split('#').next().unwrap_or(link);
            let Ok(target) = page.parent().unwrap().join(file).canonicalize() else {
                continue;
            };
            let there = copied.iter().any(|folder| target.starts_with(folder));
            assert!(
                there,
                "{}: docs/book.sh does not copy {link}",
                page.display()
            );
        }
    }
}

/// Pages that comments of cases and sources, and messages of the program, name.
#[test]
fn pages_that_sources_name_are_there() {
    let mut all = Vec::new();
    let endings = [
        ".rs", ".ron", ".py", ".sh", ".toml", ".yml", ".c", ".h", ".f90",
    ];
    for folder in [
        "cases",
        "crates",
        "docs",
        "examples",
        "fits",
        "materials",
        "patches",
        "plugins",
        "python",
        "src",
        "studies",
        "tests",
        "validation",
    ] {
        files(&root().join(folder), &endings, &mut all);
    }
    let mut found = 0;
    for file in all {
        let text = read(&file);
        let of_path = |c: char| c.is_ascii_alphanumeric() || "_-/.".contains(c);
        for word in text.split(|c| !of_path(c)) {
            let word = word.trim_end_matches('.');
            if word.starts_with("docs/") && word.ends_with(".md") {
                found += 1;
                let there = root().join(word).exists();
                assert!(there, "{} names {word}", file.display());
            }
        }
    }
    assert!(found > 30, "{found}");
}

#[test]
fn headings_have_the_anchors_of_the_book() {
    let page = "# What a run says, of its `own` error\n```\n# no\n```\n## A\n## A\n";
    assert_eq!(
        anchors(page),
        ["what-a-run-says-of-its-own-error", "a", "a-1"]
    );
}
