//! Links between pages, and pages that sources and cases name.

use super::{lines_with_code, pages, read, root};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The targets of the links of a text.
pub(super) fn targets(text: &str) -> impl Iterator<Item = &str> {
    let rest = text.split("](").skip(1);
    rest.filter_map(|rest| rest.split([')', '"']).next())
        .map(str::trim)
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
        let text = read(&page);
        let text = lines_with_code(&text).filter(|(_, code)| !code);
        let text = text.map(|(line, _)| line).collect::<Vec<_>>().join("\n");
        // What is between backticks is code.
        let text = text.split('`').step_by(2).collect::<Vec<_>>().join(" ");
        for link in targets(&text) {
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
