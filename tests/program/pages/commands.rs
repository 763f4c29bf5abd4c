//! The commands of the pages are run, and print what the pages show.

use super::console::{Block, blocks, is_timed, renewed};
use super::{Mode, mode, pages, read, root, settle, versions};
use crate::temp::TempFolder;
use chrono::Utc;
use std::path::Path;
use std::process::Command;

/// Folders that commands of pages read.
const READ: [&str; 8] = [
    "cases",
    "docs",
    "fits",
    "patches",
    "materials",
    "studies",
    "tests",
    "validation",
];

/// A folder like the root of the repository, in which results are not in the repository.
fn repository() -> TempFolder {
    let folder = TempFolder::new("pages");
    for name in READ {
        std::os::unix::fs::symlink(root().join(name), folder.join(name)).unwrap();
    }
    folder
}

/// The lines that a command prints; those of errors too if it fails.
fn printed(words: &[String], folder: &Path) -> Vec<String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    let output = command.args(words).current_dir(folder).output().unwrap();
    let mut text = String::from_utf8(output.stdout).unwrap();
    if !output.status.success() {
        text += &String::from_utf8_lossy(&output.stderr);
    }
    let lines = text.trim_end().lines();
    lines.map(|l| l.trim_end().to_owned()).collect()
}

/// The lines of a block, with its command, as they are to be today.
fn today(block: &Block, lines: &[&str], folder: &Path) -> Vec<String> {
    let command = lines[block.command.clone()].iter();
    let mut out: Vec<String> = command.map(|l| (*l).to_owned()).collect();
    if let (Some(_), Some(last)) = (&block.version, out.last_mut()) {
        let (call, _) = last.rsplit_once("# version ").unwrap();
        let (version, day) = (env!("CARGO_PKG_VERSION"), Utc::now().date_naive());
        *last = format!("{call}# version {version}, {day}");
    }
    let output = printed(&block.words, folder);
    let output: Vec<&str> = output.iter().map(String::as_str).collect();
    out.extend(renewed(&lines[block.output.clone()], &output));
    out
}

#[test]
fn commands_of_the_pages_print_what_the_pages_show() {
    let (mut run, mut old) = (0, Vec::new());
    for path in pages() {
        let page = read(&path);
        let blocks = blocks(&page).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        if blocks.is_empty() {
            continue;
        }
        let lines: Vec<&str> = page.lines().collect();
        let (mut made, mut copied) = (Vec::new(), 0);
        let folder = repository();
        for block in &blocks {
            if block.version.is_some() && mode() != Mode::WriteAll {
                continue;
            }
            let kept = &lines[copied..block.command.start];
            made.extend(kept.iter().map(|l| (*l).to_owned()));
            made.extend(today(block, &lines, &folder));
            copied = block.output.end;
            run += 1;
        }
        made.extend(lines[copied..].iter().map(|l| (*l).to_owned()));
        let settled = settle(&path, &(made.join("\n") + "\n"), "commands_of_the_pages");
        old.extend(settled.err());
    }
    assert!(run > 10, "{run}");
    assert!(old.is_empty(), "{}", old.join("\n"));
}

#[test]
fn blocks_name_versions_that_there_were_and_no_times() {
    let known = versions();
    assert!(known.contains(&env!("CARGO_PKG_VERSION").to_owned()));
    for path in pages() {
        let page = read(&path);
        let lines: Vec<&str> = page.lines().collect();
        let blocks = blocks(&page).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        for block in blocks {
            let place = format!("{}:{}", path.display(), block.line);
            if let Some(printed) = &block.version {
                let version = &printed.version;
                assert!(known.contains(version), "{place}: version {version}");
            }
            for line in &lines[block.output] {
                assert!(!is_timed(line), "{place} shows how long it took: {line}");
            }
        }
    }
}
