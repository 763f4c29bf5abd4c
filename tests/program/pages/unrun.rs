//! Commands in blocks that show no output are not run: what they name is checked, and so are the
//! whole cases that pages show.

use super::console::words;
use super::{pages_for_users, read, root};
use crate::temp::TempFolder;
use std::collections::BTreeSet;
use std::process::Command;

/// The calls of the program in blocks of a page that are for a shell, without `fretwork`.
fn calls(page: &str) -> Vec<String> {
    let (mut out, mut call) = (Vec::new(), String::new());
    let mut language: Option<&str> = None;
    for line in page.lines().map(str::trim) {
        if let Some(named) = line.strip_prefix("```") {
            language = if language.is_some() {
                None
            } else {
                Some(named)
            };
            continue;
        }
        if !matches!(language, Some("" | "sh")) {
            continue;
        }
        call += line;
        if call.ends_with('\\') {
            call.pop();
            continue;
        }
        let begins = ["fretwork ", "cargo run --release -- "];
        let words = begins.iter().find_map(|begin| call.strip_prefix(begin));
        out.extend(words.map(str::to_owned));
        call.clear();
    }
    out
}

/// The command that checks the case or the study of a call, with its changes, without a run. None
/// for other commands, for files that a reader makes, and for laws of a reader's own.
fn check(words: &[String]) -> Option<Vec<String>> {
    let text: Vec<&str> = words.iter().map(String::as_str).collect();
    let (task, rest): (&[&str], _) = match &*text {
        ["run" | "check", rest @ ..] => (&["check"], rest),
        ["study", "run" | "check", rest @ ..] => (&["study", "check"], rest),
        _ => return None,
    };
    let file = rest
        .iter()
        .find(|word| word.ends_with(".ron") && root().join(word).exists())?;
    if rest.contains(&"--plugin-path") {
        return None;
    }
    let mut out = [task, &[file, "--no-timing"]].concat();
    for pair in rest.windows(2) {
        if ["--set", "--seeds"].contains(&pair[0]) {
            out.extend(pair);
        }
    }
    out.extend(rest.iter().filter(|word| **word == "--ranges"));
    Some(out.into_iter().map(str::to_owned).collect())
}

#[test]
fn commands_that_are_not_run_name_cases_and_keys_that_there_are() {
    let (mut checked, mut wrong) = (BTreeSet::new(), Vec::new());
    for path in pages_for_users() {
        for call in calls(&read(&path)) {
            // A loop of a shell, with its `$case`, is no call by itself.
            let found = words(&call).ok();
            let Some(check) = found.and_then(|(words, _)| check(&words)) else {
                continue;
            };
            if !checked.insert(check.clone()) {
                continue;
            }
            let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
            let output = command.args(&check).current_dir(root()).output().unwrap();
            if !output.status.success() {
                let error = String::from_utf8_lossy(&output.stderr);
                wrong.push(format!("{}: {call}: {error}", path.display()));
            }
        }
    }
    assert!(checked.len() > 30, "{}", checked.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The whole cases that a page shows.
fn cases(page: &str) -> impl Iterator<Item = &str> {
    let blocks = page.split("```ron\n").skip(1);
    let blocks = blocks.filter_map(|rest| rest.split("```").next());
    blocks.filter(|text| text.starts_with("(\n") && text.contains("\n    dimension: "))
}

#[test]
fn whole_cases_of_the_pages_pass_the_check() {
    let (folder, mut checked) = (TempFolder::new("whole-cases"), 0);
    for path in pages_for_users() {
        for case in cases(&read(&path)) {
            std::fs::write(folder.join("case.ron"), case).unwrap();
            let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
            let command = command.args(["check", "case.ron", "--no-timing"]);
            let output = command.current_dir(&*folder).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {error}", path.display());
            checked += 1;
        }
    }
    assert!(checked >= 2, "{checked}");
}

#[test]
fn calls_are_found_with_what_checks_them() {
    let page = "```\nfretwork run cases/silo.ron --out a \\\n    --set 'a=1 b'   # c\n```\n```ron\nfretwork x\n```\n```sh\ncargo run --release -- law list\n```\n";
    let found = calls(page);
    assert_eq!(found.len(), 2);
    let checked = |call: &str| check(&words(call).unwrap().0);
    let expected = ["check", "cases/silo.ron", "--no-timing", "--set", "a=1 b"];
    assert_eq!(checked(&found[0]).unwrap(), expected);
    assert_eq!(found[1], "law list");
    assert!(checked(&found[1]).is_none());
    assert!(checked("run mine.ron").is_none());
}
