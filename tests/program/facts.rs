//! Statements of pages about the program, and of its help about files, are compared with the
//! program and the files.

use crate::pages::{pages, read, root};
use fretwork::laws::{Kind, LawLocation};
use fretwork::shipped::built_in;
use fretwork::shipped::search_path;
use std::process::Command;

/// Returns the output of a call of the program.
fn answer(words: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    let output = command.args(words).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{words:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Subcommands of a command, as its help lists them.
fn subcommands(help: &str) -> Vec<String> {
    let list = help.split("\nCommands:\n").nth(1).unwrap_or_default();
    let lines = list.lines().take_while(|l| l.starts_with("  "));
    let names = lines.filter_map(|l| l.split_whitespace().next());
    names.filter(|n| *n != "help").map(str::to_owned).collect()
}

/// The help of every command.
fn helps() -> Vec<(String, String)> {
    let mut out = Vec::new();
    let mut open: Vec<Vec<String>> = vec![Vec::new()];
    while let Some(words) = open.pop() {
        let call: Vec<&str> = words.iter().map(String::as_str).chain(["--help"]).collect();
        let help = answer(&call);
        for name in subcommands(&help) {
            open.push([&words[..], &[name]].concat());
        }
        out.push((words.join(" "), help));
    }
    out
}

/// Returns the words that are paths of this repository.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let of_path = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    let words = text
        .split(move |c| !of_path(c))
        .map(|w| w.trim_end_matches('.'));
    let folders = [
        "cases/",
        "studies/",
        "fits/",
        "patches/",
        "docs/",
        "tests/fclib/",
        "materials/",
        "examples/",
    ];
    words.filter(move |w| {
        folders
            .iter()
            .any(|f| w.starts_with(f) && w.len() > f.len())
    })
}

#[test]
fn helps_name_files_that_are_there_and_every_kind_of_law() {
    let helps = helps();
    assert!(helps.len() > 15, "{}", helps.len());
    for (command, help) in &helps {
        for path in paths(help) {
            assert!(root().join(path).exists(), "{command} --help names {path}");
        }
    }
    let new = &helps.iter().find(|h| h.0 == "law new").unwrap().1;
    for kind in Kind::BUILT_IN {
        assert!(new.contains(kind.word()), "{kind} is not in: {new}");
    }
}

/// Numbers before these words are numbers of shipped laws.
#[test]
fn pages_know_how_many_laws_there_are() {
    let laws = search_path().laws();
    let own = laws
        .iter()
        .filter(|law| law.2 == LawLocation::BuiltIn)
        .count();
    let own = own.max(built_in().names().count());
    let listed = answer(&["law", "list"]);
    for (kind, name) in built_in().names() {
        let line = |l: &str| l.split_whitespace().take(2).eq([kind.word(), name]);
        assert!(listed.lines().any(line), "{kind} {name}");
    }
    let mut reported = 0;
    for page in pages() {
        for (number, words) in numbers_of_laws(&read(&page)) {
            assert_eq!(number, own, "{}: {words}", page.display());
            reported += 1;
        }
    }
    assert!(reported >= 2, "{reported}");
}

/// Returns the numbers in digits before `laws`, `shipped laws` or `shipped ones`, with these words.
fn numbers_of_laws(text: &str) -> Vec<(usize, String)> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let plain = |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).to_owned();
    let found = words.iter().enumerate().filter_map(|(k, word)| {
        // `5244, laws` is the end of another phrase.
        let number = word.trim_start_matches(|c: char| !c.is_alphanumeric());
        let number = number.trim_end_matches('*').parse().ok()?;
        let after: Vec<String> = words[k + 1..].iter().take(2).map(|w| plain(w)).collect();
        let after: Vec<&str> = after.iter().map(String::as_str).collect();
        let laws = matches!(after[..], ["laws", ..] | ["shipped", "laws" | "ones"]);
        laws.then(|| (number, format!("{word} {}", after.join(" "))))
    });
    found.collect()
}

#[test]
fn numbers_of_laws_are_found_in_a_text() {
    let found =
        |text: &str| -> Vec<usize> { numbers_of_laws(text).into_iter().map(|(n, _)| n).collect() };
    assert_eq!(found("There are 39 laws."), [39]);
    assert_eq!(
        found("(39 laws), the **50\nshipped laws**, 7 shipped ones"),
        [39, 50, 7]
    );
    assert!(found("39 cases, laws of 3 kinds, 39, laws, eleven laws").is_empty());
}

/// Files to which the README links, and cases that it runs, exist; it runs only cases that are
/// checked.
#[test]
fn the_readme_names_files_that_are_there() {
    let text = read(&root().join("README.md"));
    let links = text
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next());
    let files = links.filter(|l| !l.starts_with("http") && !l.starts_with('#'));
    let files: Vec<&str> = files.filter_map(|l| l.split('#').next()).collect();
    assert!(files.len() > 30);
    for file in files {
        assert!(root().join(file).exists(), "{file}");
    }
    for line in text
        .lines()
        .filter(|l| l.starts_with("cargo run --release -- "))
    {
        for path in paths(line) {
            assert!(root().join(path).exists(), "{line}");
        }
    }
}

/// The case in the README, the page of `trade` and its help is one whose results are trusted.
#[test]
fn the_example_of_trade_is_a_case_that_can_be_trusted() {
    let example = |page: &str, begins: &str| {
        let text = read(&root().join(page));
        let line = text.lines().find(|l| l.starts_with(begins));
        let line = line.unwrap_or_else(|| panic!("no {begins} in {page}"));
        paths(line).next().unwrap().to_owned()
    };
    let case = &example("README.md", "cargo run --release -- trade ");
    assert_eq!(case, &example("docs/trade.md", "fretwork trade "));
    assert!(answer(&["trade", "--help"]).contains(case));
    let out = std::env::temp_dir().join(format!("fretwork-facts-{}", std::process::id()));
    let folder = out.to_str().unwrap();
    let run = [
        "run",
        case,
        "--strict",
        "--no-report",
        "--json",
        "--out",
        folder,
    ];
    let sets = ["--set", "output.frames=0", "--set", "output.figures=false"];
    answer(&[&run[..], &sets].concat());
    std::fs::remove_dir_all(&out).ok();
}
